"""Results, cards and releases as Arrow tables, and as pandas or Polars data frames over the same buffers.

>>> table = episodes(["results/mcts", "results/mini"])       # a pyarrow.Table
>>> frame = to_polars(table)                                 # no copy

The extra ``tables`` installs the libraries. The tables themselves need only PyArrow.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import pyarrow as pa

from . import _native
from .games import Game
from .snapshots import Release

__all__ = ["episodes", "games", "levels", "steps", "to_pandas", "to_polars"]

Table = Any


def episodes(results: str | Path | Iterable[str | Path]) -> Table:
    """Returns a table of the episodes in results folders. Each episode is replayed. Unfinished episodes are omitted.

    The columns are ``results``, ``player``, ``game``, ``level``, ``run``, ``track``, ``status``, ``outcome``,
    ``won``, ``score``, ``steps``, ``max_steps``, ``optimal_ticks``, ``meaningful`` (a ratio), ``input_tokens`` and
    ``output_tokens``.

    Raises:
        LogError: if a log is damaged, or differs from its replay.
    """
    rows = []
    for folder in [results] if isinstance(results, (str, Path)) else results:
        settings, subjects = _settings(Path(folder)), dict[str, Game]()
        for path in sorted((Path(folder) / "episodes").glob("*.jsonl")):
            log = _native.read_log(path, False)
            if not log or '"event":"end"' not in log.splitlines()[-1]:
                continue
            start = json.loads(log.splitlines()[0])
            game = _subject(Path(folder), settings, start["game"], subjects)
            found = json.loads(_native.metrics_of_log(game._native, game.id, game._level_texts(), log))
            spending = found["spending"]
            rows.append(
                {
                    "results": str(folder),
                    "player": settings["entrant"]["name"],
                    "game": found["game"],
                    "level": found["level"],
                    "run": found["run"],
                    "track": found.get("track"),
                    "status": found["status"],
                    "outcome": found["outcome"] if isinstance(found["outcome"], str) else "stopped",
                    "won": found["outcome"] == "won",
                    "score": found["score"],
                    "steps": found["steps"],
                    "max_steps": found["max_steps"],
                    "optimal_ticks": found["optimal_ticks"],
                    "meaningful": found["meaningful"],
                    "input_tokens": spending.get("input_tokens"),
                    "output_tokens": spending.get("output_tokens"),
                }
            )
    columns = {"optimal_ticks": pa.int64(), "track": pa.string(), "input_tokens": pa.int64(), "output_tokens": pa.int64()}
    return _table(rows, columns)


def steps(results: str | Path) -> Table:
    """Returns a table of the steps in a results folder.

    The columns are ``game``, ``level``, ``run``, ``step``, ``action``, ``validity``, ``score``, ``hash``,
    ``outcome``, ``column`` and ``row``.

    Raises:
        LogError: if a log is damaged.
    """
    rows = []
    for path in sorted((Path(results) / "episodes").glob("*.jsonl")):
        events = [json.loads(line) for line in _native.read_log(path, False).splitlines()]
        for event in events[1:]:
            if event["event"] == "step":
                column, row = event["avatar"] or (None, None)
                outcome = event["outcome"] if isinstance(event["outcome"], str) else "stopped"
                own = {name: events[0][name] for name in ("game", "level", "run")}
                told = {name: event[name] for name in ("step", "action", "validity", "score", "hash")}
                rows.append({**own, **told, "outcome": outcome, "column": column, "row": row})
    return _table(rows, {"column": pa.int64(), "row": pa.int64()})


def games(release: Release) -> Table:
    """Returns a table of the games of a release, based on their cards. The columns are ``id``, ``title``, ``kind``,
    ``goal``, ``digest``, ``real_time`` and ``levels``.
    """
    names = ("id", "title", "kind", "goal", "digest", "real_time")
    rows = [
        {**{name: found.card.get(name) for name in names}, "id": found.id, "levels": len(found.card["levels"])}
        for found in release.games()
    ]
    return _table(rows, {})


def levels(release: Release) -> Table:
    """Returns a table of the levels of a release, based on their cards. The columns are ``game``, ``level``,
    ``digest``, ``columns``, ``rows``, ``difficulty``, ``difficulty_asked``, ``optimal_ticks`` and ``text``.

    ``difficulty`` is the label that the reference players measured, such as ``hard``, or None if the recipe does not
    measure it. ``difficulty_asked`` is the difficulty for which the generator made the level, from 0 to 1.
    """
    rows = []
    for found in release.games():
        game = found.compile()
        for level, card in zip(game.levels, found.card["levels"], strict=True):
            columns, height = level.size
            ladder = card.get("ladder")
            rows.append(
                {
                    "game": found.id,
                    "level": level.number,
                    "digest": level.digest,
                    "columns": columns,
                    "rows": height,
                    "difficulty": ladder["difficulty"] if ladder else None,
                    "difficulty_asked": card.get("difficulty"),
                    "optimal_ticks": level.optimal_ticks,
                    "text": level.text,
                }
            )
    return _table(rows, {"optimal_ticks": pa.int64(), "difficulty": pa.string(), "difficulty_asked": pa.float64()})


def to_pandas(table: Table) -> Any:
    """Returns a pandas data frame that uses the Arrow columns directly, without a copy."""
    import pandas

    return table.to_pandas(types_mapper=pandas.ArrowDtype)


def to_polars(table: Table) -> Any:
    """Returns a Polars data frame over the table's buffers. Nothing is copied if Polars uses the same layout."""
    import polars

    return polars.from_arrow(table)


def _table(rows: Sequence[dict[str, Any]], columns: dict[str, Any]) -> Table:
    """Converts rows to a table. ``columns`` holds the types of the columns that can be empty."""
    table = pa.Table.from_pylist(list(rows))
    for name, kind in columns.items():
        if name in table.column_names:
            at = table.column_names.index(name)
            table = table.set_column(at, name, table.column(name).cast(kind))
    return table


def _settings(folder: Path) -> dict[str, Any]:
    settings: dict[str, Any] = json.loads((folder / "evaluation.json").read_text("utf-8"))
    return settings


def _subject(folder: Path, settings: dict[str, Any], id: str, known: dict[str, Game]) -> Game:
    if id not in known:
        [entry] = [entry for entry in settings["games"] if entry["id"] == id]
        place = folder / "games" / id
        reference = bool(entry["facts"].get("as_reference"))
        game = Game((place / "game.vgdl").read_text("utf-8"), id=id, as_reference=reference)
        for level in entry["levels"]:
            text = (place / f"lvl{level['number']}.txt").read_text("utf-8")
            added = game.level(text, name=f"lvl{level['number']}.txt", optimal_ticks=level["optimal_ticks"])
            added.number = level["number"]
            game.levels.append(added)
        known[id] = game
    return known[id]
