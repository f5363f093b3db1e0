"""Plays a checkpoint in `arcade evaluate`: --player "cmd:python tools/learn/player.py CHECKPOINT"."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np

from network import greedy, load


def main() -> None:
    shape, parameters = load(Path(sys.argv[1]))
    planes = {name: at for at, name in enumerate(shape.planes)}
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] != "turn":
            continue
        board = np.zeros((len(planes), shape.rows, shape.columns), np.uint8)
        for sprite in message["sprites"]:
            plane = planes.get(sprite["name"])
            for column, row in sprite["cells"]:
                if plane is not None and row < shape.rows and column < shape.columns:
                    board[plane, row, column] = 1
        if message.get("past"):
            continue
        action = greedy(shape, parameters, board, message["actions"])
        print(json.dumps({"turn": message["turn"], "action": action}), flush=True)


if __name__ == "__main__":
    main()
