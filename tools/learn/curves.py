"""Draws the learning curves of `all.sh` as an image, with one column per game. The curves show wins and scores of the
last 200 episodes by the number of steps.

Example: python tools/learn/curves.py checkpoints tools/learn/curves.svg

Requires matplotlib.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("svg")
from matplotlib import pyplot

from table import GAMES

#: The algorithms, with colours that colour-blind readers can distinguish.
COLOURS = {"dqn": "#0072b2", "ppo": "#d55e00"}


def main() -> None:
    if len(sys.argv) != 3 or not any(Path(sys.argv[1]).glob("*-*.csv")):
        raise SystemExit("usage: curves.py FOLDER OUT.svg; FOLDER contains the GAME-ALGORITHM.csv files")
    folder, out = Path(sys.argv[1]), Path(sys.argv[2])
    # The same curves give the same file.
    pyplot.rcParams |= {"svg.hashsalt": "curves", "svg.fonttype": "none", "font.size": 8, "axes.spines.top": False, "axes.spines.right": False}
    figure, axes = pyplot.subplots(2, len(GAMES), figsize=(11, 3.6), sharex=True, layout="constrained")
    for column, game in enumerate(GAMES):
        wins, scores = axes[0][column], axes[1][column]
        wins.set_title(game)
        wins.set_ylim(-3, 103)
        for algorithm, colour in COLOURS.items():
            path = folder / f"{game}-{algorithm}.csv"
            if not path.is_file():
                continue
            with path.open(newline="") as file:
                rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
            steps = [row["steps"] / 1e6 for row in rows]
            wins.plot(steps, [100 * row["wins"] for row in rows], color=colour, label=algorithm.upper())
            scores.plot(steps, [row["score"] for row in rows], color=colour)
    axes[0][0].set_ylabel("won, %")
    axes[1][0].set_ylabel("score")
    axes[0][0].legend(frameon=False)
    figure.supxlabel("million steps")
    figure.savefig(out, metadata={"Date": None})


if __name__ == "__main__":
    main()
