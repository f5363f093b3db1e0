"""Environments for Gymnasium: ``InfiniteArcade/Game-v0``, alone and in vectors.

>>> import gymnasium, infinite_arcade.gymnasium
>>> env = gymnasium.make("InfiniteArcade/Game-v0", game="hailglass", level=0)
>>> envs = gymnasium.make_vec("InfiniteArcade/Game-v0", num_envs=4096, game="hailglass")

Importing this module registers the ID. ``gymnasium.make("infinite_arcade.gymnasium:InfiniteArcade/Game-v0", …)`` also
imports the module.

There are three kinds of observations:

- ``planes`` is ``[types][rows][columns]``, uint8, with 1 in each cell that contains a sprite of the type.
  ``env.unwrapped.planes`` lists the types.
- ``symbols`` is ``[rows][columns]``, uint8, with the ASCII character of the uppermost sprite.
  ``env.unwrapped.game.symbols`` lists the characters.
- ``rgb`` is ``[rows × cell][columns × cell][3]``, uint8, drawn by the renderer of the suite.

If levels have different sizes, smaller levels are at the top left of the largest size. Action ``i`` is
``game.actions[i]``. An action that is not available in a state does nothing. The reward is the change in score. With
``reward="outcome"``, the reward is ±1 at the end of the episode.

``reset(seed=s)`` derives the seed of the game's randomness from ``s`` by hashing. Each further ``reset()`` starts the
next episode of ``s``. In a vector, ``reset(seed=[…])`` gives each environment its own seed, with which it plays the
same episodes as a single environment. If the seed is a single number, environment ``i`` gets a seed derived from it,
``child("lane", i)``.

``info["seed"]`` is the seed of the episode. To replay the episode, start its level with this seed (``Level.start``) and play
its actions.
``reset(options={"seed": "<64 hexadecimal digits>"})`` starts the same episode.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, SupportsFloat

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from . import _native
from .games import Game, Level, State, load

__all__ = ["GameEnv", "GameVectorEnv", "register"]

ENV_ID = "InfiniteArcade/Game-v0"

#: The autoreset modes of vectors, and their names in the extension.
_MODES = {
    AutoresetMode.NEXT_STEP: "next-step",
    AutoresetMode.SAME_STEP: "same-step",
    AutoresetMode.DISABLED: "disabled",
}

Board = NDArray[np.uint8]


class _Lanes:
    """Lanes, with the buffers that they write to."""

    def __init__(
        self,
        game: str | Path | Game,
        level: int | Sequence[int] | None,
        count: int,
        *,
        observation: str,
        cell: int,
        max_steps: int | None,
        reward: str,
        mode: AutoresetMode,
        threads: int,
    ) -> None:
        if reward not in ("score", "outcome"):
            raise ValueError(f"there is no reward `{reward}`; choose score or outcome")
        self.game = game if isinstance(game, Game) else load(game)
        self.levels = _chosen(self.game, level)
        self.by_outcome = reward == "outcome"
        self.native = _native.Lanes(
            [level._native for level in self.levels],
            count,
            observation=observation,
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

    def space(self, observation: str) -> gymnasium.Space[Board]:
        high = 1 if observation == "planes" else 255
        space: gymnasium.Space[Any] = spaces.Box(0, high, self.shape, np.uint8)
        return space

    def step(self, actions: NDArray[np.int64]) -> int:
        return self.native.step(
            actions, self.flat, self.rewards, self.terminated, self.truncated, self.flat_last
        )

    def outcome_rewards(self, outcomes: Sequence[str]) -> NDArray[np.float64]:
        values = {"won": 1.0, "lost": -1.0}
        ended = (values.get(outcome, 0.0) for outcome in outcomes)
        return np.where(self.terminated, np.fromiter(ended, np.float64, len(outcomes)), 0.0)


class GameEnv(gymnasium.Env[Board, np.int64]):
    """A game as a Gymnasium environment.

    ``info`` contains ``seed``, ``level``, ``score`` and ``outcome``.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array", "ansi"], "render_fps": 20}

    def __init__(
        self,
        game: str | Path | Game,
        level: int | Sequence[int] | None = 0,
        *,
        observation: str = "planes",
        cell: int = 8,
        max_steps: int | None = None,
        reward: str = "score",
        render_mode: str | None = None,
    ) -> None:
        """Creates an environment.

        Args:
            game: a game, or an argument for :func:`infinite_arcade.load`.
            level: one level, several levels, or None for all levels. :meth:`reset` with ``options={"level": i}``
                selects the ``i``-th of them.
            observation: ``planes``, ``symbols`` or ``rgb``.
            cell: the size of a cell in images, in pixels.
            max_steps: the number of steps after which an episode is truncated; by default the limit of the game.
            reward: ``score`` or ``outcome``.
            render_mode: ``rgb_array`` or ``ansi``.

        Raises:
            VgdlError: if the game has problems.
            ValueError: if an argument is invalid.
        """
        self._lanes = _Lanes(
            game,
            level,
            1,
            observation=observation,
            cell=cell,
            max_steps=max_steps,
            reward=reward,
            mode=AutoresetMode.DISABLED,
            threads=1,
        )
        self.game = self._lanes.game
        self.observation_space = self._lanes.space(observation)
        self.action_space = spaces.Discrete(len(self.game.actions))
        self.render_mode = render_mode
        self._cell = cell
        self._is_seeded = False
        self._has_started = False

    @property
    def planes(self) -> list[str]:
        """The names of the planes' sprite types."""
        return self._lanes.native.planes

    @property
    def state(self) -> State:
        """Returns a copy of the current state, which includes the game's true random future. The copy is for tests
        and planners, and must not be shown to agents.
        """
        return State(self._lanes.native.state(0))

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Board, dict[str, Any]]:
        """Starts an episode. In ``options``, ``level`` is an index into the levels of the environment, and ``seed``
        is the seed of the episode itself.
        """
        super().reset(seed=seed)
        options = options or {}
        native = self._lanes.native
        if "level" in options:
            native.choose(0, int(options["level"]))
        if seed is not None or not self._is_seeded:
            native.seed(0, _text_of(seed if seed is not None else self.np_random_seed), False)
            self._is_seeded = True
        exact = "seed" in options
        if exact:
            native.seed(0, str(options["seed"]), True)
        native.reset(np.ones(1, np.bool_), self._lanes.flat, exact)
        self._lanes.terminated[0] = self._lanes.truncated[0] = False
        self._has_started = True
        return self._observation(), self._info()

    def step(self, action: np.int64 | int) -> tuple[Board, SupportsFloat, bool, bool, dict[str, Any]]:
        """Plays one tick with an action.

        Raises:
            gymnasium.error.ResetNeeded: if the episode is over, or no episode was started.
        """
        lanes = self._lanes
        if not self._has_started or lanes.terminated[0] or lanes.truncated[0]:
            self._refuse()
        lanes.step(np.array([action], np.int64))
        reward = float(lanes.rewards[0])
        if lanes.by_outcome:
            reward = float(lanes.outcome_rewards(lanes.native.outcomes)[0])
        terminated, truncated = bool(lanes.terminated[0]), bool(lanes.truncated[0])
        return self._observation(), reward, terminated, truncated, self._info()

    def render(self) -> Any:
        """Returns the current board as pixels or as text."""
        match self.render_mode:
            case "rgb_array":
                return self.state.rgb(self._cell)
            case "ansi":
                return self.state.full_text()
            case _:
                return None

    def _refuse(self) -> None:
        raise gymnasium.error.ResetNeeded("the episode is over, or no episode has been started: call reset()")

    def _observation(self) -> Board:
        copy: Board = self._lanes.observations[0].copy()
        return copy

    def _info(self) -> dict[str, Any]:
        native = self._lanes.native
        level = self._lanes.levels[native.levels[0]].number
        return {
            "seed": native.seeds[0],
            "level": level,
            "score": native.scores[0],
            "outcome": native.outcomes[0],
        }


