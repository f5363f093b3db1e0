#!/usr/bin/env bash
# Compiles a crate of the workspace and lints the same crate: `RUSTC_WORKSPACE_WRAPPER=tools/scripts/lint-and-compile.sh cargo test`. Lints
# need the interfaces of all dependencies; `cargo clippy` would check those apart from their build, for a fifth of the time of the tests.
# Any lint is an error. Usage by cargo: lint-and-compile.sh RUSTC ARGUMENTS...
set -euo pipefail
rustc=$1
shift
case " $* " in
  *" --crate-name ___ "* | *" -vV "*) exec "$rustc" "$@" ;;
esac
# The tests of a library hold all of its code, so that Clippy need not read it twice; what is dead or undocumented without them, the
# compiler tells.
case " $* " in
  *" --test "*) ;;
  *" --crate-type lib "*) exec "$rustc" "$@" -D warnings ;;
esac
# What the compiler itself warns of, Clippy's driver says again.
"$rustc" "$@" --cap-lints allow
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
arguments=()
while [ $# -gt 0 ]; do
  case $1 in
    --emit=*) arguments+=(--emit=metadata) ;;
    # No dependant may begin by what the lints leave.
    --json=*) arguments+=("$(sed 's/artifacts,\|,artifacts//' <<<"$1")") ;;
    --out-dir)
      arguments+=(--out-dir "$scratch")
      shift
      ;;
    *) arguments+=("$1") ;;
  esac
  shift
done
clippy-driver "$rustc" "${arguments[@]}" -D warnings
