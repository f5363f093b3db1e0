"""Endless sequences of verified levels, for training.

>>> import infinite_arcade as ia
>>> lessons = ia.stream("lessons", games=["hailglass"], difficulty=0.2)
>>> lessons[1000].level.start("a seed").outcome
'ongoing'
"""

from __future__ import annotations

import json
import operator
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import count
from pathlib import Path
from typing import Any

from . import _native
from ._arguments import Seed, at_least, pair, seed_text
from .games import Episode, Game, Level, corpus, game_of

__all__ = ["Stream", "StreamItem", "stream"]

#: One game, several games, or None for the corpus.
Games = str | Path | Game | Iterable[str | Path | Game] | None

#: The letters of actions in witnesses.
_LETTERS = {".": "nil", "U": "up", "L": "left", "D": "down", "R": "right", "X": "use"}

#: The number of items that a stream keeps in memory.
_KEPT = 1024


@dataclass(frozen=True)
class StreamItem:
    """A verified level of a stream."""

    #: The index of the item in the stream, from which ``arcade stream --from`` makes it again.
    index: int
    game: Game = field(repr=False)
    level: Level
    #: A winning episode.
    witness: Episode = field(repr=False)
    #: The requested difficulty, from 0 to 1, or None.
    difficulty: float | None
    #: The steps from the seed of the stream to the seed of the level.
    path: tuple[tuple[str, int], ...] = field(repr=False)

    def alone(self) -> Game:
        """Returns the game with this level as its only level, for the environments and the evaluation tasks."""
        source, tolerant = self.game.source, self.game._native.as_reference
        game = Game(source, name=self.game.name, id=self.game.id, title=self.game.title, as_reference=tolerant)
        game.levels.append(Level(self.level._native, self.index))
        return game


class Stream:
    """An endless sequence of verified levels. :func:`stream` creates it.

    ``stream[n]`` makes item ``n`` without the items before it, in a tenth of a second for most games. The same arguments
    give the same items in every process. A pickled stream consists of its arguments.
    """

    def __init__(
        self,
        seed: Seed,
        games: Games = None,
        *,
        difficulty: float | None = None,
        size: tuple[int, int] | None = None,
        start_level: int = 0,
        num_levels: int = 0,
        avoid: Iterable[str | Path] = (),
    ) -> None:
        at_least(0, start_level=start_level, num_levels=num_levels)
        if difficulty is not None and not 0 <= difficulty <= 1:
            raise ValueError(f"`difficulty` must be from 0 to 1, not {difficulty}")
        if isinstance(games, (str, Path, Game)):
            games = [games]
        #: The games of the stream.
        self.games: list[Game] = [game_of(game) for game in (corpus() if games is None else games)]
        self.start_level, self.num_levels = start_level, num_levels
        self._arguments: tuple[str, float | None, tuple[int, int] | None, list[str]] = (
            seed_text(seed),
            difficulty,
            size,
            [str(path) for path in avoid],
        )
        self._open()

    def _open(self) -> None:
        seed, difficulty, size, avoid = self._arguments
        self._native = _native.Stream(
            [(game.id, game._native, [level._native for level in game.levels]) for game in self.games],
            seed=seed,
            difficulty=difficulty,
            size=None if size is None else pair(size),
            avoid=avoid,
        )
        self._item = lru_cache(_KEPT)(self._make)

    def __getstate__(self) -> dict[str, Any]:
        names = ("games", "start_level", "num_levels", "_arguments")
        return {name: getattr(self, name) for name in names}

    def __setstate__(self, saved: dict[str, Any]) -> None:
        self.__dict__.update(saved)
        self._open()

    def __getitem__(self, position: int) -> StreamItem:
        """Returns the item at a position. Item ``start_level`` is at position 0. If ``num_levels`` is not 0, the
        positions repeat this number of items.

        Raises:
            IndexError: if the position is negative.
            ArcadeError: if the stream has no level at this position.
            KeyboardInterrupt: soon after Ctrl-C.
        """
        position = operator.index(position)
        if position < 0:
            raise IndexError(f"a stream has no position {position}, because it has no end")
        return self._item(self.start_level + (position % self.num_levels if self.num_levels else position))

    def __iter__(self) -> Iterator[StreamItem]:
        """Returns an iterator over the items from position 0. It does not end."""
        return (self[position] for position in count())

    def _make(self, index: int) -> StreamItem:
        made: dict[str, Any] = json.loads(self._native.item(index))
        game = next(game for game in self.games if game.digest == made["rules"])
        text = "".join(f"{row}\n" for row in made["level"])
        level = game.level(text, name=f"item {index}")
        level.number = index
        witness = Episode(level, made["witness_seed"], tuple(_LETTERS[letter] for letter in made["witness"]))
        path = tuple((str(purpose), int(at)) for purpose, at in made["path"])
        return StreamItem(index, game, level, witness, made["difficulty"], path)

    def __repr__(self) -> str:
        return f"<Stream {self._arguments[0]!r} of {len(self.games)} games>"


def stream(
    seed: Seed,
    games: Games = None,
    *,
    difficulty: float | None = None,
    size: tuple[int, int] | None = None,
    start_level: int = 0,
    num_levels: int = 0,
    avoid: Iterable[str | Path] = (),
) -> Stream:
    """Returns the endless sequence of verified levels that ``arcade stream`` prints (``arcade docs train``).

    Each level meets the criteria of a release and comes with a win. Items share no seed with any release, and no item
    equals a level of the corpus, not even mirrored, turned or renamed.

    Args:
        seed: the text or integer from which the stream is derived.
        games: the games whose levels are generated, or arguments for :func:`infinite_arcade.load`; by default the
            corpus. Items draw their game from this list, whose order does not matter.
        difficulty: the difficulty from 0 (easiest) to 1 (hardest); by default, every item draws its own.
        size: the number of columns and the number of rows; by default, sizes similar to those of the game's own levels.
        start_level: the index of the item at position 0.
        num_levels: the number of different items, which then repeat, or 0 for an endless sequence.
        avoid: the folders or archives of releases whose levels no item may equal.

    Raises:
        ValueError: if a number is out of range, two games have the same rules, or the generator does not support a game.
        ArcadeError: if a release in ``avoid`` does not verify.
        KeyboardInterrupt: soon after Ctrl-C.
    """
    return Stream(
        seed,
        games,
        difficulty=difficulty,
        size=size,
        start_level=start_level,
        num_levels=num_levels,
        avoid=avoid,
    )
