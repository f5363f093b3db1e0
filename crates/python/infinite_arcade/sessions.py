"""Episodes that are played through text. All text interfaces share this module: Inspect, verifiers, MCP and OpenEnv.

>>> import infinite_arcade as ia
>>> from infinite_arcade.sessions import Shelf, TextSession
>>> session = TextSession(*Shelf("hailglass").find(level=0), seed="a seed")
>>> text = session.act("right")
>>> session.history
['right']

The suite plays each episode with the prompts, the answer parser and the log of ``arcade evaluate``. An episode with the
same seed, level and run therefore has the same randomness and the same texts through every interface.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from . import _native
from ._arguments import Seed, at_least, check_games, check_levels, did_you_mean, level_numbers, seed_text
from ._native import ArcadeError
from .games import Episode, Game, Level, corpus, load, seed_child, seed_from_text
from .rewards import RewardComponents, reward_components
from .snapshots import open_snapshot
from .streams import Stream

__all__ = [
    "CONTEXTUAL",
    "Shelf",
    "TextSession",
    "add_arguments",
    "facts_of",
    "games_of",
    "level_texts",
    "native_game",
    "open_series",
    "replay_log",
    "section",
    "shelf_of",
]

#: Prompt settings for conversations that are never truncated. Each message then shows only the current turn.
CONTEXTUAL = json.dumps({"mode": "contextual", "history_tokens": 1 << 40})

#: The number of levels of an endless stream from which seeds draw.
ENDLESS = 1_000_000


def facts_of(game: Game, levels: Sequence[Level], **options: Any) -> dict[str, Any]:
    """Returns the texts of a game and its levels together with the options of an episode, as plain data. They suffice
    to play an episode and to replay its log.
    """
    return {
        "game": game.id,
        "source": game.source,
        "as_reference": game._native.as_reference,
        "level_texts": [(level.number, level.text, level.optimal_ticks) for level in levels],
        **options,
    }


def native_game(facts: dict[str, Any]) -> _native.Game:
    """Compiles the game of the facts."""
    return _native.Game(facts["source"], name=facts["game"], as_reference=facts["as_reference"])


def open_series(
    facts: dict[str, Any], run: int, *, game: _native.Game | None = None, folder: Path | None = None
) -> _native.Series:
    """Starts the episodes that the facts describe. ``game`` is the compiled game, if there is one."""
    return _native.Series(
        game or native_game(facts),
        facts["game"],
        level_texts(facts),
        group=facts.get("group", 0),
        run=run,
        seed=facts["seed"],
        max_steps=facts["max_steps"],
        commit=facts["commit"],
        track=facts.get("track"),
        prompts=facts["prompts"],
        reasks=facts["reasks"],
        folder=folder,
    )


def replay_log(
    facts: dict[str, Any], log: str, *, level: int, run: int, game: _native.Game | None = None
) -> dict[str, Any]:
    """Replays a log on its level, and returns its results.

    Raises:
        LogError: if the log differs from its replay, or belongs to a different episode.
    """
    found: dict[str, Any] = json.loads(
        _native.replay_log(
            game or native_game(facts),
            facts["game"],
            level_texts(facts),
            log,
            level=level,
            run=run,
            seed=facts["seed"],
            max_steps=facts["max_steps"],
            commit=facts["commit"],
            track=facts.get("track"),
        )
    )
    return found


def level_texts(facts: dict[str, Any]) -> list[tuple[int, str, int | None]]:
    """Returns the levels of the facts as the extension takes them. JSON turns tuples into lists."""
    return [(number, text, optimal) for number, text, optimal in facts["level_texts"]]


def games_of(source: str | Path, wanted: Sequence[str] | None = None) -> list[Game]:
    """Returns the games of a source, which is ``corpus``, a release's folder, a game's file or folder, or the name of a
    corpus game.

    Raises:
        ValueError: if a wanted game does not exist.
        FileNotFoundError: if there is no such source.
        ArcadeError: if the folder is a release that does not verify.
    """
    if source == "corpus":
        check_games(wanted, corpus(), "the corpus")
        return [found.compile() for name, found in corpus().items() if wanted is None or name in wanted]
    if not (Path(source) / "MANIFEST.json").is_file():
        game = load(source)
        check_games(wanted, [game.id], str(source))
        return [game]
    there = {found.id: found for found in open_snapshot(source).games()}
    check_games(wanted, there, str(source))
    return [found.compile() for id, found in there.items() if wanted is None or id in wanted]


class Shelf:
    """The levels that a server offers: those of several games, or those of a stream."""

    def __init__(
        self,
        source: str | Path | Stream,
        *,
        games: Sequence[str] | None = None,
        levels: Sequence[int] | None = None,
    ) -> None:
        """Opens the levels.

        Args:
            source: a stream, or an argument for :func:`games_of`.
            games: the IDs of the games to include; by default all games.
            levels: the numbers of the levels to include; by default all levels.

        Raises:
            ValueError: if a game or level does not exist, or there is no level.
        """
        self.stream = source if isinstance(source, Stream) else None
        self.games: list[Game] = [] if isinstance(source, Stream) else games_of(source, games)
        check_levels(levels, (level.number for game in self.games for level in game.levels))
        self._levels = [
            (game, level) for game in self.games for level in game.levels if levels is None or level.number in levels
        ]
        if self.stream is None and not self._levels:
            raise ValueError(f"{source}: there is no level to play; choose a game with levels")

    def __len__(self) -> int:
        """Returns the number of levels. For an endless stream, this is the number of levels that seeds draw."""
        return len(self._levels) if self.stream is None else self.stream.num_levels or ENDLESS

    def __getitem__(self, index: int) -> tuple[Game, Level]:
        """Returns the level at an index, and its game.

        Raises:
            IndexError: if there is no level at this index.
            ArcadeError: if the stream has no level at this index.
        """
        if not 0 <= index < len(self):
            raise IndexError(f"there is no level at index {index}; the indices are 0 to {len(self) - 1}")
        if self.stream is None:
            return self._levels[index]
        game = self.stream[index].alone()
        return game, game.levels[0]

    def witness(self, level: Level) -> Episode | None:
        """Returns the winning episode that came with a level of a stream, or None for other levels."""
        return None if self.stream is None else self.stream[level.number - self.stream.start_level].witness

    def draw(self, seed: Seed) -> tuple[Game, Level]:
        """Returns the level that a seed draws, and its game."""
        return self[int(seed_child(seed_from_text(seed_text(seed)), "item", 0)[:15], 16) % len(self)]

    def find(self, game: str | None = None, level: int | None = None) -> tuple[Game, Level]:
        """Returns the first level with the given game and number. In a stream, the number is the index of the item.

        Raises:
            ValueError: if there is no such game or level. The message lists what exists.
            ArcadeError: if the stream has no level at this index.
        """
        if self.stream is not None:
            first, number = self.stream.start_level, self.stream.num_levels
            index = first if level is None else level
            if game is not None:
                raise ValueError("a stream chooses its games itself; give only a level, which is the index of an item")
            if index < first or number and index >= first + number:
                raise ValueError(f"there is no level {index}; the levels are {first} to {first + len(self) - 1}")
            own = self.stream[index - first].alone()
            return own, own.levels[0]
        if game is not None:
            check_games([game], dict.fromkeys(own.id for own, _ in self._levels), "this session")
        there = [(own, one) for own, one in self._levels if game in (None, own.id)]
        if level is not None:
            check_levels([level], (one.number for _, one in there))
        return next((own, one) for own, one in there if level in (None, one.number))


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds the arguments from which :func:`shelf_of` opens the levels of a server."""
    parser.add_argument(
        "source", nargs="?", default="corpus",
        help="`corpus`, a corpus game, a game's file or folder, a release's folder, or `stream`; default: corpus",
    )
    parser.add_argument("stream_seed", nargs="?", metavar="seed", help="the seed of the stream, after `stream`")
    parser.add_argument("--games", help="the games to include, separated by commas; default: all games")
    parser.add_argument("--levels", help="the numbers of the levels to include, separated by commas; default: all levels")
    parser.add_argument("--difficulty", type=float, help="the difficulty of the stream's levels, from 0 to 1")
    parser.add_argument("--from", dest="start", type=int, default=0, help="the index of the stream's first level; default: 0")
    parser.add_argument("--count", type=int, default=0, help="the number of the stream's levels; default: endless")
    parser.add_argument("--avoid", action="append", default=[], help="a release whose levels the stream avoids; repeatable")
    parser.add_argument("--max-steps", type=int, default=1000, help="the maximum number of actions per episode; default: 1000")


