"""Mints and evaluates on a Ray cluster. The results are byte-identical to those from a single machine.

Work is divided as the command line divides it. A release is divided into shards that are merged, and an evaluation
into its games. A node returns the files that it wrote. If a node fails, its task is assigned to a different node. The
results do not depend on the assignment of tasks to nodes.

This package mints releases itself. For an evaluation, the same version of ``arcade`` must be in the search path of
every node, or its path must be passed.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import ray

from . import snapshots
from ._native import ArcadeError
from .games import Game, load

__all__ = ["ActionLog", "End", "evaluate", "mint", "replay"]

#: The contents of the files in a folder, by path.
Files = dict[str, bytes]

#: The minimum number of logs per task.
_LOGS_OF_A_TASK = 50


@dataclass(frozen=True)
class ActionLog:
    """The actions of an episode. ``game`` is an argument for :func:`infinite_arcade.load` that is valid on every
    node, and ``seed`` is the seed of the episode.
    """

    game: str
    level: int
    seed: str
    actions: tuple[str, ...]


@dataclass(frozen=True)
class End:
    """The final state of an episode."""

    hash: str
    score: float
    outcome: str


def replay(logs: Sequence[ActionLog]) -> list[End]:
    """Plays logs on the cluster. Returns their final states, in the order of the logs.

    Raises:
        FileNotFoundError: if a node does not have a game.
    """
    _start()
    parts = [list(logs[at : at + _LOGS_OF_A_TASK]) for at in range(0, len(logs), _LOGS_OF_A_TASK)]
    task = ray.remote(_replay)
    return [end for part in ray.get([task.remote(part) for part in parts]) for end in part]


def mint(recipe: str | Path, out: str | Path, *, shards: int, jobs: int | None = None) -> None:
    """Mints a release into the folder ``out``, which must not exist. Each of the ``shards`` shards is a task.

    Args:
        recipe: the name of a recipe embedded in the package, or a .toml file on this machine.
        out: the folder for the release.
        shards: the number of shards.
        jobs: the number of threads per task, by default one. One core is reserved for each thread.

    Raises:
        ArcadeError: if the recipe cannot be minted, on this machine or on a node.
        FileNotFoundError: if there is no such recipe.
    """
    _start()
    text = snapshots.recipe_text(recipe)
    task = ray.remote(num_cpus=jobs or 1, max_retries=-1)(_mint)
    pending = [task.remote(text, f"{number}/{shards}", jobs or 1) for number in range(1, shards + 1)]
    with tempfile.TemporaryDirectory() as folder:
        places = []
        for number, files in enumerate(ray.get(pending), 1):
            places.append(Path(folder) / f"shard{number}")
            _write(files, places[-1])
        snapshots.merge(places, out)


def evaluate(
    subject: str | Path,
    out: str | Path,
    *,
    games: Sequence[str],
    arguments: Sequence[str],
    arcade: str = "arcade",
    jobs: int | None = None,
) -> None:
    """Evaluates a player on games, each of which is a task. Writes the same results folder as ``arcade evaluate``,
    except for the times in the logs. Finally, the evaluation is resumed on this machine, which checks the folder by
    replaying every episode.

    Args:
        subject: the folder of a release that exists on every node, or ``corpus``.
        out: the results folder, which must not exist.
        games: the IDs of the games, in the order of the subject.
        arguments: further flags of ``arcade evaluate``, such as ``["--player", "mcts:100", "--runs", "5"]``.
        arcade: the path of the ``arcade`` program on every node.
        jobs: the number of concurrent episodes per task, by default one. One core is reserved for each episode.

    Raises:
        ArcadeError: if ``arcade`` fails, on this machine or on a node. The message is that of ``arcade``.
    """
    _start()
    task = ray.remote(num_cpus=jobs or 1, max_retries=-1)(_evaluate)
    pending = [task.remote(str(subject), game, list(arguments), arcade, jobs or 1) for game in games]
    whole: dict[str, Any] | None = None
    files: Files = {}
    for part in ray.get(pending):
        settings = json.loads(part.pop("evaluation.json"))
        if whole is None:
            whole = settings
        else:
            whole["games"] += settings["games"]
        files |= part
    if whole is None:
        raise ArcadeError("there is no game to evaluate on")
    files["evaluation.json"] = (json.dumps(whole, indent=2, ensure_ascii=False) + "\n").encode()
    folder = Path(out)
    if folder.exists() and any(folder.iterdir()):
        raise ArcadeError(f"{folder}: the folder is not empty")
    _write(files, folder)
    flags = ["--games", ",".join(games), *arguments, "--out", str(out), "--resume", "-q"]
    _run([arcade, "evaluate", str(subject), *flags])


def _start() -> None:
    if not ray.is_initialized():
        ray.init(log_to_driver=False)


def _replay(logs: list[ActionLog]) -> list[End]:
    games, ends = dict[str, Game](), []
    for log in logs:
        if log.game not in games:
            games[log.game] = load(log.game)
        [level] = [level for level in games[log.game].levels if level.number == log.level]
        state = level.start(log.seed)
        state.play(log.actions)
        ends.append(End(state.state_hash(), state.score, state.outcome))
    return ends


def _mint(text: str, shard: str, jobs: int) -> Files:
    with tempfile.TemporaryDirectory() as folder:
        recipe, out = Path(folder) / "recipe.toml", Path(folder) / "shard"
        recipe.write_text(text, "utf-8")
        snapshots.mint(recipe, out, shard=shard, jobs=jobs)
        return _read(out)


def _evaluate(subject: str, game: str, arguments: list[str], arcade: str, jobs: int) -> Files:
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "results"
        flags = ["--games", game, *arguments, "--jobs", str(jobs), "--out", str(out), "-q"]
        _run([arcade, "evaluate", subject, *flags])
        return _read(out)


def _run(command: list[str]) -> None:
    if shutil.which(command[0]) is None:
        raise ArcadeError(f"`{command[0]}` is not on the path; install the command-line program, or pass its path as `arcade=`")
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise ArcadeError(f"`{' '.join(command)}` failed with status {done.returncode}: {done.stderr.strip()}")


def _read(folder: Path) -> Files:
    files = (path for path in sorted(folder.rglob("*")) if path.is_file() and path.name != ".lock")
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def _write(files: Files, folder: Path) -> None:
    for name, data in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
