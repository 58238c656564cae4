#!/usr/bin/env bash
# One task of submit.sh: makes or continues the shard of its number in the array.
#
#   shard.sh GENERATE RECIPE SHARDS [DATASET_OPTION...]
set -euo pipefail
generate=$1
recipe=$2
shards=$3
shift 3
exec "$generate" dataset "$recipe" --out "$shards/$SLURM_ARRAY_TASK_ID" \
  --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_MAX" --threads "${SLURM_CPUS_PER_TASK:-1}" "$@"
