#!/usr/bin/env bash
# Trains one algorithm on the six games of the seed table, evaluates each checkpoint in its protocol (five levels, five runs, at most 1000
# steps) through `arcade evaluate --player cmd:…`, and prints the win rates.
#
# Usage: python/learn/all.sh ALGORITHM GAMES OUT [STEPS]     GAMES: the folder of the public games; STEPS of each game, 10000000 by default
# Needs `arcade` on the path, and python with the package, its extra gymnasium, jax and optax.
set -euo pipefail
algorithm=$1 games=$2 out=$3 steps=${4:-10000000}
here=$(dirname "${BASH_SOURCE[0]}")
# One thread of JAX for each training: two algorithms share two cores.
export XLA_FLAGS=--xla_cpu_multi_thread_eigen=false OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
mkdir -p "$out"
for game in aliens boulderdash escape realsokoban sokoban zelda; do
  [ -e "$out/$game-$algorithm.npz" ] ||
    python "$here/train.py" "$algorithm" "$games/$game" --steps "$steps" --out "$out" >"$out/$game-$algorithm.log"
  [ -d "$out/results/$algorithm/$game" ] ||
    arcade evaluate "$games/$game" --as-reference --levels 0,1,2,3,4 --runs 5 --max-steps 1000 -q \
      --player "cmd:python $here/player.py $out/$game-$algorithm.npz" --out "$out/results/$algorithm/$game" >/dev/null
done
python "$here/table.py" "$out/results"
