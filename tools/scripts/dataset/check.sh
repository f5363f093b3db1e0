#!/usr/bin/env bash
# Opens exports with the Python libraries that users of datasets have: pandas, pyarrow and datasets.
#
#   tools/scripts/dataset/check.sh [ARCADE] [SNAPSHOT]
#
# ARCADE is the binary (default: target/release/arcade, else target/debug/arcade). Without SNAPSHOT a small release is minted
# from with-ladder.toml. The libraries are installed from the Python package registry into a virtual environment,
# target/dataset-check/venv, which is kept for the next time. Needs python3 with venv. Exit status 0: all is well.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../../.." && pwd)
arcade=${1:-$root/target/release/arcade}
[ -x "$arcade" ] || arcade=$root/target/debug/arcade
work=$root/target/dataset-check
venv=$work/venv

mkdir -p "$work"
[ -x "$venv/bin/python" ] || python3 -m venv "$venv"
"$venv/bin/pip" install --quiet --disable-pip-version-check pandas pyarrow datasets pyyaml

runs=$(mktemp -d "$work/run.XXXXXX")
trap 'rm -rf "$runs"' EXIT
if [ $# -ge 2 ]; then
    snapshot=$2
else
    snapshot=$runs/snapshot
    "$arcade" -q release "$here/with-ladder.toml" --out "$snapshot" > "$runs/minted.txt"
fi

for solutions in "" --solutions; do
    for format in jsonl parquet; do
        # Twice: the same snapshot gives the same bytes.
        for again in a b; do
            # shellcheck disable=SC2086
            "$arcade" -q export "$snapshot" --format "$format" $solutions --out "$runs/$format$solutions.$again" > "$runs/said.txt"
        done
        diff -r "$runs/$format$solutions.a" "$runs/$format$solutions.b"
    done
    # Nothing is fetched: what is loaded lies in these folders.
    HF_HUB_OFFLINE=1 HF_DATASETS_CACHE="$runs/cache" \
        "$venv/bin/python" "$here/check.py" "$snapshot" "$runs/jsonl$solutions.a" "$runs/parquet$solutions.a"
done
