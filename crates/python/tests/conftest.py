"""Games and fixtures for the tests."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]

# `python -m pytest` puts this folder before the installed packages. An installed wheel has the extension, but the
# folder does not.
if not any((ROOT / "crates/python/infinite_arcade").glob("_native*.so")):
    sys.path[:] = [entry for entry in sys.path if Path(entry).resolve() != ROOT / "crates/python"]

import infinite_arcade as ia

#: A corridor in which the squirrel is one or two steps from the nut, and loses after 20 ticks.
NUT = """BasicGame
    SpriteSet
        nut > Immovable
        squirrel > MovingAvatar
    LevelMapping
        n > nut
        S > squirrel
    InteractionSet
        nut squirrel > killSprite scoreChange=1
        squirrel EOS > stepBack
    TerminationSet
        SpriteCounter stype=nut win=True
        Timeout limit=20 win=False
"""


@pytest.fixture
def nut() -> ia.Game:
    return ia.Game(NUT, ["S n", "S  n"], id="nut")


@pytest.fixture(scope="session")
def arcade() -> Path:
    """Returns the path of the command line, if it has been built."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    found = [target / profile / "arcade" for profile in ("release", "debug")]
    built = [path for path in found if path.is_file()]
    if not built:
        pytest.skip("arcade has not been built: cargo build --release")
    version = subprocess.run([built[0], "--version"], capture_output=True, text=True, check=True)
    if ia.__version__ not in version.stdout:
        pytest.skip(f"{built[0]} has a different version")
    return built[0]


@pytest.fixture(scope="session")
def tiny(arcade: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Returns a release minted by the command line. Tests must not change it."""
    out = tmp_path_factory.mktemp("releases") / "tiny"
    subprocess.run([arcade, "release", "tiny", "--out", out, "-q"], check=True, stdout=subprocess.DEVNULL)
    return out
