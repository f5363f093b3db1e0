#!/usr/bin/env bash
# Checks of the Python package: builds the extension, checks types, runs pytest, in a virtual environment of its own.
#
# Usage: tools/scripts/python/check.sh [--release] [FOLDER]     the folder of the environment; default: target/python
# The extension is built with what `cargo test --workspace` builds, and shares it (Linux); with --release it is the one of a wheel, by
# maturin.
# Needs python3 (3.11 or later), a Rust toolchain and, the first time, the Python package index; without these packages it ends with 77.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."

release=
if [ "${1:-}" = --release ]; then
  release=1
  shift
fi
case "${1:-}" in
  -*)
    echo "unknown option $1; usage: tools/scripts/python/check.sh [--release] [FOLDER]" >&2
    exit 2
    ;;
esac
environment=${1:-target/python}
export CARGO_INCREMENTAL=0 CARGO_TARGET_DIR="$PWD/target"
[ -x "$environment/bin/python" ] || python3 -m venv "$environment"
. "$environment/bin/activate"
python -m pip install --quiet --disable-pip-version-check ${release:+maturin} \
  'gymnasium>=1.2,<2' 'inspect-ai>=0.3.200' 'mcp>=1.20,<3' mypy pytest || {
  echo "not checked: what the tests need cannot be installed" >&2
  exit 77
}
if [ -n "$release" ]; then
  (cd crates/python && maturin develop --locked --release --quiet)
else
  # maturin would build the suite again, with the features that the extension alone asks for.
  cargo build --workspace --lib --bins --tests --locked --quiet
  python tools/scripts/python/develop.py target/debug/lib_native.so
fi
cd crates/python
mypy
python -m pytest -q
