"""The reward of an episode, which has four components.

>>> import infinite_arcade as ia
>>> item = ia.stream("lessons", "hailglass")[0]
>>> ia.reward_components(item.witness.replay(), item.witness)
RewardComponents(win=1.0, score=1.0, progress=1.0, efficiency=1.0)
>>> ia.RewardWeights().reward(item.level.start("a seed"), item.witness)
0.0

Each component is from 0 to 1, and compares the last state of the episode with a witness, which is a winning episode of
the same level. Every component can be gamed, so the default weights limit what a player can earn without a win: an
episode that is not won earns at most 0.04, and the witness earns at least 0.9.

- **Win**: 1 for a win. Random keys win some levels: a level passes the judges if they win at most 20% of their
  episodes. In a game of survival, lucky waiting can win.
- **Score**: the score divided by the score of the witness. Without a gate, a player could collect points that return,
  never win, and earn the full component. The component is therefore 0 without a win. A player can still delay a win to
  collect the points of the witness, but then loses efficiency. If the witness scores nothing, the component is 0.
- **Progress**: the fraction of the requirements of a win that are met in the last state, relative to the first state.
  A player could meet all requirements but the last, and stop. Only the small weight prevents this. Running in circles
  earns nothing, because only the last state counts. Random keys meet some requirements of many levels. The
  requirements are those in the line ``to win`` of :meth:`State.full_text <infinite_arcade.State.full_text>`, and a
  game that is won by survival has no progress.
- **Efficiency**: the ticks of the witness divided by the ticks of the episode. Without a gate, the best plan would be
  to lose quickly, so the component is 0 without a win. The witness is a win that a planner found and is rarely the
  shortest. A shorter win earns no more than 1, so that hurry does not pay beyond that.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from .games import Episode, State

__all__ = ["RewardComponents", "RewardWeights", "reward_components"]

#: The line of the requirements of a win, such as ``to win: friend 1 of 3 or exit 1 to go``.
_TO_WIN = re.compile(r"^to win: (.+)$", re.MULTILINE)
_TO_GO = re.compile(r" (\d+) to go$")
_OF = re.compile(r" (\d+) of (\d+)$")


@dataclass(frozen=True)
class RewardComponents:
    """The components of an episode's reward, each from 0 to 1."""

    #: 1 for a win, and 0 otherwise.
    win: float
    #: The score relative to the witness, or 0 without a win.
    score: float
    #: The fraction of the requirements of a win that are met in the last state.
    progress: float
    #: The ticks of the witness relative to the ticks of the episode, or 0 without a win.
    efficiency: float


@dataclass(frozen=True)
class RewardWeights:
    """The weights of the components of a reward. With the default weights, rewards are from 0 to 1."""

    win: float = 0.7
    score: float = 0.1
    progress: float = 0.04
    efficiency: float = 0.16

    def __post_init__(self) -> None:
        for name, weight in vars(self).items():
            if not 0 <= weight < float("inf"):
                raise ValueError(f"`{name}` must be a finite number of at least 0, not {weight}")

    def reward(self, state: State, witness: Episode) -> float:
        """Returns the weighted sum of the components of an episode."""
        return self.of(reward_components(state, witness))

    def of(self, found: RewardComponents) -> float:
        """Returns the weighted sum of components."""
        return (
            self.win * found.win
            + self.score * found.score
            + self.progress * found.progress
            + self.efficiency * found.efficiency
        )


def reward_components(state: State, witness: Episode) -> RewardComponents:
    """Returns the components of an episode's reward.

    Args:
        state: the last state of the episode.
        witness: a winning episode of the same level, such as the best known win.

    Raises:
        ValueError: if the witness does not win.
    """
    best = witness.replay()
    if best.outcome != "won":
        raise ValueError(f"`witness` must win its level, but its outcome is `{best.outcome}`")
    win = float(state.outcome == "won")
    score = _unit(state.score / best.score) if best.score > 0 else 0.0
    return RewardComponents(
        win=win,
        score=win * score,
        progress=win or _progress(state, witness),
        efficiency=win * _unit(best.ticks / max(1, state.ticks)),
    )


def _progress(state: State, witness: Episode) -> float:
    first = _missing(witness.level.start(witness.seed))
    return _unit(1 - _missing(state) / first) if first else 0.0


def _missing(state: State) -> int:
    """Returns the number of sprites that must still disappear or appear for the nearest win, or 0 if a win does not
    count sprites.
    """
    line = _TO_WIN.search(state.full_text())
    counts = list[int]()
    for part in line[1].split(" or ") if line else ():
        if found := _TO_GO.search(part):
            counts.append(int(found[1]))
        elif found := _OF.search(part):
            counts.append(abs(int(found[2]) - int(found[1])))
    return min(counts, default=0)


def _unit(value: float) -> float:
    return min(1.0, max(0.0, value))
