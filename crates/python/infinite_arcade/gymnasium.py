"""Environments for Gymnasium: ``InfiniteArcade/Game-v0``, alone and in vectors.

>>> import gymnasium, infinite_arcade
>>> env = gymnasium.make("InfiniteArcade/Game-v0", game="hailglass")
>>> envs = gymnasium.make_vec("InfiniteArcade/Game-v0", num_envs=4096, game="hailglass")

``import infinite_arcade`` registers this ID, and one ID per corpus game, such as ``InfiniteArcade/Hailglass-v0``. In a
process that has not imported the package, ``gymnasium.make("infinite_arcade:InfiniteArcade/Game-v0", …)`` imports it.

There are four kinds of observations:

- ``planes`` is ``[types][rows][columns]``, uint8, with 1 in each cell that contains a sprite of the type.
  ``env.unwrapped.planes`` lists the types.
- ``symbols`` is ``[rows][columns]``, uint8, with the ASCII character of the uppermost sprite.
  ``env.unwrapped.game.symbols`` lists the characters.
- ``rgb`` is ``[rows × cell][columns × cell][3]``, uint8, drawn by the renderer of the suite.
- ``full`` is a dictionary of ``planes`` and ``status``. ``status`` is a float32 vector with what planes do not show:
  the facing and health of the avatar, the ticks left, and the amounts of held resources. ``env.unwrapped.status_names``
  lists its numbers. The ticks left count down to the limit of the game or to ``max_steps``, whichever comes first.

All boards have the size of the largest level of the game, whichever levels are played, or the ``size`` that is passed.
Smaller levels are at the top left. Action ``i`` is ``game.actions[i]``. An action that is not available in a state
does nothing. The reward is the change in score. With ``reward="outcome"``, the reward is ±1 at the end of the episode.

If an environment has several levels, each episode draws its level from its seed. The level of one episode can be
selected with ``reset(options={"level": 4})``, where 4 is the number of the level.

``reset(seed=s)`` derives the seed of the game's randomness from ``s`` by hashing. Each further ``reset()`` starts the
next episode derived from ``s``. In a vector, ``reset(seed=[…])`` gives each environment its own seed, with which it
plays the same episodes as a single environment. If the seed is a single number, environment ``i`` gets a seed derived
from it, ``child("lane", i)``.

``info["seed"]`` is the seed of the episode. To replay the episode, start its level with this seed (``Level.start``) and play
its actions.
``reset(options={"seed": "<64 hexadecimal digits>"})`` starts the same episode. If its level was selected, select the
level again.

``InfiniteArcade/Stream-v0`` plays a new verified level of the game in each episode, from a :class:`~infinite_arcade.Stream`.
The level follows from the seed of the episode.

Environments can be pickled and copied. A pickled environment consists of texts, seeds and actions, and is restored by
playing the current episodes again.
"""

from __future__ import annotations

import operator
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, SupportsFloat

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from ._arguments import Seed, did_you_mean, seed_text
from ._lanes import Board, EpisodeLanes, Kind, Levels, Reward
from .games import Game, State, corpus, game_of, seed_child, seed_from_text
from .rewards import RewardWeights, reward_components
from .streams import Stream, StreamItem

__all__ = ["GameEnv", "GameVectorEnv", "StreamEnv", "register"]

ENV_ID = "InfiniteArcade/Game-v0"
STREAM_ID = "InfiniteArcade/Stream-v0"

#: The number of positions of a stream from which episodes draw, if the stream has no end.
_POSITIONS = 1 << 60

#: The size of the boards of a game without own levels: the maximum size of its generated levels.
_SIZE = (18, 11)

