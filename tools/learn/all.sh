#!/usr/bin/env bash
# Trains one algorithm on the six games of the seed table, evaluates each checkpoint in its protocol (five levels, five runs, at most 1000
# steps) through `arcade evaluate --player cmd:…`, and prints the win rates. A planner, such as mcts:1000, is evaluated alike.
#
# Usage: tools/learn/all.sh ALGORITHM|PLANNER GAMES OUT [STEPS]     GAMES: the folder of the public games; STEPS of each game, 3000000 by
# default. What is in OUT is not done again.
# Needs `arcade` on the path, and python with the package, its extra gymnasium, jax and optax.
set -euo pipefail
if [ $# -lt 3 ]; then
  echo "usage: tools/learn/all.sh ALGORITHM|PLANNER GAMES OUT [STEPS]" >&2
  exit 2
fi
player=$1 games=$2 out=$3 steps=${4:-3000000}
here=$(dirname "${BASH_SOURCE[0]}")
# One thread of JAX for each training: two algorithms share two cores.
export XLA_FLAGS=--xla_cpu_multi_thread_eigen=false OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
mkdir -p "$out"
for game in aliens boulderdash escape realsokoban sokoban zelda; do
  entry=$player
  if [ "$player" = dqn ] || [ "$player" = ppo ]; then
    [ -e "$out/$game-$player.npz" ] ||
      python "$here/train.py" "$player" "$games/$game" --steps "$steps" --out "$out" >"$out/$game-$player.log"
    entry="cmd:python $here/player.py $out/$game-$player.npz"
  fi
  results=$out/results/$player/$game
  resume=
  [ ! -d "$results" ] || resume=--resume
  arcade evaluate "$games/$game" --as-reference --levels 0,1,2,3,4 --runs 5 --max-steps 1000 -q \
    --player "$entry" --out "$results" $resume >/dev/null
done
python "$here/table.py" "$out/results"
