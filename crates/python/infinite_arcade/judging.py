"""Judges levels, and generates levels and games."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Literal

from . import _native
from ._arguments import Seed, at_least, pair, seed_text
from .games import Game, Level, game_of

__all__ = ["generate_games", "generate_levels", "validate"]

#: The methods of generators.
Method = Literal["constructive", "search", "evolutionary"]

#: The labels of difficulty, from easiest to hardest.
Difficulty = Literal["very_easy", "easy", "medium", "hard", "very_hard", "unbeaten"]


def validate(level: Level, *, budget: int = 1_000_000, seed: Seed = "validate") -> dict[str, Any]:
    """Judges a level by a release's criteria, like ``arcade validate``.

    Args:
        level: the level to judge.
        budget: the number of forward-model calls that the criteria share.
        seed: the text or integer from which the judges' randomness is derived.

    Returns:
        A report with ``passes``, ``judgements`` and ``witness``. Each judgement has ``criterion``, ``verdict`` and
        evidence. ``witness`` is the winning episode or None.

    Raises:
        KeyboardInterrupt: soon after Ctrl-C. Like all long calls of the package, this call is interrupted before it has
            finished.
    """
    at_least(1, budget=budget)
    return _object(_native.validate(level._native, budget=budget, seed=seed_text(seed)))


def generate_levels(
    game: Game | str | Path,
    *,
    method: Method = "search",
    count: int = 1,
    seed: Seed = "levels",
    difficulty: Difficulty | None = None,
    size: tuple[int, int] | None = None,
    min_solution: int | None = None,
    verified: bool = False,
    sprites: Mapping[str, int] | None = None,
) -> list[dict[str, Any]]:
    """Generates levels that resemble those of the game. The same arguments give the same levels.

    The methods ``search`` and ``evolutionary`` verify every level: it meets the criteria of a release, and a winning
    episode is its witness. The method ``constructive`` takes a few milliseconds per level and verifies no level, so
    some of its levels cannot be won. With ``verified=True``, it draws levels until they pass.

    Args:
        game: the game, with its levels as examples, or an argument for :func:`infinite_arcade.load`.
        method: ``constructive``, ``search`` or ``evolutionary``.
        count: the number of levels.
        seed: the text or integer from which the randomness is derived.
        difficulty: the difficulty label that each level must get, such as ``hard``.
        size: the number of columns and the number of rows.
        min_solution: the minimum number of ticks that the shortest win found must have. Implies ``verified``.
        verified: generate only verified levels.
        sprites: the exact numbers of sprites of some types.

    Returns:
        The accepted levels, each with ``text``, ``digest``, ``verified``, ``witness``, ``difficulty`` and ``report``.
        ``witness`` and ``report`` are None if ``verified`` is False. If fewer than ``count`` levels were accepted, a
        warning says so.

    Raises:
        ArcadeError: if the generator does not support the game, or no level was accepted.
        ValueError: if there is no such method, difficulty or sprite type, or a number is too small.
        KeyboardInterrupt: soon after Ctrl-C.
    """
    game = game_of(game)
    at_least(1, count=count, min_solution=min_solution)
    ranges = None
    if size is not None:
        columns, rows = pair(size)
        ranges = (columns, columns), (rows, rows)
    made = _native.generate_levels(
        game._native,
        [level._native for level in game.levels],
        method=method,
        count=count,
        seed=seed_text(seed),
        difficulty=difficulty,
        size=ranges,
        min_solution=min_solution,
        verified=verified,
        sprites=list((sprites or {}).items()),
    )
    levels: list[dict[str, Any]] = _object(made)["levels"]
    _warn_of_shortage(len(levels), count, "level")
    return levels


def generate_games(
    *,
    kinds: Iterable[str] = (),
    method: Method = "constructive",
    count: int = 1,
    levels: int = 5,
    seed: Seed = "games",
) -> list[dict[str, Any]]:
    """Generates games with levels, each of which a planner has won. A game takes a few minutes on one core.

    Args:
        kinds: the kinds of hand-written kernels from which games are drawn, such as ``shooter``. If empty, rules are
            invented.
        method: the method for inventions: ``constructive``, ``search`` or ``evolutionary``. Games of kernels require
            ``constructive``.
        count: the number of games.
        levels: the number of levels per game.
        seed: the text or integer from which all seeds are derived.

    Returns:
        The accepted games, each with ``id``, ``title``, ``source``, ``levels``, ``card`` and ``witnesses``. If fewer
        than ``count`` games were accepted, a warning says so. ``Game(made["source"], made["levels"], id=made["id"],
        title=made["title"])`` compiles a game.

    Raises:
        ArcadeError: if no game was accepted.
        ValueError: if there is no such method or kind, if a method other than ``constructive`` is given for games of
            kernels, or if a number is too small.
        KeyboardInterrupt: soon after Ctrl-C.
    """
    at_least(1, count=count, levels=levels)
    kinds = [kinds] if isinstance(kinds, str) else list(kinds)
    made: list[dict[str, Any]] = _object(
        _native.generate_games(kinds=kinds, method=method, count=count, levels=levels, seed=seed_text(seed))
    )["games"]
    _warn_of_shortage(len(made), count, "game")
    return made


def _warn_of_shortage(made: int, count: int, what: str) -> None:
    if made < count:
        warnings.warn(f"infinite_arcade: {made} of {count} {what}s were accepted", stacklevel=3)


def _object(text: str) -> dict[str, Any]:
    value: dict[str, Any] = json.loads(text)
    return value
