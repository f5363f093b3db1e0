"""Actions, observations and states, which client and server exchange."""

from __future__ import annotations

from openenv.core.env_server.types import Action, Observation, State
from pydantic import Field

__all__ = ["ArcadeAction", "ArcadeObservation", "ArcadeState"]


class ArcadeAction(Action):
    """An action, which takes one tick."""

    action: str = Field(description="The name of an action, such as `right`. `nil` does nothing.")


class ArcadeObservation(Observation):
    """The turn after an action. The reward is 1 for a win, and 0 otherwise."""

    text: str = Field(default="", description="The current turn: board, score, and the result of the last action")
    rules: str | None = Field(default=None, description="The rules, the legend and the actions; only after a reset")
    actions: list[str] = Field(default_factory=list, description="The actions that are available now")
    game: str = Field(default="", description="The name of the game")
    level: int = Field(default=0, description="The number of the level")
    score: float = Field(default=0.0, description="The current score of the game")
    outcome: str = Field(default="ongoing", description="`ongoing`, `won`, `lost`, `ended` or `stopped`")
    components: dict[str, float] | None = Field(
        default=None, description="The components of the reward, from 0 to 1; only after the last action on a level of a stream"
    )
    error: str | None = Field(default=None, description="The reason why the action was not played, or nothing")


class ArcadeState(State):
    """The facts about the episode, for trainers. Agents must not see them, because they contain the seed."""

    game: str = ""
    level: int = 0
    level_digest: str = ""
    seed: str = ""
    history: list[str] = Field(default_factory=list)
    score: float = 0.0
    outcome: str = "ongoing"
    state_hash: str = ""