class GameEnv(gymnasium.Env[Any, np.int64]):
    """A game as a Gymnasium environment.

    ``info`` contains ``seed``, ``level``, ``score`` and ``outcome``.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array", "ansi"], "render_fps": 20}

    def __init__(
        self,
        game: str | Path | Game,
        level: Levels = None,
        *,
        observation: Kind = "planes",
        size: tuple[int, int] | None = None,
        cell: int = 8,
        max_steps: int | None = None,
        reward: Reward = "score",
        render_mode: str | None = None,
    ) -> None:
        """Creates an environment.

        Args:
            game: a game, or an argument for :func:`infinite_arcade.load`.
            level: the numbers of one level or several levels, or None for all levels. Each episode draws its level
                from its seed. :meth:`reset` with ``options={"level": 4}`` selects level 4 for one episode.
            observation: ``planes``, ``symbols``, ``rgb`` or ``full``.
            size: the number of columns and the number of rows of observed boards; by default those of the largest
                level of the game.
            cell: the size of a cell in images, in pixels.
            max_steps: the number of steps after which an episode is truncated; by default the limit of the game.
            reward: ``score`` or ``outcome``.
            render_mode: ``rgb_array`` or ``ansi``.

        Raises:
            VgdlError: if the game has problems.
            ValueError: if an argument is invalid.
        """
        self._lanes = EpisodeLanes(
            game,
            level,
            1,
            observation=observation,
            size=size,
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
        """The names of the sprite types of the observation planes, which are arrays of cells, one per type."""
        return self._lanes.native.planes

    @property
    def status_names(self) -> list[str]:
        """The names of the numbers in the ``status`` of full observations."""
        return self._lanes.native.status_names

    @property
    def state(self) -> State:
        """Returns a copy of the current state, which includes the game's true random future. The copy is for tests
        and planners, and must not be shown to agents.
        """
        return State(self._lanes.native.state(0))

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Starts an episode. In ``options``, ``level`` is the number of the episode's level, and ``seed`` is the seed
        of the episode itself.

        Raises:
            ValueError: if there is no such option, or the environment does not have the level.
        """
        options = _checked(options, ("level", "seed"))
        super().reset(seed=seed)
        native = self._lanes.native
        if "level" in options:
            self._lanes.select(0, operator.index(options["level"]))
        if seed is not None or not self._is_seeded:
            native.seed(0, _text_of(seed if seed is not None else self.np_random_seed), False)
            self._is_seeded = True
        exact = "seed" in options
        if exact:
            native.seed(0, seed_text(options["seed"]), True)
        native.reset(np.ones(1, np.bool_), self._lanes.flat, exact)
        self._lanes.terminated[0] = self._lanes.truncated[0] = False
        self._has_started = True
        return self._observation(), self._info()

    def step(self, action: np.int64 | int) -> tuple[Any, SupportsFloat, bool, bool, dict[str, Any]]:
        """Plays one tick with an action.

        Raises:
            gymnasium.error.ResetNeeded: if the episode is over, or no episode was started.
            TypeError: if the action is not an integer.
            ValueError: if there is no such action.
        """
        lanes = self._lanes
        if not self._has_started or lanes.terminated[0] or lanes.truncated[0]:
            self._refuse()
        lanes.step(np.array([operator.index(action)], np.int64))
        reward = float(lanes.rewards[0])
        if lanes.by_outcome:
            reward = float(lanes.outcome_rewards(lanes.native.outcomes)[0])
        terminated, truncated = bool(lanes.terminated[0]), bool(lanes.truncated[0])
        return self._observation(), reward, terminated, truncated, self._info()

    def render(self) -> Any:
        """Returns the current board as pixels or as text."""
        match self.render_mode:
            case "rgb_array":
                return self._lanes.frame(0, self._cell)
            case "ansi":
                return self.state.full_text()
            case _:
                return None

    def _refuse(self) -> None:
        raise gymnasium.error.ResetNeeded("the episode is over, or no episode has been started: call reset()")

    def _observation(self) -> Any:
        observed = self._lanes.observed()
        if isinstance(observed, dict):
            return {name: values[0].copy() for name, values in observed.items()}
        return observed[0].copy()

    def _info(self) -> dict[str, Any]:
        native = self._lanes.native
        level = self._lanes.levels[native.levels[0]].number
        return {
            "seed": native.seeds[0],
            "level": level,
            "score": native.scores[0],
            "outcome": native.outcomes[0],
        }


