"""Installs the Python package in editable mode into the environment of this interpreter, with an extension that Cargo
has built.

Usage: python tools/scripts/python/develop.py target/debug/lib_native.so

`maturin develop` does the same with an extension that it builds itself.
"""

import json
import shutil
import sys
import sysconfig
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]


def main() -> None:
    if len(sys.argv) != 2 or not Path(sys.argv[1]).is_file():
        raise SystemExit("usage: develop.py LIBRARY; `cargo build -p infinite-arcade-python` builds it")
    package = ROOT / "crates/python"
    project = tomllib.loads((package / "pyproject.toml").read_text())["project"]
    version = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]
    # A library that is mapped into memory must not be overwritten.
    extension = package / "infinite_arcade" / "_native.abi3.so"
    extension.unlink(missing_ok=True)
    shutil.copy2(sys.argv[1], extension)
    site = Path(sysconfig.get_path("platlib"))
    (site / "infinite_arcade.pth").write_text(f"{package}\n")
    for other in site.glob("infinite_arcade-*.dist-info"):
        shutil.rmtree(other)
    info = site / f"infinite_arcade-{version}.dist-info"
    info.mkdir()
    name = project["name"]
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n")
    direct = {"url": package.as_uri(), "dir_info": {"editable": True}}
    (info / "direct_url.json").write_text(json.dumps(direct))
    lines = []
    for group, entries in project["entry-points"].items():
        lines += [f"[{group}]", *(f"{entry} = {target}" for entry, target in entries.items())]
    (info / "entry_points.txt").write_text("\n".join(lines) + "\n")
    files = ["infinite_arcade.pth", *(f"{info.name}/{file.name}" for file in sorted(info.iterdir()))]
    (info / "RECORD").write_text("".join(f"{file},,\n" for file in files))


if __name__ == "__main__":
    main()
