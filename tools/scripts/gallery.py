#!/usr/bin/env python3
"""Writes a page of generated games, with their dilemmas, the problems that their levels pose, the values measured by the gates (criteria for games), and wins as filmstrips.

    arcade generate games --method constructive --count 50 --seed s --out new-games
    cargo xtask side-by-side --gates --ours new-games --rows gates.jsonl
    tools/scripts/gallery.py --arcade target/release/arcade --games new-games --gates gates.jsonl --count 10 --seed s \
        --out docs/lab/gallery.md

Images are written to a folder next to the page. Each game has one image, with a row of frames for each level. Requires Pillow.
"""

import argparse
import json
import pathlib
import random
import tempfile

from PIL import Image

from filmstrip import frames, run, sheet

FRAMES = 5
CELL = 14
COLORS = 64
BEGIN, END = "<!-- games: written by tools/scripts/gallery.py -->", "<!-- end of games -->"


def film(arcade, game, number):
    """Draws the win of a level as a row of frames."""
    with tempfile.TemporaryDirectory() as scratch:
        gif = pathlib.Path(scratch) / "win.gif"
        done = run(arcade, "render", str(game), str(game / f"lvl{number}.txt"), "--episode",
                   str(game / "witness" / f"lvl{number}.json"), "--scale", str(CELL), "--bare", "-o", str(gif))
        if done.returncode:
            raise SystemExit(done.stderr)
        return sheet(frames(gif, FRAMES), FRAMES)


def stacked(rows):
    whole = Image.new("RGB", (max(row.width for row in rows), sum(row.height for row in rows)), "white")
    top = 0
    for row in rows:
        whole.paste(row, (0, top))
        top += row.height
    return whole.quantize(COLORS)


def section(card, picture, gates):
    sentences = card["description"].split(". ")
    patterns = card["origin"]["patterns"]
    lines = [f"## {card['title']}", "", f"*{sentences[1].rstrip('.')}.* {card['goal']}", "",
             f"Made of {', '.join(f'`{pattern}`' for pattern in patterns)}.", "", f"![wins of its levels]({picture})", ""]
    lines += [f"{number + 1}. {level['asks']} (Won in {level['witness_ticks']} ticks.)"
              for number, level in enumerate(card["levels"])]
    return lines + ["", gates, ""]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--arcade", required=True)
    parser.add_argument("--games", type=pathlib.Path, required=True)
    parser.add_argument("--gates", type=pathlib.Path, required=True)
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--seed", default="gallery")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    args = parser.parse_args()
    rows = {row["name"]: row for row in map(json.loads, args.gates.read_text().splitlines())}
    folders = sorted(card.parent for card in args.games.glob("*/card.json"))
    pictures = args.out.with_suffix("")
    pictures.mkdir(exist_ok=True)
    written = []
    for folder in sorted(random.Random(args.seed).sample(folders, args.count)):
        card = json.loads((folder / "card.json").read_text())
        strip = stacked([film(args.arcade, folder, number) for number in range(len(card["levels"]))])
        picture = pictures / f"{folder.name.rsplit('-', 1)[0]}.png"
        strip.save(picture, optimize=True)
        figures = ", ".join(f"`{gate}` {figure}".strip() for gate, figure in told(rows[folder.name]))
        written += section(card, f"{pictures.name}/{picture.name}", f"Gates: {figures}.")
        print(folder.name, flush=True)
    head, rest = args.out.read_text().split(BEGIN)
    args.out.write_text(head + BEGIN + "\n\n" + "\n".join(written) + END + rest.split(END)[1])


def told(row):
    """Formats the results of the gates (criteria for games) with the measured values, and marks failed gates."""
    for gate, answer in row["gates"].items():
        if gate == "winnable":
            continue
        mark = {True: "", False: " (fails)", None: " (nothing to judge)"}[answer["passes"]]
        yield gate, ("" if answer["figure"] is None else f"{answer['figure']:.2f}") + mark


if __name__ == "__main__":
    main()
