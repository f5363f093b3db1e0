#!/usr/bin/env bash
#SBATCH --job-name=arcade-mint
#SBATCH --array=1-16
#SBATCH --cpus-per-task=4
#SBATCH --time=24:00:00
# A release on a Slurm cluster: each task of the array mints a shard, and a job after all of them merges the shards.
#
#   export RECIPE=2026-12 OUT=/shared/2026-12
#   array=$(sbatch --parsable --export=ALL tools/scripts/cluster/slurm.sh)
#   sbatch --dependency=afterok:$array --array=1 --export=ALL,MERGE=16 tools/scripts/cluster/slurm.sh
#
# A task that is killed is requeued and resumes its shard: the bytes are those of `arcade release` on one machine.
set -euo pipefail
: "${RECIPE:?the recipe}" "${OUT:?the folder of the release, on a file system that all nodes see}"
if [ -n "${MERGE:-}" ]; then
  mapfile -t shards < <(seq -f "$OUT.shards/%g" "$MERGE")
  exec arcade merge "${shards[@]}" --out "$OUT"
fi
mkdir -p "$OUT.shards"
exec arcade release "$RECIPE" --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --resume \
  --jobs "$SLURM_CPUS_PER_TASK" --out "$OUT.shards/$SLURM_ARRAY_TASK_ID"
