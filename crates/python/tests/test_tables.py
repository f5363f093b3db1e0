"""Tests of the tables. Runs only if PyArrow is installed."""

from __future__ import annotations

import subprocess
from pathlib import Path
from types import SimpleNamespace

import pytest

pa = pytest.importorskip("pyarrow", reason="PyArrow is not installed: pip install 'infinite-arcade[tables]'")

import infinite_arcade as ia
from infinite_arcade import tables


@pytest.fixture(scope="module")
def results(arcade: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("results") / "mcts"
    command = [arcade, "evaluate", "hailglass", "--player", "mcts:50", "--levels", "1,3", "--runs", "2", "--max-steps", "20"]
    subprocess.run([*command, "--out", str(out), "-q"], check=True, stdout=subprocess.DEVNULL)
    return out


def test_episodes_and_steps(results: Path) -> None:
    table = tables.episodes(results)
    assert table.num_rows == 4 and set(table["level"].to_pylist()) == {1, 3}
    assert table["player"].to_pylist() == ["mcts:50"] * 4
    played = tables.steps(results)
    assert played.num_rows == sum(table["steps"].to_pylist())
    assert played.schema.field("score").type == pa.float64()


def test_frames_share_the_buffers(results: Path) -> None:
    table = tables.steps(results)
    pytest.importorskip("polars")
    frame = tables.to_polars(table)
    assert frame.shape == (table.num_rows, table.num_columns)
    one = table["score"].chunk(0).buffers()[1].address
    assert frame["score"].to_arrow().buffers()[1].address == one
    pytest.importorskip("pandas")
    other = tables.to_pandas(table)
    assert other["score"].array.__arrow_array__().chunk(0).buffers()[1].address == one


def test_releases(tiny: Path) -> None:
    release = ia.open_snapshot(tiny)
    games, levels = tables.games(release), tables.levels(release)
    assert games.num_rows == len(list(release.games()))
    assert levels.num_rows == sum(games["levels"].to_pylist())
    assert all(levels["text"].to_pylist())
    cards = [level for game in release.games() for level in game.card["levels"]]
    assert levels["difficulty_asked"].to_pylist() == [card["difficulty"] for card in cards]
    assert levels["difficulty"].to_pylist() == [None] * levels.num_rows, "the recipe does not measure it"


def test_measured_difficulty_is_shown(tiny: Path, tmp_path: Path) -> None:
    [game, *_] = ia.open_snapshot(tiny).games()
    for level in game.card["levels"]:
        level["ladder"] = {"difficulty": "hard"}
    release = SimpleNamespace(games=lambda: [game])
    assert set(tables.levels(release)["difficulty"].to_pylist()) == {"hard"}
