"""Places frames of an episode side by side, for the other scripts. Requires Pillow."""

import subprocess

from PIL import Image

GAP = 6


def run(arcade, *args):
    return subprocess.run([arcade, *args], capture_output=True, text=True, check=False, timeout=300)


def frames(gif, count):
    """Returns evenly spaced frames of an animation, including the first and the last frame."""
    animation = Image.open(gif)
    last = getattr(animation, "n_frames", 1) - 1
    picked = []
    for at in sorted({round(step * last / (count - 1)) for step in range(count)}):
        animation.seek(at)
        picked.append(animation.convert("RGB"))
    return picked


def sheet(pictures, columns):
    """Arranges images in rows with a given number of columns."""
    width, height = max(p.width for p in pictures) + GAP, max(p.height for p in pictures) + GAP
    whole = Image.new("RGB", (min(columns, len(pictures)) * width, -(-len(pictures) // columns) * height), "white")
    for at, picture in enumerate(pictures):
        whole.paste(picture, ((at % columns) * width, at // columns * height))
    return whole
