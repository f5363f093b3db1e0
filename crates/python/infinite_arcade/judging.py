"""Judges levels, and generates levels and games."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import Any

from . import _native
from .games import Game, Level

__all__ = ["generate_games", "generate_levels", "validate"]


def validate(level: Level, *, budget: int = 1_000_000, seed: str = "validate") -> dict[str, Any]:
    """Judges a level by a release's criteria, like ``arcade validate``.

    Args:
        level: the level to judge.
        budget: the number of forward-model calls that the criteria share.
        seed: the text from which the judges' randomness is derived.

    Returns:
        A report with ``passes``, ``judgements`` and ``witness``. Each judgement has ``criterion``, ``verdict`` and
        evidence. ``witness`` is the winning episode or None.
    """
    return _object(_native.validate(level._native, budget=budget, seed=seed))


def generate_levels(
    game: Game,
    *,
    method: str = "search",
    count: int = 1,
    seed: str = "levels",
    difficulty: str | None = None,
    size: tuple[int, int] | None = None,
    min_solution: int | None = None,
    sprites: Mapping[str, int] | None = None,
) -> list[dict[str, Any]]:
    """Generates levels that resemble those of the game. The same arguments give the same levels.

    Args:
        game: the game, with its levels as examples.
        method: ``constructive``, ``search`` or ``evolutionary``.
        count: the number of levels.
        seed: the text from which the randomness is derived.
        difficulty: the difficulty label that each level must get, such as ``hard``.
        size: the number of columns and the number of rows.
        min_solution: the minimum number of ticks that the shortest win found must have.
        sprites: the exact numbers of sprites of some types.

    Returns:
        The accepted levels, each with ``text``, ``digest``, ``witness``, ``difficulty`` and ``report``.

    Raises:
        ArcadeError: if the generator does not support the game, or no level was accepted.
        ValueError: if there is no such method, difficulty or sprite type.
    """
    ranges = None if size is None else ((size[0], size[0]), (size[1], size[1]))
    made = _native.generate_levels(
        game._native,
        [level._native for level in game.levels],
        method=method,
        count=count,
        seed=seed,
        difficulty=difficulty,
        size=ranges,
        min_solution=min_solution,
        sprites=list((sprites or {}).items()),
    )
    levels: list[dict[str, Any]] = _object(made)["levels"]
    return levels


def generate_games(
    *,
    kinds: Iterable[str] = (),
    method: str = "constructive",
    count: int = 1,
    levels: int = 5,
    seed: str = "games",
) -> list[dict[str, Any]]:
    """Generates games with levels, each of which a planner has won. A game takes some minutes on one core.

    Args:
        kinds: the kinds of hand-written kernels from which games are drawn, such as ``shooter``. If empty, rules are
            invented.
        method: the method for inventions: ``constructive``, ``search`` or ``evolutionary``. Games of kernels require
            ``constructive``.
        count: the number of games.
        levels: the number of levels per game.
        seed: the text from which all seeds are derived.

    Returns:
        The accepted games, each with ``source``, ``levels``, ``card`` and ``witnesses``.

    Raises:
        ArcadeError: if no game was accepted.
        ValueError: if there is no such method or kind, or if a different method than ``constructive`` is given for
            games of kernels.
    """
    made: list[dict[str, Any]] = _object(
        _native.generate_games(kinds=list(kinds), method=method, count=count, levels=levels, seed=seed)
    )["games"]
    return made


def _object(text: str) -> dict[str, Any]:
    value: dict[str, Any] = json.loads(text)
    return value