def shelf_of(arguments: argparse.Namespace) -> Shelf:
    """Opens the levels that the command line requests.

    Raises:
        ValueError: if a game or level does not exist, or the arguments contradict each other.
        FileNotFoundError: if there is no such source.
        ArcadeError: if a release does not verify.
    """
    games = arguments.games.split(",") if arguments.games else None
    if arguments.source == "stream":
        if arguments.stream_seed is None:
            raise ValueError("the seed of the stream is missing; give it after `stream`, such as `stream lesson-1`")
        if arguments.levels:
            raise ValueError("a stream has no `--levels`; choose items with `--from` and `--count`")
        numbers = {"start_level": arguments.start, "num_levels": arguments.count}
        stream = Stream(
            arguments.stream_seed, games, difficulty=arguments.difficulty, avoid=arguments.avoid, **numbers
        )
        return Shelf(stream)
    if arguments.stream_seed is not None:
        raise ValueError(f"`{arguments.stream_seed}` is one argument too many; only `stream` takes a seed")
    return Shelf(arguments.source, games=games, levels=level_numbers(arguments.levels or None))


def section(text: str, heading: str) -> str:
    """Returns the part of an observation below a heading, or an empty text if there is no such heading."""
    _, found, rest = f"\n{text}".partition(f"\n## {heading}\n")
    return rest.partition("\n## ")[0].strip() if found else ""


