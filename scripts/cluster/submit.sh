#!/usr/bin/env bash
# Makes a data set on a Slurm cluster: an array job with a task for each shard, as many arrays again
# for the tasks that were lost, and a job that merges the shards and verifies the result.
#
#   scripts/cluster/submit.sh [--build FOLDER] [--tries N] [--isa NAME] RECIPE OUT SHARDS [SBATCH_OPTION...]
#
# Shards are made in OUT.shards/1, 2, ..., logs are in OUT.shards/log; OUT must lie on a file system
# that all nodes share. A task that finds its shard complete ends at once, so that tries after the
# first (3 in all by default) cost nothing where nothing was lost; the same command continues a data
# set. Nodes of different kinds need an --isa that all have (docs/results/accuracy.md) for the same bytes. A
# task uses the processors that --cpus-per-task says. Prints the number of the last job, which fails
# if the data set is not whole.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$here/../../build/release
tries=3
isa=()
while [[ ${1:-} == --* ]]; do
  case $1 in
    --build) build=$2 ;;
    --tries) tries=$2 ;;
    --isa) isa=(--isa "$2") ;;
    *) sed -n '2,/^set/p' "${BASH_SOURCE[0]}" | grep '^#' | cut -c 3- >&2; exit 2 ;;
  esac
  shift 2
done
if [[ $# -lt 3 || ! $3 =~ ^[1-9][0-9]*$ || ! $tries =~ ^[1-9][0-9]*$ ]]; then
  sed -n '2,/^set/p' "${BASH_SOURCE[0]}" | grep '^#' | cut -c 3- >&2
  exit 2
fi
build=$(realpath -e "$build")
recipe=$(realpath -e "$1")
out=$(realpath -m "$2")
num_shards=$3
shift 3
mkdir -p "$out.shards/log"

dependency=()
for try in $(seq "$tries"); do
  job=$(sbatch --parsable "$@" "${dependency[@]}" --requeue --array="1-$num_shards" \
    --job-name="railcast shards, try $try" --output="$out.shards/log/%a_try_$try.txt" \
    "$here/shard.sh" "$build/generator/railcast-generate" "$recipe" "$out.shards" "${isa[@]}")
  dependency=("--dependency=afterany:$job")
done
sbatch --parsable "$@" "${dependency[@]}" --job-name="railcast merge" \
  --output="$out.shards/log/merge.txt" "$here/merge.sh" "$build" "$out" "$num_shards"
