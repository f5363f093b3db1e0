"""Compares the steps per second of a vector environment with the native batch, game by game, in one run.

All variants play level 0 with uniform actions on one thread. Rates are steps per second of CPU time, measured once
episodes have diverged. A board early in an episode may cost a third of a later board.

- batch: `cargo xtask bench --batch`, 4,096 states that are stepped one tick at a time, without observations;
- loop: the same states in the process of the environments, stepped in one loop, without observations, rewards, flags
  or limits;
- environments: 4,096 boards of planes, rewards and flags, written into one array, which is returned directly or as a
  copy;
- in C: a box-pushing puzzle that is a separate program, `boxes.c`, with planes, rewards and flags.

Example: python tools/bench/steps.py --games corpora hailglass heath-fire
"""

from __future__ import annotations

import argparse
import csv
import io
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import gymnasium
import numpy as np

import infinite_arcade as ia
import infinite_arcade.gymnasium

ROOT = Path(__file__).parents[2]
COUNT = 4096
#: The number of ticks before the measurement, which is the same as in `cargo xtask bench --batch`.
APART = 512


def rates(game: ia.Game, turns: int) -> list[float]:
    """Returns the rates of the loop, of environments without copies, and of environments with copies."""
    make = lambda copy: gymnasium.make_vec(
        infinite_arcade.gymnasium.ENV_ID,
        num_envs=COUNT,
        game=game,
        level=0,
        threads=1,
        copy=copy,
        autoreset_mode=gymnasium.vector.AutoresetMode.SAME_STEP,
    )
    shown, copied, loop = make(False), make(True), make(False)
    draws = np.random.default_rng(0)
    actions = [draws.integers(shown.single_action_space.n, size=COUNT) for _ in range(16)]
    flat = np.concatenate(actions)

    def play(envs: gymnasium.vector.VectorEnv) -> None:
        for chosen in actions:
            envs.step(chosen)

    players = [lambda: loop._lanes.native.step_blindly(flat, len(actions)), lambda: play(shown), lambda: play(copied)]
    spent = [0.0] * len(players)
    for envs in (shown, copied, loop):
        envs.reset(seed=0)
    for _ in range(APART // len(actions)):
        for player in players:
            player()
    for turn in range(turns + 1):
        for at, player in enumerate(players):
            started = time.process_time()
            player()
            # The first turn lets the buffers grow.
            if turn:
                spent[at] += time.process_time() - started
    return [turns * len(flat) / seconds for seconds in spent]


def native(games: Path, name: str) -> float:
    """Returns the ticks per second of the native batch."""
    command = ["cargo", "xtask", "bench", "--games", str(games), "--game", name, "--batch", "--seconds", "0.2"]
    said = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    [row] = csv.DictReader(io.StringIO("\n".join(said.splitlines()[:2])))
    return float(row["batch_ticks_per_s"])


def in_c(turns: int) -> float:
    """Returns the rate of `boxes.c`."""
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "boxes"
        source = Path(__file__).with_name("boxes.c")
        subprocess.run(["cc", "-O3", "-march=native", str(source), "-o", str(program)], check=True)
        command = [str(program), str(COUNT), "320"]
        said = [subprocess.run(command, capture_output=True, text=True, check=True).stdout for _ in range(turns)]
    return max(map(float, said))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--games", type=Path, default=ROOT / "corpora", help="folder of game folders")
    parser.add_argument("--turns", type=int, default=40, help="number of turns, of 16 steps each")
    parser.add_argument("names", nargs="*", help="the games [default: all games in the folder]")
    arguments = parser.parse_args()
    names = arguments.names or sorted(path.name for path in arguments.games.iterdir() if path.is_dir())
    print("| game | batch | loop | environments | of batch | of loop | with copies | of batch |")
    print("|---|---|---|---|---|---|---|---|")
    for name in names:
        game = ia.load(arguments.games / name, as_reference=True)
        loop, shown, copied = rates(game, arguments.turns)
        batch = native(arguments.games, name)
        million = [f"{rate / 1e6:.2f} M/s" for rate in (batch, loop, shown, copied)]
        shares = [f"{share:.2f}" for share in (shown / batch, shown / loop, copied / batch)]
        print(f"| {name} | {' | '.join(million[:3])} | {' | '.join(shares[:2])} | {million[3]} | {shares[2]} |", flush=True)
    if shutil.which("cc"):
        print(f"\nboxes in C: {in_c(arguments.turns) / 1e6:.0f} M/s")


if __name__ == "__main__":
    main()
