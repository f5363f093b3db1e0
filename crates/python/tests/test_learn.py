"""Tests of the training scripts. Each algorithm is trained briefly, and its checkpoint plays through ``cmd:``. Runs
only if JAX is installed.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

for library in ("jax", "optax"):
    pytest.importorskip(library, reason=f"{library} is not installed: pip install jax optax")

from infinite_arcade.doors import read_logs

from conftest import NUT

LEARN = Path(__file__).parents[3] / "tools/learn"


@pytest.mark.parametrize(("algorithm", "steps"), [("ppo", 40_000), ("dqn", 30_000)])
def test_a_short_training_learns_to_walk_to_the_nut(algorithm: str, steps: int, arcade: Path, tmp_path: Path) -> None:
    (tmp_path / "game.vgdl").write_text(NUT)
    (tmp_path / "lvl0.txt").write_text("S   n")
    (tmp_path / "lvl1.txt").write_text("n   S")
    out = tmp_path / "out"
    command = [sys.executable, str(LEARN / "train.py"), algorithm, str(tmp_path), "--steps", str(steps), "--out", str(out)]
    subprocess.run(command, check=True, capture_output=True)
    [checkpoint] = out.glob("*.npz")
    player = f"cmd:{sys.executable} {LEARN / 'player.py'} {checkpoint}"
    results = tmp_path / "results"
    subprocess.run([arcade, "evaluate", str(tmp_path), "--player", player, "--out", str(results), "-q"], check=True, capture_output=True)
    assert [log.outcome for log in read_logs(results)] == ["won", "won"]
