"""Checks of arguments. Each error message names the argument, the given value and the expected values."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from numbers import Integral
from typing import Any

#: A seed: a text, or an integer, which stands for its decimal digits. A text of 64 hexadecimal digits is the seed
#: itself. Any other text is hashed.
Seed = str | int

#: Numbers, as a list or as comma-separated text; None for all.
Numbers = int | str | list[int] | list[str] | None


def seed_text(seed: Seed) -> str:
    """Returns the text of a seed.

    Raises:
        TypeError: if ``seed`` is neither a text nor an integer.
    """
    if isinstance(seed, str):
        return seed
    if isinstance(seed, Integral) and not isinstance(seed, bool):
        return str(int(seed))
    raise TypeError(f"`seed` must be a text or an integer, not {type(seed).__name__}")


def at_least(least: int, **numbers: Any) -> None:
    """Checks that every number is an integer, and at least ``least``. A number may also be None.

    Raises:
        TypeError: if a number is not an integer.
        ValueError: if a number is too small.
    """
    for name, number in numbers.items():
        if number is None:
            continue
        if not isinstance(number, Integral) or isinstance(number, bool):
            raise TypeError(f"`{name}` must be an integer, not {type(number).__name__}")
        if number < least:
            raise ValueError(f"`{name}` must be at least {least}, not {number}")


def pair(size: tuple[int, int]) -> tuple[int, int]:
    """Returns a board's number of columns and number of rows.

    Raises:
        TypeError: if ``size`` is not a pair of integers.
        ValueError: if a number is less than 1.
    """
    try:
        columns, rows = size
    except TypeError:
        raise TypeError(f"`size` must be a pair of columns and rows, not {size!r}") from None
    at_least(1, columns=columns, rows=rows)
    return columns, rows


def did_you_mean(name: str, known: Iterable[str], kind: str = "") -> str:
    """Returns a suggestion of the nearest known name for the end of a message, or an empty text if no name is near."""
    near = get_close_matches(name, list(known), n=1)
    return f"; did you mean {kind}`{near[0]}`?" if near else ""


def check_games(wanted: Sequence[str] | None, known: Iterable[str], source: str) -> None:
    """Checks that every wanted game exists.

    Raises:
        ValueError: if a game does not exist. The message contains the first unknown name and the nearest known name.
    """
    known = list(known)
    for name in wanted or ():
        if name not in known:
            hint = did_you_mean(name, known) or f"; the games are {', '.join(known)}"
            raise ValueError(f"there is no game `{name}` in {source}{hint}")


def level_numbers(numbers: Numbers) -> list[int] | None:
    """Returns the numbers as a list, or None for all.

    Raises:
        ValueError: if a part of the text is not a number.
    """
    if numbers is None:
        return None
    parts = numbers.split(",") if isinstance(numbers, str) else numbers if isinstance(numbers, list) else [numbers]
    try:
        return [int(part) for part in parts]
    except ValueError:
        raise ValueError(f"`levels` must be numbers, such as 0,1, not {numbers!r}") from None


def check_levels(wanted: Sequence[int] | None, known: Iterable[int]) -> None:
    """Checks that every wanted level exists.

    Raises:
        ValueError: if a level does not exist. The message contains the first unknown level and the numbers of all
            levels.
    """
    numbers = sorted(set(known))
    for number in wanted or ():
        if number not in numbers:
            raise ValueError(f"there is no level {number}; the levels are {', '.join(map(str, numbers))}")
