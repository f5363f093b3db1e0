#!/usr/bin/env python3
"""Packs the rules, boards and filmstrips of games from three sources for blind reviewers. The games are shuffled and numbered.

    tools/scripts/blind-review.py --arcade target/release/arcade --generated new-games --public gvgai/games \
        --corpus corpora --numbers 12 6 6 --seed autumn --out review

Writes review/01 to review/24, each with rules.txt, level-0.png, level-2.png, level-4.png and two filmstrips of wins by the same
planners. Also writes review-key.json next to the folder, which reviewers must not see. Requires Pillow.

With --pairs, review-pairs.txt pairs each generated game with a corpus game, so that reviewers can say which of the two a person made.
"""

import argparse
import json
import pathlib
import random
import tempfile

from filmstrip import frames, run, sheet

FRAMES = 8
# The players of a filmstrip, in the order in which they try to win.
PLANNERS = ["olets:300"] * 3 + ["olets:3000"] * 2 + ["systematic:300000"]
TICKS = 160


def game_file(folder):
    return next((path for name in ("game.vgdl", "game.txt") if (path := folder / name).exists()), None)


def source(arcade, folder):
    """Returns the games of a folder that can be loaded and have five levels."""
    games = [game for game in sorted(folder.iterdir()) if game_file(game) and has_levels(game)]
    return [game for game in games if run(arcade, "describe", str(game)).returncode == 0]


def level(game, number):
    return str(game / f"lvl{number}.txt")


def rules(arcade, game):
    text = run(arcade, "describe", str(game)).stdout
    lines = text.splitlines()
    # The first line contains the name of the game or of its file.
    return "\n".join(line for line in lines[1:] if "canary" not in line.lower()).strip() + "\n"


def filmstrip(arcade, game, number, out, seed):
    """Draws eight frames of the first win side by side, or of the first episode if no player wins. Returns whether
    the episode is a win.
    """
    with tempfile.TemporaryDirectory() as scratch:
        best = None
        for attempt, planner in enumerate(PLANNERS):
            gif = pathlib.Path(scratch) / f"{attempt}.gif"
            told = run(arcade, "--json", "render", str(game), level(game, number), "--planner", planner, "--seed",
                       f"{seed}-{attempt}", "--max-ticks", str(TICKS), "--scale", "20", "-o", str(gif))
            if gif.exists():
                won = json.loads(told.stdout)["outcome"] == "won"
                if best is None or won and not best[1]:
                    best = (gif, won)
                if won:
                    break
        if best is None:
            return False
        sheet(frames(best[0], FRAMES), 4).save(out)
        return best[1]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--arcade", required=True)
    parser.add_argument("--generated", type=pathlib.Path, required=True)
    parser.add_argument("--public", type=pathlib.Path, required=True)
    parser.add_argument("--corpus", type=pathlib.Path, required=True)
    parser.add_argument("--numbers", type=int, nargs=3, default=[12, 6, 6])
    parser.add_argument("--seed", default="review")
    parser.add_argument("--pairs", action="store_true", help="pair each generated game with a corpus game")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    args = parser.parse_args()
    draw = random.Random(args.seed)
    games = []
    for group, folder, number in zip(("generated", "public", "corpus"),
                                     (args.generated, args.public, args.corpus), args.numbers):
        there = source(args.arcade, folder)
        games += [(group, game) for game in draw.sample(there, min(number, len(there)))]
    draw.shuffle(games)
    key = {}
    for number, (group, game) in enumerate(games, 1):
        folder = args.out / f"{number:02}"
        folder.mkdir(parents=True)
        key[f"{number:02}"] = {"group": group, "game": game.name}
        (folder / "rules.txt").write_text(rules(args.arcade, game))
        for at in (0, 2, 4):
            run(args.arcade, "render", str(game), level(game, at), "--scale", "32", "--legend", "-o",
                str(folder / f"level-{at}.png"))
        won = [at for at in (1, 3) if filmstrip(args.arcade, game, at, folder / f"film-{at}.png", args.seed)]
        key[f"{number:02}"]["films won"] = won
        print(f"{number:02} of {len(games)}", flush=True)
    args.out.with_name(args.out.name + "-key.json").write_text(json.dumps(key, indent=1) + "\n")
    if args.pairs:
        ours, theirs = ([number for number, game in key.items() if game["group"] == group]
                        for group in ("generated", "corpus"))
        pairs = [sorted(pair) for pair in zip(ours, theirs)]
        args.out.with_name(args.out.name + "-pairs.txt").write_text("".join(f"{a} {b}\n" for a, b in sorted(pairs)))


def has_levels(game):
    return all(pathlib.Path(level(game, number)).exists() for number in range(5))


if __name__ == "__main__":
    main()
