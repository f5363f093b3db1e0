"""Steps per second of a vector environment beside the native batch, game by game, in one run.

Both play level 0 with uniform actions on one thread. The native rate is that of `cargo xtask bench --batch`, 4,096 states that are
stepped one tick at a time, without observations; the environment also writes 4,096 boards of planes and their rewards and flags.

Example: python python/bench/steps.py --games corpora hailglass heath-fire
"""

from __future__ import annotations

import argparse
import csv
import io
import subprocess
import time
from pathlib import Path

import gymnasium
import numpy as np

import infinite_arcade as ia
import infinite_arcade.gymnasium

ROOT = Path(__file__).parents[2]
COUNT = 4096


def rate(game: ia.Game, copy: bool, seconds: float) -> float:
    """Steps per second of an environment, the best of three runs."""
    envs = gymnasium.make_vec(
        infinite_arcade.gymnasium.ENV_ID,
        num_envs=COUNT,
        game=game,
        level=0,
        threads=1,
        copy=copy,
        autoreset_mode=gymnasium.vector.AutoresetMode.SAME_STEP,
    )
    envs.reset(seed=0)
    draws = np.random.default_rng(0)
    actions = [draws.integers(envs.single_action_space.n, size=COUNT) for _ in range(16)]
    best = 0.0
    for _ in range(3):
        started, rounds = time.perf_counter(), 0
        while time.perf_counter() - started < seconds:
            for chosen in actions:
                envs.step(chosen)
            rounds += len(actions)
        best = max(best, rounds * COUNT / (time.perf_counter() - started))
    return best


def native(games: Path, name: str) -> float:
    """Ticks per second of the native batch."""
    command = ["cargo", "xtask", "bench", "--games", str(games), "--game", name, "--batch", "--seconds", "0.2"]
    said = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    [row] = csv.DictReader(io.StringIO("\n".join(said.splitlines()[:2])))
    return float(row["batch_ticks_per_s"])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--games", type=Path, default=ROOT / "corpora", help="folder of game folders")
    parser.add_argument("--seconds", type=float, default=1.0, help="seconds of a run")
    parser.add_argument("names", nargs="*", help="the games; all of the folder if none is named")
    arguments = parser.parse_args()
    names = arguments.names or sorted(path.name for path in arguments.games.iterdir() if path.is_dir())
    print("| game | native batch | environments | ratio | with copies | ratio |\n|---|---|---|---|---|---|")
    for name in names:
        game = ia.load(arguments.games / name, as_reference=True)
        before = native(arguments.games, name)
        shown, copied = (rate(game, copy, arguments.seconds) for copy in (False, True))
        base = max(before, native(arguments.games, name))
        print(
            f"| {name} | {base / 1e6:.2f} M/s | {shown / 1e6:.2f} M/s | {shown / base:.2f} "
            f"| {copied / 1e6:.2f} M/s | {copied / base:.2f} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
