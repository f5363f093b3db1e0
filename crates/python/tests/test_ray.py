"""Tests with a Ray cluster of two local nodes, one of which is killed. Runs only if Ray is installed."""

from __future__ import annotations

import json
import re
import subprocess
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("ray", reason="Ray is not installed: pip install 'infinite-arcade[ray]'")

import ray
from ray.cluster_utils import Cluster

import infinite_arcade as ia
from infinite_arcade import ray as cluster


@pytest.fixture
def two_nodes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[Any, Any]]:
    # Workers import from their working folder first, and the sources beside these tests may have no extension.
    monkeypatch.chdir(tmp_path)
    nodes = Cluster(initialize_head=True, head_node_args={"num_cpus": 0, "object_store_memory": 10**8})
    doomed = nodes.add_node(num_cpus=1, object_store_memory=10**8)
    nodes.add_node(num_cpus=1, object_store_memory=10**8)
    ray.init(address=nodes.address, log_to_driver=False)
    yield nodes, doomed
    ray.shutdown()
    nodes.shutdown()


def files_of(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def test_a_mint_survives_a_node(two_nodes: tuple[Any, Any], tiny: Path, tmp_path: Path) -> None:
    nodes, doomed = two_nodes
    killed = threading.Event()

    def kill() -> None:
        time.sleep(2)
        nodes.remove_node(doomed, allow_graceful=False)
        killed.set()

    thread = threading.Thread(target=kill)
    thread.start()
    cluster.mint("tiny", tmp_path / "cluster", shards=6)
    assert killed.is_set(), "the mint was over before the node was killed"
    thread.join()
    assert files_of(tmp_path / "cluster") == files_of(tiny)
    assert ia.verify(tmp_path / "cluster")["problems"] == []


def test_an_evaluation_is_that_of_one_machine(two_nodes: tuple[Any, Any], arcade: Path, tmp_path: Path) -> None:
    games = ["great-yawn", "hailglass", "heath-fire"]
    arguments = ["--player", "mcts:20", "--max-steps", "10", "--runs", "2"]
    cluster.evaluate("corpus", tmp_path / "cluster", games=games, arguments=arguments, arcade=str(arcade))
    command = [arcade, "evaluate", "corpus", "--games", ",".join(games), *arguments, "--out", str(tmp_path / "alone"), "-q"]
    subprocess.run(command, check=True)

    def timeless(folder: Path) -> dict[str, bytes]:
        files = files_of(folder)
        files.pop(".lock", None)
        return {name: re.sub(rb'"took_ms":[0-9.e-]+', b"", data) for name, data in files.items()}

    one, two = timeless(tmp_path / "cluster"), timeless(tmp_path / "alone")
    assert one == two
    assert json.loads(one["evaluation.json"])["runs"] == 2


def test_logs_are_replayed_alike(two_nodes: tuple[Any, Any]) -> None:
    game = ia.load("heath-fire")
    logs, ends = [], []
    for at in range(120):
        actions = tuple(game.actions[(at + tick) % len(game.actions)] for tick in range(15))
        logs.append(cluster.ActionLog("heath-fire", at % 5, ia.seed_from_text(str(at)), actions))
        state = game.levels[at % 5].start(logs[-1].seed)
        state.play(actions)
        ends.append(cluster.End(state.state_hash(), state.score, state.outcome))
    assert cluster.replay(logs) == ends
