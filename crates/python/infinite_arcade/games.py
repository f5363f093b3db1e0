"""Games, levels and states."""

from __future__ import annotations

import base64
import json
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _native
from ._arguments import Seed, did_you_mean, seed_text
from ._native import ArcadeError, seed_child, seed_from_text

__all__ = ["CorpusGame", "Episode", "Game", "Level", "State", "corpus", "load", "seed_child", "seed_from_text"]

#: The maximum length of the longer side of a board image in a notebook, in pixels.
_NOTEBOOK_PIXELS = 480


class State:
    """The state of an episode.

    A state is a value. A :meth:`copy` is independent of the original, and the same actions lead both states to the same
    hashes. A pickled state consists of the texts of the game and the level, the seed and the actions. To unpickle it,
    the actions are replayed, at a cost of one forward-model call per tick.
    """

    __slots__ = ("_native",)

    def __init__(self, native: _native.State) -> None:
        self._native = native

    def __reduce__(self) -> Any:
        return _state_of, (_parts_of(self._native.level), self._native.history)

    def __deepcopy__(self, _memo: Any) -> State:
        return self.copy()

    @property
    def ticks(self) -> int:
        """The number of ticks played so far."""
        return self._native.ticks

    @property
    def score(self) -> float:
        """The current score."""
        return self._native.score

    @property
    def outcome(self) -> str:
        """The outcome: ``ongoing``, ``won``, ``lost``, ``ended`` (over without a winner) or ``stopped`` (by a limit).
        """
        return self._native.outcome

    @property
    def stopped_by(self) -> str | None:
        """A description of the limit that stopped the episode, or None if no limit stopped it."""
        return self._native.stopped_by

    @property
    def is_over(self) -> bool:
        """True once the episode is over."""
        return self._native.is_over

    @property
    def size(self) -> tuple[int, int]:
        """The board's number of columns and number of rows."""
        return self._native.size

    @property
    def actions(self) -> list[str]:
        """The available actions except ``nil``, sorted. If there is no avatar, the only action is ``nil``."""
        return self._native.actions

    def step(self, action: str) -> str:
        """Plays one tick and returns the outcome. An action that the avatar does not have is treated as ``nil``.

        Raises:
            ValueError: if no action has this name; see :data:`infinite_arcade.ACTIONS`.
        """
        return self._native.step(action)

    def play(self, actions: Sequence[str]) -> list[str]:
        """Plays one action per tick until the episode is over. Returns the state hash after each tick.

        Raises:
            ValueError: if any name is not the name of an action. Nothing is played in this case.
        """
        return self._native.play(list(actions))

    def state_hash(self) -> str:
        """Returns a 128-bit hash of everything that can influence the future, as hexadecimal digits."""
        return self._native.state_hash()

    def copy(self) -> State:
        """Returns a copy of the state with the same random future."""
        return State(self._native.copy())

    __copy__ = copy

    def fork(self, seed: Seed) -> State:
        """Returns a copy of the state with a different random future, for planners to search.

        Raises:
            TypeError: if ``seed`` is neither a text nor an integer.
        """
        return State(self._native.fork(seed_text(seed)))

    def observe(self) -> dict[str, Any]:
        """Returns a player's observation as a dictionary.

        Its keys are ``ticks``, ``score``, ``outcome``, ``columns``, ``rows``, ``cells``, ``resources`` and
        ``avatar``. ``cells`` is ``[rows][columns]``, with the names of the visible sprites in each cell in drawing
        order. ``resources`` holds names and amounts. ``avatar`` holds name, column, row, facing and health, or is
        None once the avatar is gone.
        """
        return self._native.observe()

    def planes(self) -> NDArray[np.uint8]:
        """Returns the board as ``[types][rows][columns]``, uint8, with 1 in each cell that contains a sprite of the
        type. :attr:`Game.types` lists the types.
        """
        columns, rows = self.size
        return self._native.planes().reshape(-1, rows, columns)

    def text(self) -> str:
        """Returns the board as lines of characters. :attr:`Game.symbols` lists their meanings."""
        return self._native.text()

    def full_text(self) -> str:
        """Returns the board as text, followed by the tick, the score, the held resources and a legend."""
        return self._native.full_text()

    def rgb(self, cell: int = 16) -> NDArray[np.uint8]:
        """Returns the board as an image, ``[rows × cell][columns × cell][3]``, uint8.

        Raises:
            ValueError: if a cell is smaller than 4 or larger than 256 pixels, or the image would be too large.
        """
        height, width, flat = self._native.rgb(cell)
        return flat.reshape(height, width, 3)

    def png(self, cell: int = 24, *, caption: bool = False, legend: bool = False) -> bytes:
        """Returns the board as a PNG file, whose bytes are identical on every machine.

        Raises:
            ValueError: in the same cases as :meth:`rgb`.
        """
        return self._native.png(cell, caption=caption, legend=legend)

    def svg(self, cell: int = 24, *, caption: bool = False, legend: bool = False) -> str:
        """Returns the board as an SVG image.

        Raises:
            ValueError: in the same cases as :meth:`rgb`.
        """
        return self._native.svg(cell, caption=caption, legend=legend)

    def _repr_html_(self) -> str:
        cell = max(8, min(32, _NOTEBOOK_PIXELS // max(*self.size, 1)))
        return picture_html(self.png(cell, caption=True), f"{self!r}")

    def __repr__(self) -> str:
        return repr(self._native)


class Level:
    """A level of a particular game. A pickled level consists of the texts of the game and the level."""

    __slots__ = ("_native", "number", "optimal_ticks")

    def __init__(self, native: _native.Level, number: int = 0, optimal_ticks: int | None = None) -> None:
        self._native = native
        #: The index of the level in the game.
        self.number = number
        #: The number of ticks in the shortest win, if that win is proved to be optimal.
        self.optimal_ticks = optimal_ticks

    def __reduce__(self) -> Any:
        return _level_of, (_parts_of(self._native), self.number, self.optimal_ticks)

    @property
    def name(self) -> str:
        """The level's name in messages."""
        return self._native.name

    @property
    def digest(self) -> str:
        """The BLAKE3 hash of the level's canonical text, as hexadecimal digits."""
        return self._native.digest

    @property
    def size(self) -> tuple[int, int]:
        """The level's number of columns and number of rows."""
        return self._native.columns, self._native.rows

    @property
    def text(self) -> str:
        """The canonical text of the level, with rows of equal length that each end with a newline."""
        return self._native.text

    def describe(self) -> list[str]:
        """Returns the facts proven about the level, one sentence per fact."""
        return self._native.describe()

    def start(self, seed: Seed) -> State:
        """Returns the state before the first tick. The game's randomness is derived from ``seed``, which is a text or
        an integer. If the text has 64 hexadecimal digits, they are the seed itself. An integer is the same seed as
        its decimal digits.

        Raises:
            TypeError: if ``seed`` is neither a text nor an integer.
        """
        return State(self._native.start(seed_text(seed)))

    def _repr_html_(self) -> str:
        return self.start("preview")._repr_html_()

    def __repr__(self) -> str:
        return repr(self._native)


@dataclass(frozen=True)
class Episode:
    """An episode, which consists of a level, a seed and actions. They suffice to replay the episode. A notebook shows
    an episode as an animation.
    """

    level: Level
    seed: Seed
    actions: tuple[str, ...]

    def replay(self) -> State:
        """Replays the episode and returns its last state."""
        state = self.level.start(self.seed)
        state.play(self.actions)
        return state

    def gif(self, cell: int = 16, *, delay: int = 12, caption: bool = True) -> bytes:
        """Returns the episode as an animated GIF, with one frame per tick. Each frame lasts ``delay`` hundredths of a
        second. The GIF has the same bytes on every machine.

        Raises:
            ValueError: if any name is not the name of an action, or the images would be too large.
        """
        return self.level._native.gif(seed_text(self.seed), list(self.actions), cell, delay, caption)

    def _repr_html_(self) -> str:
        cell = max(8, min(24, _NOTEBOOK_PIXELS // max(*self.level.size, 1)))
        return picture_html(self.gif(cell), f"{self.level!r}, {len(self.actions)} actions", kind="gif")


class Game:
    """A compiled game and its levels. A pickled game consists of the texts of the game and its levels, and is compiled
    again when it is unpickled.
    """

    __slots__ = ("_native", "id", "levels", "title")

    def __init__(
        self,
        source: str,
        levels: Sequence[str] = (),
        *,
        name: str | None = None,
        id: str | None = None,
        title: str | None = None,
        as_reference: bool = False,
    ) -> None:
        """Compiles a game and checks its levels.

        Args:
            source: the rules of the game in VGDL.
            levels: the texts of the levels, in order.
            name: the name of the game in messages.
            id: the name of the game in logs and tables; by default ``name`` without its extension, followed by the
                first digits of the digest if ``name`` is not given.
            title: the title of the game; by default its ID.
            as_reference: tolerate the faults that the reference engine tolerates.

        Raises:
            VgdlError: if the game or a level has problems. The exception prints like the messages of ``arcade``.
        """
        self._native = _native.Game(source, name=name or "game.vgdl", as_reference=as_reference)
        self.id = id or (Path(name).stem if name else f"game-{self.digest[:8]}")
        self.title = title or self.id
        #: The levels of the game, in order.
        self.levels: list[Level] = []
        for text in levels:
            self.levels.append(self.level(text))

    def __reduce__(self) -> Any:
        rules = (self.source, self.name, self._native.as_reference)
        levels = [(level.text, level.name, level.number, level.optimal_ticks) for level in self.levels]
        return _game_of, (rules, self.id, self.title, levels)

    def level(self, text: str, *, name: str | None = None, optimal_ticks: int | None = None) -> Level:
        """Checks the text of a level and returns the level. Its number is that of the next level of the game. The
        game itself does not change: to add the level, append it to :attr:`levels`.

        Raises:
            VgdlError: if the level has problems.
        """
        number = len(self.levels)
        native = self._native.level(text, name=name or f"lvl{number}.txt")
        return Level(native, number, optimal_ticks)

    def save(self, folder: str | Path) -> None:
        """Writes the game and its levels into a folder, from which :func:`load` and ``arcade`` read them. The files
        are ``game.vgdl``, ``lvl0.txt`` and so on.

        Raises:
            FileExistsError: if the folder exists and is not empty.
        """
        folder = Path(folder)
        if folder.exists() and any(folder.iterdir()):
            raise FileExistsError(f"{folder}: the folder is not empty; pass a new or empty folder")
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "game.vgdl").write_text(self.source, "utf-8")
        for number, level in enumerate(self.levels):
            (folder / f"lvl{number}.txt").write_text(level.text, "utf-8")

    @property
    def name(self) -> str:
        """The game's name in messages."""
        return self._native.name

    @property
    def source(self) -> str:
        """The game's source text."""
        return self._native.source

    @property
    def digest(self) -> str:
        """The BLAKE3 hash of the game's canonical form without comments, as hexadecimal digits."""
        return self._native.digest

    @property
    def actions(self) -> list[str]:
        """The actions that can have an effect in this game, starting with ``nil``. Action ``i`` of the environments
        is ``actions[i]``.
        """
        return self._native.actions

    @property
    def types(self) -> list[str]:
        """The names of the sprite types that players can see, in the order of the planes (one array per type)."""
        return self._native.types

    @property
    def symbols(self) -> dict[str, str]:
        """The character that represents each visible type on boards of symbols. Floors are shown as ``.``."""
        return dict(self._native.symbols)

    @property
    def time_limit(self) -> int:
        """The maximum number of ticks in an episode of the game."""
        return self._native.time_limit

    @property
    def is_deterministic(self) -> bool:
        """True if the game draws no random numbers."""
        return self._native.is_deterministic

    @property
    def warnings(self) -> list[dict[str, Any]]:
        """Warnings about parts of the text that are valid but probably not intended. Each warning has ``code``,
        ``message``, ``line``, ``column`` and ``help``.
        """
        return self._native.warnings

    def describe(self) -> str:
        """Returns the game's rules in plain English."""
        return self._native.describe()

    def facts(self) -> dict[str, Any]:
        """Returns the game's taxonomy, and the facts proven about its rules."""
        facts: dict[str, Any] = json.loads(self._native.facts())
        return facts

    def _level_texts(self) -> list[tuple[int, str, int | None]]:
        return [(level.number, level.text, level.optimal_ticks) for level in self.levels]

    def _repr_html_(self) -> str:
        board = self.levels[0]._repr_html_() if self.levels else ""
        return f"<h4>{_escaped(self.title)}</h4>{board}<pre>{_escaped(self.describe())}</pre>"

    def __repr__(self) -> str:
        return f"<Game {self.id} {self.digest[:8]}, {len(self.levels)} levels>"


@dataclass(frozen=True)
class CorpusGame:
    """A hand-written corpus game that has not been compiled yet."""

    name: str
    source: str = field(repr=False)
    levels: tuple[str, ...] = field(repr=False)
    card: dict[str, Any] = field(repr=False)

    def compile(self) -> Game:
        """Compiles the game and its levels."""
        title = str(self.card.get("title", self.name))
        return Game(self.source, self.levels, name=f"{self.name}/game.vgdl", id=self.name, title=title)


@cache
def corpus() -> dict[str, CorpusGame]:
    """Returns the corpus games by name. They are embedded in the package."""
    return {
        name: CorpusGame(name, source, tuple(levels), tomllib.loads(card))
        for name, source, levels, card in _native.corpus()
    }


def load(game: str | Path, *, as_reference: bool = False) -> Game:
    """Loads a game and its levels.

    ``game`` is a ``.vgdl`` or ``.txt`` file, a folder that contains such a file, the file of a level, or the name of
    a corpus game. Levels are in the same folder as the game's file. They are named ``lvl0.txt`` and so on, or
    ``NAME_lvl0.txt`` and so on for a file ``NAME.txt``. If ``game`` is a level, the game is loaded with only that
    level.

    Raises:
        FileNotFoundError: if there is no such file, folder or corpus game.
        VgdlError: if the game or one of its levels has problems.
        ArcadeError: if a file is not UTF-8, or a folder contains several games.
        TypeError: if ``game`` is neither a path nor a name.
    """
    if not isinstance(game, (str, Path)):
        raise TypeError(f"`game` must be one game, by path or name, not {type(game).__name__}")
    path = Path(game)
    asked = None
    if path.is_dir():
        found = _native.games_of_files(_names(path))
        if not found:
            raise FileNotFoundError(f"{path}: this folder contains no game.vgdl or game.txt, and no NAME.txt with NAME_lvl0.txt next to it")
        if len(found) > 1:
            raise ArcadeError(f"{path}: this folder contains {len(found)} games; pass one, such as {path / found[0][0]}")
        path = path / found[0][0]
    elif not path.exists():
        if str(game) in corpus():
            return corpus()[str(game)].compile()
        hint = did_you_mean(str(game), corpus(), "the corpus game ")
        raise FileNotFoundError(f"{game}: there is no such file, folder or corpus game{hint}")
    elif (source := _native.game_of_level(path.name, _names(path.parent))) is not None:
        asked, path = path, path.parent / source
    own = _native.levels_of_files(path.name, _names(path.parent))
    files = [path.parent / name for _, name in own] if asked is None else [asked]
    id = path.parent.resolve().name if path.stem.lower() == "game" else path.stem
    loaded = Game(_text(path), name=str(path), id=id, as_reference=as_reference)
    for file in files:
        loaded.levels.append(loaded.level(_text(file), name=str(file)))
    return loaded


def game_of(game: str | Path | Game) -> Game:
    """Returns the game itself, or the game that :func:`load` loads."""
    return game if isinstance(game, Game) else load(game)


#: The parts of a pickled level: the source, name and mode of the game, and the text and name of the level.
_Parts = tuple[str, str, bool, str, str]


def _parts_of(level: _native.Level) -> _Parts:
    game = level.game
    return game.source, game.name, game.as_reference, level.text, level.name


@lru_cache(maxsize=64)
def _compiled(source: str, name: str, as_reference: bool) -> _native.Game:
    return _native.Game(source, name=name, as_reference=as_reference)


def _native_level_of(parts: _Parts) -> _native.Level:
    source, name, as_reference, text, level_name = parts
    return _compiled(source, name, as_reference).level(text, name=level_name)


def _level_of(parts: _Parts, number: int, optimal_ticks: int | None) -> Level:
    return Level(_native_level_of(parts), number, optimal_ticks)


def _state_of(parts: _Parts, history: list[tuple[str, list[str]]]) -> State:
    (seed, actions), *forks = history
    state = _native_level_of(parts).start(seed)
    state.play(actions)
    for seed, actions in forks:
        state = state.fork(seed)
        state.play(actions)
    return State(state)


def _game_of(
    rules: tuple[str, str, bool], id: str, title: str, levels: list[tuple[str, str, int, int | None]]
) -> Game:
    source, name, as_reference = rules
    game = Game(source, name=name, id=id, title=title, as_reference=as_reference)
    for text, level_name, number, optimal_ticks in levels:
        game.levels.append(Level(game._native.level(text, name=level_name), number, optimal_ticks))
    return game


def _names(folder: Path) -> list[str]:
    return [file.name for file in folder.iterdir() if not file.is_dir()]


def _text(path: Path) -> str:
    try:
        return path.read_text("utf-8")
    except UnicodeDecodeError as error:
        raise ArcadeError(f"{path}: not a text file (byte {error.start} is not UTF-8); save it as UTF-8") from None


def picture_html(picture: bytes, title: str, *, kind: str = "png") -> str:
    """Returns an HTML image element that contains the image."""
    data = base64.b64encode(picture).decode("ascii")
    return f'<img alt="{_escaped(title)}" title="{_escaped(title)}" src="data:image/{kind};base64,{data}">'


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;").replace('"', "&quot;")
