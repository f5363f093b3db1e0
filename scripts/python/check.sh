#!/usr/bin/env bash
# Checks of the Python package: builds the extension, checks types, runs pytest, in a virtual environment of its own.
#
# Usage: scripts/python/check.sh [FOLDER]     the folder of the environment; default: target/python
# Needs python3 (3.11 or later), a Rust toolchain and, the first time, the Python package index.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

environment=${1:-target/python}
export CARGO_INCREMENTAL=0 CARGO_TARGET_DIR="$PWD/target"
[ -x "$environment/bin/python" ] || python3 -m venv "$environment"
. "$environment/bin/activate"
python -m pip install --quiet --disable-pip-version-check maturin 'gymnasium>=1.2,<2' 'inspect-ai>=0.3.200' mypy pytest
cd python
cargo fmt --check
if cargo clippy --version >/dev/null 2>&1; then
  cargo clippy --locked --release -- -D warnings
fi
maturin develop --locked --release --quiet
mypy
python -m pytest -q