class GameVectorEnv(VectorEnv[Board, NDArray[np.int64], NDArray[Any]]):
    """Many episodes of a game, stepped together without holding the interpreter lock.

    Environment ``i`` plays level ``i % len(levels)``. Observations, rewards and flags are written into arrays that
    are allocated once. With ``copy=False``, these arrays are returned directly. They are read-only, and valid until
    the next step.

    ``info`` is empty except for ``final_obs`` and ``final_info`` in same-step mode. :attr:`seeds`, :attr:`outcomes`,
    :attr:`scores` and :attr:`hashes` describe the current states.
    """

    metadata: dict[str, Any]

    def __init__(
        self,
        game: str | Path | Game,
        level: int | Sequence[int] | None = None,
        *,
        num_envs: int = 1,
        observation: str = "planes",
        cell: int = 8,
        max_steps: int | None = None,
        max_episode_steps: int | None = None,
        reward: str = "score",
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        threads: int = 0,
        copy: bool = True,
        render_mode: str | None = None,
    ) -> None:
        """Creates a vector environment.

        Args:
            game: a game, or an argument for :func:`infinite_arcade.load`.
            level: one level, several levels, or None for all levels.
            num_envs: the number of environments.
            observation: ``planes``, ``symbols`` or ``rgb``.
            cell: the size of a cell in images, in pixels.
            max_steps: the number of steps after which an episode is truncated; by default the limit of the game.
            max_episode_steps: the name of ``max_steps`` in :func:`gymnasium.make_vec`.
            reward: ``score`` or ``outcome``.
            autoreset_mode: when the next episode starts after one has finished.
            threads: the number of threads, or 0 for all cores. It does not affect results.
            copy: return copies of observations.
            render_mode: ``rgb_array`` or ``ansi``.

        Raises:
            VgdlError: if the game has problems.
            ValueError: if an argument is invalid.
        """
        mode = AutoresetMode(autoreset_mode)
        self.metadata = {"render_modes": ["rgb_array", "ansi"], "render_fps": 20, "autoreset_mode": mode}
        self.render_mode = render_mode
        self.num_envs = num_envs
        self._lanes = _Lanes(
            game,
            level,
            num_envs,
            observation=observation,
            cell=cell,
            max_steps=max_episode_steps if max_steps is None else max_steps,
            reward=reward,
            mode=mode,
            threads=threads,
        )
        self.game = self._lanes.game
        self.single_observation_space = self._lanes.space(observation)
        self.single_action_space = spaces.Discrete(len(self.game.actions))
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._mode, self._copy, self._cell = mode, copy, cell
        self._shown = self._lanes.observations.view()
        self._shown.flags.writeable = False
        self._is_seeded = self._has_started = False

    @property
    def planes(self) -> list[str]:
        """The names of the planes' sprite types."""
        return self._lanes.native.planes

    @property
    def seeds(self) -> list[str]:
        """The seeds of the environments' current episodes."""
        return self._lanes.native.seeds

    @property
    def levels(self) -> list[int]:
        """The index of each environment's level."""
        return [self._lanes.levels[at].number for at in self._lanes.native.levels]

    @property
    def hashes(self) -> list[str]:
        """The hashes of the environments' current states."""
        return self._lanes.native.hashes

    @property
    def outcomes(self) -> list[str]:
        """The outcomes of the environments' current states."""
        return self._lanes.native.outcomes

    @property
    def scores(self) -> list[float]:
        """The scores of the environments' current states."""
        return self._lanes.native.scores

    def state(self, index: int) -> State:
        """Returns a copy of an environment's current state, which includes the game's true random future."""
        return State(self._lanes.native.state(index))

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Board, dict[str, Any]]:
        """Starts an episode in every environment, or in the environments selected by ``options["reset_mask"]``.
        ``options["seed"]`` holds the seeds of the episodes themselves, one per environment.

        Raises:
            ValueError: unless there is exactly one mask entry and one seed per environment.
        """
        options = options or {}
        native, lanes = self._lanes.native, self._lanes
        mask = np.ones(self.num_envs, np.bool_)
        if "reset_mask" in options:
            mask = np.asarray(options["reset_mask"])
            if mask.shape != (self.num_envs,) or mask.dtype != np.bool_ or not mask.any():
                raise ValueError(f"`reset_mask` must consist of {self.num_envs} booleans, at least one of them True")
        super().reset(seed=seed if isinstance(seed, int) else None)
        if seed is None and not self._is_seeded:
            if self._np_random is None:
                self._np_random, self._np_random_seed = seeding.np_random()
            seed = self.np_random_seed
        if isinstance(seed, (int, np.integer)):
            native.seed_all(_text_of(int(seed)))
        elif seed is not None:
            if len(seed) != self.num_envs:
                raise ValueError(f"{len(seed)} seeds were given for {self.num_envs} environments")
            for at, own in enumerate(seed):
                if own is not None:
                    native.seed(at, _text_of(own), False)
                elif not self._is_seeded:
                    native.seed(at, _text_of(seeding.np_random()[1]), False)
        self._is_seeded = self._has_started = True
        exact = "seed" in options
        if exact:
            if len(options["seed"]) != self.num_envs:
                raise ValueError(f"{len(options['seed'])} seeds were given for {self.num_envs} environments")
            for at, own in enumerate(options["seed"]):
                if mask[at]:
                    native.seed(at, str(own), True)
        native.reset(mask, lanes.flat, exact)
        lanes.terminated[mask] = lanes.truncated[mask] = False
        return self._observations(), {}

    def step(
        self, actions: NDArray[np.int64]
    ) -> tuple[Board, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Plays one tick in every environment.

        Raises:
            gymnasium.error.ResetNeeded: if no episode was started, or an episode is over and the environment does not
            reset itself (disabled mode).
            ValueError: unless there is exactly one action per environment.
        """
        lanes = self._lanes
        if not self._has_started:
            raise gymnasium.error.ResetNeeded("no episode has been started: call reset()")
        if self._mode == AutoresetMode.DISABLED and (lanes.terminated.any() or lanes.truncated.any()):
            raise gymnasium.error.ResetNeeded("episodes are over: call reset() with their `reset_mask`")
        ended = lanes.step(np.ascontiguousarray(actions, np.int64))
        info: dict[str, Any] = {}
        if ended and lanes.last is not None:
            info = self._final(lanes.last)
        rewards = lanes.rewards.copy()
        if lanes.by_outcome:
            rewards = self._outcome_rewards(info)
        return self._observations(), rewards, lanes.terminated.copy(), lanes.truncated.copy(), info

    def render(self) -> tuple[Any, ...] | None:
        """Returns the boards as pixels or as text."""
        match self.render_mode:
            case "rgb_array":
                return tuple(self.state(at).rgb(self._cell) for at in range(self.num_envs))
            case "ansi":
                return tuple(self.state(at).full_text() for at in range(self.num_envs))
            case _:
                return None

    def _observations(self) -> Board:
        return self._lanes.observations.copy() if self._copy else self._shown

    def _final(self, last: Board) -> dict[str, Any]:
        over = self._lanes.terminated | self._lanes.truncated
        boards = np.full(self.num_envs, None, dtype=object)
        scores = np.zeros(self.num_envs)
        outcomes = np.full(self.num_envs, None, dtype=object)
        for at in np.flatnonzero(over):
            boards[at] = last[at].copy()
            scores[at], outcomes[at] = self._lanes.native.last(int(at))
        final = {"score": scores, "_score": over, "outcome": outcomes, "_outcome": over}
        return {"final_obs": boards, "_final_obs": over, "final_info": final, "_final_info": over}

    def _outcome_rewards(self, info: dict[str, Any]) -> NDArray[np.float64]:
        outcomes: Sequence[str] = self._lanes.native.outcomes
        if "final_info" in info:
            outcomes = list(info["final_info"]["outcome"])
        return self._lanes.outcome_rewards(outcomes)


def _text_of(seed: int | None) -> str:
    """Returns the text from which a Gymnasium seed is derived."""
    return str(seed)


def _chosen(game: Game, level: int | Sequence[int] | None) -> list[Level]:
    numbers = range(len(game.levels)) if level is None else [level] if isinstance(level, int) else level
    chosen = [found for number in numbers for found in game.levels if found.number == number]
    if not chosen or len(chosen) != len(list(numbers)):
        there = [found.number for found in game.levels]
        raise ValueError(f"{game.id} has the levels {there}, not {list(numbers)}")
    return chosen


def register() -> None:
    """Registers ``InfiniteArcade/Game-v0``, unless it is already registered."""
    if ENV_ID not in gymnasium.registry:
        gymnasium.register(
            ENV_ID,
            entry_point="infinite_arcade.gymnasium:GameEnv",
            vector_entry_point="infinite_arcade.gymnasium:GameVectorEnv",
            disable_env_checker=False,
        )


register()