class StreamEnv(GameEnv):
    """A game as a Gymnasium environment, with a new verified level in each episode. ``info["level"]`` is the index of
    the level in :attr:`stream`. With weights as ``reward``, the last ``info`` of an episode has ``components``, the
    components of the reward.
    """

    def __init__(
        self,
        game: str | Path | Game,
        *,
        stream_seed: Seed = "train",
        difficulty: float | None = None,
        start_level: int = 0,
        num_levels: int = 0,
        avoid: Sequence[str | Path] = (),
        size: tuple[int, int] | None = None,
        reward: Reward | RewardWeights = "score",
        **arguments: Any,
    ) -> None:
        """Creates an environment.

        Args:
            game: a game, or an argument for :func:`infinite_arcade.load`.
            stream_seed: the seed of the stream.
            difficulty: the difficulty of the levels from 0 to 1; by default, every level draws its own.
            start_level: the index of the first level that episodes draw.
            num_levels: the number of levels from which episodes draw, or 0 for endless levels.
            avoid: the folders or archives of releases whose levels are not played.
            size: the number of columns and the number of rows of generated levels and of observed boards. By default,
                levels have sizes similar to those of the game's own levels, and boards have the largest size.
            reward: ``score``, ``outcome``, or weights. With weights, only the last step of an episode has a reward,
                which compares the episode with the witness of the level.
            arguments: further arguments of :class:`GameEnv`.

        Raises:
            VgdlError: if the game has problems.
            ValueError: if an argument is invalid.
        """
        game = game_of(game)
        #: The stream of the environment's levels.
        self.stream = Stream(
            stream_seed,
            [game],
            difficulty=difficulty,
            size=size,
            start_level=start_level,
            num_levels=num_levels,
            avoid=avoid,
        )
        if size is None:
            sizes = [level.size for level in game.levels] or [_SIZE]
            size = max(columns for columns, _ in sizes), max(rows for _, rows in sizes)
        self._seed, self._episodes = "", 0
        self._weights = reward if isinstance(reward, RewardWeights) else None
        plain = "outcome" if isinstance(reward, RewardWeights) else reward
        super().__init__(game if game.levels else self.stream[0].alone(), size=size, reward=plain, **arguments)

    @property
    def item(self) -> StreamItem:
        """The item of the stream that the current episode plays, after the first :meth:`reset`."""
        return self.stream[self._lanes.levels[0].number - self.stream.start_level]

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Starts an episode. In ``options``, ``level`` is the index of the episode's level in the stream, and ``seed``
        is the seed of the episode itself.

        Raises:
            ValueError: if there is no such option, or the environment does not have the level.
            ArcadeError: if the stream has no level at the drawn position.
        """
        options = _checked(options, ("level", "seed"))
        gymnasium.Env.reset(self, seed=seed)
        if seed is not None or not self._seed:
            self._seed, self._episodes = seed_from_text(_text_of(self.np_random_seed)), 0
        episode = seed_child(self._seed, "episode", self._episodes)
        self._episodes += 1
        drawn = int(seed_child(episode, "item", 0)[:15], 16) % (self.stream.num_levels or _POSITIONS)
        position = self._position(operator.index(options["level"])) if "level" in options else drawn
        arguments = {**self._lanes.arguments, "game": self.stream[position].alone(), "level": None}
        self._lanes = EpisodeLanes(**arguments)
        return super().reset(options={"seed": options.get("seed", episode)})

    def step(self, action: np.int64 | int) -> tuple[Any, SupportsFloat, bool, bool, dict[str, Any]]:
        """Plays one tick with an action.

        Raises:
            gymnasium.error.ResetNeeded: if the episode is over, or no episode was started.
            TypeError: if the action is not an integer.
            ValueError: if there is no such action.
        """
        observation, reward, terminated, truncated, info = super().step(action)
        if self._weights is not None:
            reward = 0.0
            if terminated or truncated:
                found = reward_components(self.state, self.item.witness)
                reward, info["components"] = self._weights.of(found), asdict(found)
        return observation, reward, terminated, truncated, info

    def _position(self, index: int) -> int:
        first, number = self.stream.start_level, self.stream.num_levels
        if index < first or number and index >= first + number:
            known = f"{first} to {first + number - 1}" if number else f"{first} and above"
            raise ValueError(f"the environment has the levels {known}, not {index}")
        return index - first


class GameVectorEnv(VectorEnv[Any, NDArray[np.int64], NDArray[Any]]):
    """Many episodes of a game, stepped together without holding the interpreter lock.

    Each episode draws its level from its seed. Observations, rewards and flags are written into arrays that
    are allocated once. With ``copy=False``, these arrays are returned directly. They are read-only, and valid until
    the next step.

    ``info`` is empty except for ``final_obs`` and ``final_info`` in same-step mode, because most steps do not need
    it. :attr:`seeds`, :attr:`levels`, :attr:`outcomes`, :attr:`scores` and :attr:`hashes` describe the current states.
    """

    metadata: dict[str, Any]

    def __init__(
        self,
        game: str | Path | Game,
        level: Levels = None,
        *,
        num_envs: int = 1,
        observation: Kind = "planes",
        size: tuple[int, int] | None = None,
        cell: int = 8,
        max_steps: int | None = None,
        max_episode_steps: int | None = None,
        reward: Reward = "score",
        autoreset_mode: str | AutoresetMode = AutoresetMode.NEXT_STEP,
        threads: int = 0,
        copy: bool = True,
        render_mode: str | None = None,
    ) -> None:
        """Creates a vector environment.

        Args:
            game: a game, or an argument for :func:`infinite_arcade.load`.
            level: the numbers of one level or several levels, or None for all levels.
            num_envs: the number of environments.
            observation: ``planes``, ``symbols``, ``rgb`` or ``full``.
            size: the number of columns and the number of rows of observed boards; by default those of the largest
                level of the game.
            cell: the size of a cell in images, in pixels.
            max_steps: the number of steps after which an episode is truncated; by default the limit of the game.
            max_episode_steps: the name of ``max_steps`` in :func:`gymnasium.make_vec`.
            reward: ``score`` or ``outcome``.
            autoreset_mode: when the next episode starts after one has finished.
            threads: the maximum number of threads, or 0 for all cores. Fewer than 256 environments use a single thread.
                The number does not affect results.
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
        self._lanes = EpisodeLanes(
            game,
            level,
            num_envs,
            observation=observation,
            size=size,
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
        self._is_seeded = self._has_started = False

    @property
    def planes(self) -> list[str]:
        """The names of the sprite types of the observation planes, which are arrays of cells, one per type."""
        return self._lanes.native.planes

    @property
    def status_names(self) -> list[str]:
        """The names of the numbers in the ``status`` of full observations."""
        return self._lanes.native.status_names

    @property
    def seeds(self) -> list[str]:
        """The seeds of the environments' current episodes."""
        return self._lanes.native.seeds

    @property
    def levels(self) -> list[int]:
        """The number of each environment's level."""
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
    ) -> tuple[Any, dict[str, Any]]:
        """Starts an episode in every environment, or in the environments selected by ``options["reset_mask"]``.
        ``options["seed"]`` holds the seeds of the episodes themselves, one per environment. ``options["level"]`` holds
        the numbers of their levels, one per environment, or a single number.

        Raises:
            ValueError: if an option or a level does not exist, or if there is not exactly one mask entry, one seed and
                one level per environment.
        """
        options = _checked(options, ("level", "seed", "reset_mask"))
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
                    native.seed(at, seed_text(own), True)
        if "level" in options:
            chosen = np.broadcast_to(np.asarray(options["level"]), self.num_envs)
            for lane in np.flatnonzero(mask):
                lanes.select(int(lane), operator.index(chosen[lane]))
        native.reset(mask, lanes.flat, exact)
        lanes.terminated[mask] = lanes.truncated[mask] = False
        return self._observations(), {}

    def step(
        self, actions: NDArray[np.int64]
    ) -> tuple[Any, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Plays one tick in every environment.

        Raises:
            gymnasium.error.ResetNeeded: if no episode was started, or an episode is over and the environment does not
            reset itself (disabled mode).
            ValueError: unless there is exactly one integer per environment, and each is the index of an action.
        """
        lanes = self._lanes
        if not self._has_started:
            raise gymnasium.error.ResetNeeded("no episode has been started: call reset()")
        if self._mode == AutoresetMode.DISABLED and (lanes.terminated.any() or lanes.truncated.any()):
            raise gymnasium.error.ResetNeeded("some episodes are over: call reset() with a `reset_mask` that selects them")
        actions = np.asarray(actions)
        if actions.shape != (self.num_envs,) or actions.dtype.kind not in "iu":
            found = f"an array of {actions.dtype} with the shape {actions.shape}"
            raise ValueError(f"`actions` must be {self.num_envs} integers, one per environment, not {found}")
        ended = lanes.step(np.ascontiguousarray(actions, np.int64))
        info: dict[str, Any] = {}
        if ended and lanes.last is not None:
            info = self._final(lanes.last)
        rewards = lanes.rewards.copy()
        if lanes.by_outcome:
            rewards = self._outcome_rewards(info)
        return self._observations(), rewards, lanes.terminated.copy(), lanes.truncated.copy(), info

    def render(self) -> tuple[Any, ...] | None:
        """Returns the boards as images, all of the same size, or as text."""
        match self.render_mode:
            case "rgb_array":
                return tuple(self._lanes.frame(at, self._cell) for at in range(self.num_envs))
            case "ansi":
                return tuple(self.state(at).full_text() for at in range(self.num_envs))
            case _:
                return None

    def _observations(self) -> Any:
        observed = self._lanes.observed()
        if not self._copy:
            return observed
        if isinstance(observed, dict):
            return {name: values.copy() for name, values in observed.items()}
        return observed.copy()

    def _final(self, last: Board) -> dict[str, Any]:
        over = self._lanes.terminated | self._lanes.truncated
        boards = np.full(self.num_envs, None, dtype=object)
        scores = np.zeros(self.num_envs)
        outcomes = np.full(self.num_envs, None, dtype=object)
        for at in np.flatnonzero(over):
            scores[at], outcomes[at], status = self._lanes.native.last(int(at))
            boards[at] = last[at].copy()
            if self._lanes.status is not None:
                boards[at] = {"planes": boards[at], "status": np.array(status, np.float32)}
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


def _checked(options: dict[str, Any] | None, known: Sequence[str]) -> dict[str, Any]:
    for name in options or {}:
        if name not in known:
            hint = did_you_mean(name, known) or f"; the options are {', '.join(known)}"
            raise ValueError(f"there is no option `{name}`{hint}")
    return options or {}


def register() -> None:
    """Registers ``InfiniteArcade/Game-v0``, ``InfiniteArcade/Stream-v0`` and the corpus games, such as
    ``InfiniteArcade/Hailglass-v0``. Does nothing if they are already registered.
    """
    ids: dict[str, dict[str, Any]] = {ENV_ID: {}}
    for name in corpus():
        words = "".join(word.capitalize() for word in name.split("-"))
        ids[f"InfiniteArcade/{words}-v0"] = {"game": name}
    for id, arguments in ids.items():
        if id not in gymnasium.registry:
            gymnasium.register(
                id,
                entry_point="infinite_arcade.gymnasium:GameEnv",
                vector_entry_point="infinite_arcade.gymnasium:GameVectorEnv",
                disable_env_checker=False,
                kwargs=arguments,
            )
    if STREAM_ID not in gymnasium.registry:
        gymnasium.register(STREAM_ID, entry_point="infinite_arcade.gymnasium:StreamEnv")


register()
