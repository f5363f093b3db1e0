#!/bin/sh
# A year of small months on one scale: mints them from one template, each the child of the one before, calibrates the first, links the
# others, has players on all of them, and makes the timeline. One to two minutes of a core for each month.
# Usage: tools/scripts/year.sh DIR [MONTHS]     ARCADE=path of the binary
# REAL_MODEL=base URL of the server of tools/scripts/real-model adds that model, with EPISODES (2) a month, up to
# ten minutes of two cores each.
# Run again after an interruption, it goes on with what is missing.
set -eu
arcade=${ARCADE:-arcade}
out=$1
months=${2:-12}
steps=300
mkdir -p "$out/recipes" "$out/releases" "$out/scales" "$out/results"

# The served player: its requests go the way that those to a language model go. A file of an earlier run names another port.
rm -f "$out/server.json"
"$arcade" serve-player --player reflex > "$out/server.json" &
server=$!
trap 'kill $server' EXIT
until [ -s "$out/server.json" ]; do sleep 1; done
url=$(sed 's/.*"base_url":"\([^"]*\)".*/\1/' "$out/server.json")

# An evaluation, unless it is there: evaluate MONTH FOLDER FLAGS…
evaluate() {
    month=$1 folder=$out/results/$2/$1
    shift 2
    resume=
    [ -d "$folder" ] && resume=--resume
    "$arcade" evaluate "$out/releases/$month" --max-steps $steps --out "$folder" -q $resume "$@"
}

parent= scale=
for number in $(seq 1 "$months"); do
    month=2027-$(printf %02d "$number")
    recipe=$out/recipes/$month.toml
    release=$out/releases/$month
    # Later months find some games near to those of earlier ones, and need more candidates; finished jobs are kept.
    for candidates in 2.0 4.0 8.0; do
        [ -d "$release" ] && break
        cat > "$recipe" <<END
name = "$month"
description = "A small month: 12 games of 3 levels."
seed = "month $number of the year"

[generated]
games = 4
levels = 3
game_tries = 96
candidates = $candidates

[corpus]
games = 8
levels = 3
candidates = 2.0

[criteria]
decision = 200
budget = 240000
depths = [10, 25]
random_plays = 20
END
        resume=
        [ -d "$release.partial" ] && resume=--resume
        "$arcade" release "$recipe" --out "$release" -q $resume ${parent:+--parent "$parent"} > /dev/null || true
    done
    parent=$release
    # The second anchor: a reader of another kind than the examinee reflex-3.
    evaluate "$month" touch-everything --player touch-everything
    scaled=$out/scales/$month
    if [ ! -f "$scaled/scale.json" ]; then
        resume=
        [ -d "$scaled/plays" ] && resume=--resume
        "$arcade" study calibrate "$release" --runs 2 --max-steps $steps --out "$scaled" -q $resume \
            ${scale:+--scale "$scale"} --readers "$out/results/touch-everything/$month"
    fi
    scale=$scaled/scale.json
    # Planners that took no part in the calibration: they should stay where they are.
    for player in olets:100 rhea:400 guided-mcts:100; do
        evaluate "$month" "$(echo $player | tr : -)" --player $player --runs 2
    done
    evaluate "$month" reflex --player reflex --runs 2
    evaluate "$month" served --model openai:reflex --base-url "$url"
    # The scale chooses its few levels, spread over games.
    [ -z "${REAL_MODEL:-}" ] ||
        evaluate "$month" real-model --model openai:smollm2-135m-instruct --base-url "$REAL_MODEL" --scale "$scale" \
            --episodes "${EPISODES:-2}" --max-output-tokens 12 --temperature 0.7 --reasks 0 --concurrency 1 --keep-going
done

[ -d "$out/timeline" ] || "$arcade" study timeline "$out"/results/*/* "$out"/scales/*/plays/* --scale "$scale" --out "$out/timeline"
