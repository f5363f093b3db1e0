"""Tests that every interface reproduces the same logs. ``python -m infinite_arcade.doors`` compares a thousand logs."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

from infinite_arcade.doors import compare


def test_one_score_through_every_door(arcade: Path, tmp_path: Path) -> None:
    counts = compare(arcade, ["hailglass", "heath-fire"], "sample", max_steps=12, folder=tmp_path)
    optional = [name for name in ("mcp", "openenv") if find_spec(name)]
    assert counts == dict.fromkeys(["command line", "gymnasium", "vector", "inspect", "cmd", *optional], 10)
