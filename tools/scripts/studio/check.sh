#!/bin/sh
# Checks the page of the studio: that the bundle is built from its sources, that the types hold, and that the page works in Chromium
# with the real server. Usage: tools/scripts/studio/check.sh [--fast]; --fast leaves Chromium out.
# ARCADE names the binary (target/debug/arcade), CHROMIUM the browser (/usr/bin/chromium).
set -eu
root=$(cd "$(dirname "$0")/../../.." && pwd)
page=$root/crates/studio/page
missing() {
    echo "missing: $1" >&2
    exit 3
}
command -v node >/dev/null || missing "node, 20.19 or later: apt-get install nodejs, or https://nodejs.org"
command -v npm >/dev/null || missing "npm: apt-get install npm"
node -e 'const [a, b] = process.versions.node.split(".").map(Number); process.exit(a > 20 || (a === 20 && b >= 19) ? 0 : 1)' ||
    missing "node 20.19 or later; this is $(node --version)"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

cd "$page"
echo "== packages"
PLAYWRIGHT_SKIP_BROWSER_DOWNLOAD=1 npm ci --no-fund --no-audit --silent

echo "== types"
npx tsc --noEmit

echo "== no text becomes markup"
if grep -rnE 'innerHTML|outerHTML|insertAdjacentHTML|document\.write|createContextualFragment|\beval\(|new Function' src; then
    echo "build nodes instead: the studio shows texts of others" >&2
    exit 1
fi

echo "== bundle"
STUDIO_BUNDLE=$scratch/bundle npx vite build --logLevel warn
for file in index.html app.js app.css; do
    cmp "$scratch/bundle/$file" "$root/crates/studio/bundle/$file" || {
        echo "crates/studio/bundle is not built from crates/studio/page: run npm run build in crates/studio/page, and commit both" >&2
        exit 1
    }
done
[ "$(ls "$root/crates/studio/bundle")" = "$(ls "$scratch/bundle")" ] || {
    echo "crates/studio/bundle holds files that the build does not write" >&2
    exit 1
}
size=$(cat "$scratch"/bundle/* | gzip -9c | wc -c)
echo "compressed: $((size / 1000)) KB"
[ "$size" -lt 600000 ] || {
    echo "the bundle is over 600 KB compressed" >&2
    exit 1
}
[ "${1:-}" != --fast ] || exit 0

echo "== in Chromium"
arcade=${ARCADE:-$root/target/debug/arcade}
[ -x "$arcade" ] || missing "$arcade: cargo build -p infinite-arcade, or name a binary with ARCADE"
chromium=${CHROMIUM:-/usr/bin/chromium}
[ -x "$chromium" ] || missing "$chromium: apt-get install chromium, or name a browser with CHROMIUM"
# A release and results to look at; kept between runs, for they take a while.
held=$page/test-data
if [ ! -d "$held/results" ]; then
    rm -rf "$held"
    "$arcade" --quiet release tiny --out "$held/tiny" >"$scratch/release.log"
    # A player behind chat completions: its prompts and answers are in the results.
    "$arcade" serve-player --player reflex >"$scratch/player" &
    player=$!
    trap 'kill "$player" 2>/dev/null || true; rm -rf "$scratch"' EXIT
    while [ ! -s "$scratch/player" ]; do sleep 0.1; done
    url=$(sed 's/.*"base_url":"\([^"]*\)".*/\1/;q' "$scratch/player")
    "$arcade" --quiet evaluate "$held/tiny" --model openai:reflex --base-url "$url" --max-steps 40 --out "$held/results" >"$scratch/evaluate.log"
    kill "$player"
fi
# Two releases, one after the other, within a second; the levels of the second one have tiers.
if [ ! -d "$held/line/two" ]; then
    rm -rf "$held/line"
    quick="[criteria]
decision = 100
budget = 80000
depths = [10, 25]
random_plays = 10"
    cat >"$scratch/one.toml" <<END
name = 'one'
description = 'x'
seed = 'one'
[corpus]
games = 1
levels = 1
candidates = 2.0
$quick
END
    cat >"$scratch/two.toml" <<END
name = 'two'
description = 'x'
seed = 'tiers'
[puzzles]
games = 1
levels = 4
level_tries = 12
candidates = 1.0
columns = [9, 9]
rows = [8, 9]
[tiers]
1 = 0.5
2 = 0.5
$quick
END
    "$arcade" --quiet release "$scratch/one.toml" --out "$held/line/one" >"$scratch/release.log"
    "$arcade" --quiet release "$scratch/two.toml" --parent "$held/line/one" --out "$held/line/two" >"$scratch/release.log"
fi
ARCADE=$arcade CHROMIUM=$chromium SNAPSHOT=$held/tiny LINE=$held/line RESULTS=$held/results npx playwright test