class TextSession:
    """An episode that is played through text, one action at a time.

    :attr:`rules` is the text before the first turn, and :attr:`observation` is the text of the current turn. Both are
    the texts that ``arcade evaluate`` shows a model in the contextual mode.
    """

    def __init__(
        self, game: Game, level: Level, *, seed: Seed = "evaluate", run: int = 0, max_steps: int = 1000
    ) -> None:
        """Starts an episode.

        Args:
            game: the game.
            level: the level.
            seed: the text or integer from which the game's randomness is derived.
            run: the number of the episode. Episodes with different numbers have different randomness.
            max_steps: the number of actions after which the episode is over.

        Raises:
            ArcadeError: if the game ends before the first action.
        """
        at_least(0, run=run)
        at_least(1, max_steps=max_steps)
        self.game, self.level, self.run, self.max_steps = game, level, run, max_steps
        #: The texts and settings of the episode, which :func:`replay_log` takes.
        self.facts = facts_of(
            game,
            [level],
            seed=seed_text(seed),
            max_steps=max_steps,
            commit="1",
            prompts=CONTEXTUAL,
            reasks=0,
        )
        self._series = open_series(self.facts, run, game=game._native)
        request = self._series.next_request()
        if request is None:
            raise ArcadeError(f"{game.id}, level {level.number}: the game ends before the first action")
        # The answer's format is that of a chat. Here, actions have an interface of their own.
        self.rules: str = request[0][1].split("\n## Answer\n")[0].rstrip() + "\n"
        self.observation: str = request[-1][1]
        #: The actions played so far.
        self.history: list[str] = []
        #: True once the episode is over.
        self.is_over = False
        self._state = level.start(self._series.seeds[0])

    @property
    def actions(self) -> list[str]:
        """The actions that are available now and can have an effect. ``nil`` does nothing."""
        if self.is_over:
            return []
        available = ["nil", *self._state.actions]
        return [name for name in self.game.actions if name in available]

    @property
    def score(self) -> float:
        """The current score."""
        return self._state.score

    @property
    def outcome(self) -> str:
        """The outcome, such as ``won``. It stays ``ongoing`` if the episode ends after ``max_steps`` actions."""
        return self._state.outcome

    def components(self, witness: Episode) -> RewardComponents:
        """Returns the components of the episode's reward, compared with a winning episode of the level."""
        return reward_components(self._state, witness)

    def state_hash(self) -> str:
        """Returns the hash of the current state."""
        return self._state.state_hash()

    def act(self, action: str) -> str:
        """Plays one action and returns the new observation.

        Raises:
            ValueError: if the episode is over, or the action is not available now. Nothing is played then.
        """
        if self.is_over:
            raise ValueError(f"the episode is over ({self.outcome}); reset to play again")
        if action not in self.actions:
            hint = did_you_mean(action, self.actions)
            raise ValueError(f"there is no action `{action}` now{hint}; the actions are {', '.join(self.actions)}")
        self._series.answer(f"ACTION: {action}")
        self._state.step(action)
        self.history.append(action)
        request = self._series.next_request()
        if request is None:
            self.is_over = True
            self.observation = self._ending()
        else:
            self.observation = request[-1][1]
        return self.observation

    def play(self, actions: Iterable[str]) -> list[str]:
        """Plays actions until the episode is over, and returns the observations.

        Raises:
            ValueError: if an action is not available. The actions before it have been played.
        """
        seen = list[str]()
        for action in actions:
            if seen and self.is_over:
                break
            seen.append(self.act(action))
        return seen

    def log(self) -> str:
        """Returns the log of the episode as JSON lines, in the format of ``arcade evaluate``. An episode that is not
        over yet is aborted.
        """
        if not self.is_over:
            self._series.fail("the player has stopped")
            self._series.next_request()
            self.is_over = True
        [played] = self._series.results()
        return str(played["log"])

    def _ending(self) -> str:
        text = {
            "won": "You won",
            "lost": "You lost",
            "ended": "The game ended without a winner",
            "stopped": "The engine stopped the game",
            "ongoing": "You did not win within the allowed number of actions",
        }[self.outcome]
        ticks = f"{self._state.ticks} tick{'' if self._state.ticks == 1 else 's'}"
        score = f"{self.score:g}"
        return f"## End\n{text} after {ticks}, with score {score}.\n\n## Board\n{self._state.text()}"
