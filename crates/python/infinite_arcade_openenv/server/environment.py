"""The environment that the server runs, once per session."""

from __future__ import annotations

import secrets
from dataclasses import asdict
from typing import Any
from uuid import uuid4

from openenv.core.env_server.interfaces import Environment
from openenv.core.env_server.types import EnvironmentMetadata

from infinite_arcade import __version__
from infinite_arcade.games import Game, Level
from infinite_arcade.sessions import Shelf, TextSession
from infinite_arcade_openenv.models import ArcadeAction, ArcadeObservation, ArcadeState

__all__ = ["ArcadeEnvironment"]

#: The number of tasks that a list of an endless stream shows.
PREVIEW = 100


class ArcadeEnvironment(Environment[ArcadeAction, ArcadeObservation, ArcadeState]):
    """A level that is played through text. Sessions share only the levels, which do not change.

    The levels are the tasks. They form one split: ``train`` for a stream, and ``test`` for all other levels.
    """

    SUPPORTS_CONCURRENT_SESSIONS = True

    def __init__(self, shelf: Shelf, *, max_steps: int = 1000) -> None:
        super().__init__()
        self._shelf, self._max_steps = shelf, max_steps
        self._session: TextSession | None = None
        self._episode = ""

    def reset(
        self,
        seed: int | str | None = None,
        episode_id: str | None = None,
        split: str | None = None,
        index: int | None = None,
        game: str | None = None,
        level: int | None = None,
        **_: Any,
    ) -> ArcadeObservation:
        """Starts an episode. The seed determines the randomness of the game, and draws the level unless a level is
        chosen.

        Args:
            seed: the seed; by default a random number.
            episode_id: the ID of the episode; by default a random ID.
            split: the split of the task.
            index: the index of the task, which is a level.
            game: the name of the game.
            level: the number of the level.

        Raises:
            ValueError: if there is no such split, game or level.
            IndexError: if there is no such task.
        """
        seed = secrets.randbelow(1 << 31) if seed is None else seed
        if split is not None:
            self._check(split)
        if index is not None:
            found = self._shelf[index]
        elif game is not None or level is not None:
            found = self._shelf.find(game, level)
        else:
            found = self._shelf.draw(seed)
        self._session = TextSession(*found, seed=seed, max_steps=self._max_steps)
        self._episode = episode_id or str(uuid4())
        return self._observation(rules=self._session.rules, reward=0.0)

    def step(self, action: ArcadeAction, timeout_s: float | None = None, **_: Any) -> ArcadeObservation:
        """Plays one action. An action that is not available is not played: the observation has an ``error``, and its
        text is that of the unchanged turn.

        Raises:
            RuntimeError: if no episode has been started.
        """
        session = self._started()
        was_over = session.is_over
        try:
            session.act(action.action)
        except ValueError as error:
            return self._observation(error=str(error), reward=0.0)
        witness = self._shelf.witness(session.level) if session.is_over else None
        components = None if witness is None else asdict(session.components(witness))
        return self._observation(reward=float(session.outcome == "won" and not was_over), components=components)

    @property
    def state(self) -> ArcadeState:
        """The facts about the current episode."""
        session = self._session
        if session is None:
            return ArcadeState()
        return ArcadeState(
            episode_id=self._episode,
            step_count=len(session.history),
            game=session.game.id,
            level=session.level.number,
            level_digest=session.level.digest,
            seed=session.facts["seed"],
            history=list(session.history),
            score=session.score,
            outcome=session.outcome,
            state_hash=session.state_hash(),
        )

    def get_metadata(self) -> EnvironmentMetadata:
        """Returns a description of the environment."""
        return EnvironmentMetadata(
            name="infinite_arcade",
            description="Arcade games on a board of cells, with verified levels, played through text",
            version=__version__,
        )

    def list_splits(self) -> list[str]:
        """Returns the name of the only split."""
        return ["test" if self._shelf.stream is None else "train"]

    def num_tasks(self, split: str) -> int:
        """Returns the number of levels. For an endless stream, this is the number of levels that seeds draw."""
        self._check(split)
        return len(self._shelf)

    def list_tasks(self, split: str) -> list[dict[str, Any]]:
        """Returns the tasks, or the first tasks of a stream."""
        self._check(split)
        return self.get_task_range(split, 0, None if self._shelf.stream is None else PREVIEW)

    def get_task(self, split: str, index: int) -> dict[str, Any]:
        """Returns a task.

        Raises:
            IndexError: if there is no such task.
        """
        self._check(split)
        return self._task(split, index, *self._shelf[index])

    def get_task_range(self, split: str, start: int | None = None, stop: int | None = None) -> list[dict[str, Any]]:
        """Returns the tasks from ``start`` to before ``stop``."""
        self._check(split)
        return [self.get_task(split, index) for index in range(*slice(start, stop).indices(len(self._shelf)))]

    def _task(self, split: str, index: int, game: Game, level: Level) -> dict[str, Any]:
        return {
            "id": level.digest,
            "split": split,
            "index": index,
            "group": game.id,
            "game": game.id,
            "level": level.number,
        }

    def _check(self, split: str) -> None:
        if split not in self.list_splits():
            raise ValueError(f"there is no split `{split}`; the split is `{self.list_splits()[0]}`")

    def _started(self) -> TextSession:
        if self._session is None:
            raise RuntimeError("no episode has been started; call reset first")
        return self._session

    def _observation(
        self,
        *,
        reward: float,
        rules: str | None = None,
        components: dict[str, float] | None = None,
        error: str | None = None,
    ) -> ArcadeObservation:
        session = self._started()
        return ArcadeObservation(
            text=session.observation,
            rules=rules,
            actions=session.actions,
            game=session.game.id,
            level=session.level.number,
            score=session.score,
            outcome=session.outcome,
            components=components,
            error=error,
            reward=reward,
            done=session.is_over,
        )
