"""The episodes of environments, with the arrays that they write to."""

from __future__ import annotations

import operator
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Literal

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray

from . import _native
from ._arguments import at_least, pair
from .games import Game, Level, State, game_of

#: The autoreset modes of vectors, and their names in the extension.
_MODES = {
    AutoresetMode.NEXT_STEP: "next-step",
    AutoresetMode.SAME_STEP: "same-step",
    AutoresetMode.DISABLED: "disabled",
}

Board = NDArray[np.uint8]

#: The kinds of observations.
Kind = Literal["planes", "symbols", "rgb", "full"]

#: The kinds of rewards.
Reward = Literal["score", "outcome"]

#: The number of one level, the numbers of several levels, or None for all levels of the game.
Levels = int | Iterable[int] | None


class EpisodeLanes:
    """The environments of a batch (lanes), with the buffers that they write to."""

    def __init__(
        self,
        game: str | Path | Game,
        level: Levels,
        count: int,
        *,
        observation: Kind,
        size: tuple[int, int] | None,
        cell: int,
        max_steps: int | None,
        reward: Reward,
        mode: AutoresetMode,
        threads: int,
    ) -> None:
        if reward not in ("score", "outcome"):
            raise ValueError(f"there is no reward `{reward}`; choose score or outcome")
        if observation not in ("planes", "symbols", "rgb", "full"):
            raise ValueError(f"there is no observation `{observation}`; choose planes, symbols, rgb or full")
        at_least(1, num_envs=count, cell=cell, max_steps=max_steps)
        at_least(0, threads=threads)
        self.game = game_of(game)
        self.levels = _chosen(self.game, level)
        self.by_outcome = reward == "outcome"
        #: The number of columns and the number of rows of every board.
        self.size = _largest(self.game) if size is None else pair(size)
        self.arguments: dict[str, Any] = {
            "game": self.game,
            "level": [level.number for level in self.levels],
            "count": count,
            "observation": observation,
            "size": self.size,
            "cell": cell,
            "max_steps": max_steps,
            "reward": reward,
            "mode": mode,
            "threads": threads,
        }
        self.native = _native.Lanes(
            [level._native for level in self.levels],
            count,
            size=self.size,
            observation="planes" if observation == "full" else observation,
            cell=cell,
            max_steps=self.game.time_limit if max_steps is None else max_steps,
            autoreset=_MODES[mode],
            threads=threads,
        )
        self.shape = tuple(self.native.shape)
        self.observations: Board = np.zeros((count, *self.shape), np.uint8)
        self.flat = self.observations.reshape(-1)
        self.rewards = np.zeros(count, np.float64)
        self.terminated = np.zeros(count, np.bool_)
        self.truncated = np.zeros(count, np.bool_)
        same_step = mode == AutoresetMode.SAME_STEP
        self.last: Board | None = np.zeros_like(self.observations) if same_step else None
        self.flat_last = None if self.last is None else self.last.reshape(-1)
        #: The statuses of all environments, if they are observed.
        self.status: NDArray[np.float32] | None = None
        if observation == "full":
            self.status = np.zeros((count, len(self.native.status_names)), np.float32)

    def __getstate__(self) -> dict[str, Any]:
        arrays = {name: getattr(self, name) for name in ("rewards", "terminated", "truncated", "last")}
        return {"arguments": self.arguments, "lanes": self.native.save(), "arrays": arrays}

    def __setstate__(self, saved: dict[str, Any]) -> None:
        self.__init__(**saved["arguments"])  # type: ignore[misc]
        self.native.restore(saved["lanes"], self.flat)
        for name, values in saved["arrays"].items():
            if values is not None:
                getattr(self, name)[:] = values

    def space(self, observation: Kind) -> gymnasium.Space[Any]:
        high = 1 if observation in ("planes", "full") else 255
        board = spaces.Box(0, high, self.shape, np.uint8)
        if self.status is None:
            return board
        status = spaces.Box(-np.inf, np.inf, self.status.shape[1:], np.float32)
        return spaces.Dict({"planes": board, "status": status})

    def observed(self) -> Any:
        """Returns the observations of all environments, in the buffers that the next step overwrites."""
        boards = self.observations.view()
        boards.flags.writeable = False
        if self.status is None:
            return boards
        self.native.status(self.status.reshape(-1))
        status = self.status.view()
        status.flags.writeable = False
        return {"planes": boards, "status": status}

    def select(self, lane: int, level: int) -> None:
        """Selects the level of an environment's next episode, by the level's number."""
        numbers = [level.number for level in self.levels]
        if level not in numbers:
            raise ValueError(f"the environment has the levels {numbers}, not {level}")
        self.native.choose(lane, numbers.index(level))

    def frame(self, lane: int, cell: int) -> Board:
        """Returns the board of an environment as an image. All images have the same size."""
        columns, rows = self.size
        frame = np.zeros((rows * cell, columns * cell, 3), np.uint8)
        image = State(self.native.state(lane)).rgb(cell)
        frame[: image.shape[0], : image.shape[1]] = image
        return frame

    def step(self, actions: NDArray[np.int64]) -> int:
        return self.native.step(
            actions, self.flat, self.rewards, self.terminated, self.truncated, self.flat_last
        )

    def outcome_rewards(self, outcomes: Sequence[str]) -> NDArray[np.float64]:
        values = {"won": 1.0, "lost": -1.0}
        ended = (values.get(outcome, 0.0) for outcome in outcomes)
        return np.where(self.terminated, np.fromiter(ended, np.float64, len(outcomes)), 0.0)


def _chosen(game: Game, level: Levels) -> list[Level]:
    by_number = {found.number: found for found in game.levels}
    if not by_number:
        raise ValueError(f"{game.id} has no levels; append one, such as `game.level(text)`, to `game.levels`")
    if level is None:
        return list(by_number.values())
    numbers = [operator.index(number) for number in (level if isinstance(level, Iterable) else [level])]
    unknown = [number for number in numbers if number not in by_number]
    if unknown or not numbers:
        raise ValueError(f"{game.id} has the levels {list(by_number)}, not {unknown or numbers}")
    return [by_number[number] for number in numbers]


def _largest(game: Game) -> tuple[int, int]:
    sizes = [level.size for level in game.levels]
    return max(columns for columns, _ in sizes), max(rows for _, rows in sizes)
