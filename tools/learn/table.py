"""Prints the table of win rates. The results folders of `all.sh` are compared with the rows of the seed table, in
percent of 25 episodes per game.

Example: python tools/learn/table.py checkpoints/results
"""

from __future__ import annotations

import sys
from pathlib import Path

from infinite_arcade.doors import read_logs

GAMES = ("aliens", "boulderdash", "escape", "realsokoban", "sokoban", "zelda")

#: Win rates that were published (docs/reference/spec/04-agents.md, 10), and win rates measured with the reference's
#: planners at 1000 calls (10.2).
KNOWN = {
    "DQN, paper": (56, 0, 16, 0, 0, 0),
    "PPO, paper": (64, 0, 12, 0, 12, 8),
    "MCTS, reference, 1000 calls": (100, 20, 0, 0, 28, 16),
    "OLETS, reference, 1000 calls": (100, 36, 52, 0, 36, 48),
}


def main() -> None:
    folder = Path(sys.argv[1])
    print("| player | " + " | ".join(GAMES) + " |\n|---" * 1 + "|---" * len(GAMES) + "|")
    rows = {name: [f"{value}" for value in values] for name, values in KNOWN.items()}
    for player in sorted(path for path in folder.iterdir() if path.is_dir()):
        rows[f"{player.name}, here"] = []
        for game in GAMES:
            logs = read_logs(player / game) if (player / game).is_dir() else []
            won = sum(log.outcome == "won" for log in logs)
            rows[f"{player.name}, here"].append(f"{100 * won / len(logs):.0f}" if logs else "–")
    for name, values in rows.items():
        print(f"| {name} | " + " | ".join(values) + " |")


if __name__ == "__main__":
    main()
