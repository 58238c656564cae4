#!/usr/bin/env bash
# Shows on a throwaway Slurm cluster of two nodes on this machine that a data set is the same, to the
# byte, as 1, 7 and 32 shards, though a task is killed in the middle of each. Needs root and Debian's
# slurm-wlm and munge; without them it says so and succeeds.
#
#   scripts/cluster/test_cluster.sh BUILD [FRAMES]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source scripts/cluster/throwaway_slurm.sh

build=$(realpath -e "$1")
num_frames=${2:-1000}
for program in slurmctld slurmd munged sbatch; do
  if ! command -v "$program" > /dev/null; then
    echo "skipped: $program is not installed (Debian: slurm-wlm, munge)"
    exit 0
  fi
done
if [[ $(id -u) != 0 ]]; then
  echo "skipped: slurmd needs root"
  exit 0
fi

folder=$(mktemp -d)
trap 'stop_cluster "$folder/cluster"; sleep 1; rm -rf "$folder"' EXIT
start_cluster "$folder/cluster"

# Scans of 7,200 beams on a line without plants, ten frames of each scenario.
python3 - "$num_frames" > "$folder/recipe.json" << 'PYTHON'
import json
import os
import sys

scenarios = os.path.abspath("scenarios")
json.dump({"version": 1, "seed": 3, "num_scenarios": int(sys.argv[1]) // 10, "num_frames": 10,
           "bases": [{"file": f"{scenarios}/minimal.json"}],
           "set": {"/lidar/scan/pattern/angular_resolution_deg": 0.5,
                   "/world/vegetation/trees_per_hectare": 0, "/world/vegetation/grass": False},
           "groups": [{"name": "weather", "random_weather": ["sunny", "rainy", "foggy", "snowy"]}],
           "start_s_m": {"type": "uniform", "min": 100, "max": 600},
           "objects": [{"name": "person", "count": {"type": "integer", "min": 0, "max": 3},
                        "object": {"type": "person"},
                        "draws": {"/d_m": {"type": "uniform", "min": -5, "max": 5}},
                        "ahead_m": {"type": "log_uniform", "min": 10, "max": 150},
                        "gauge": "any"}]}, sys.stdout)
PYTHON

# await JOB: until it has ended; fails if it did.
await() {
  local state
  while true; do
    state=$(scontrol show job "$1" | grep -o 'JobState=[A-Z_]*' | head -1)
    case $state in
      JobState=COMPLETED) return 0 ;;
      JobState=PENDING | JobState=RUNNING | JobState=COMPLETING) sleep 0.5 ;;
      *) echo "error: the last job: $state" >&2; cat "$2"/log/merge.txt >&2; return 1 ;;
    esac
  done
}

# kill_one SHARDS: kills a task, once it has written some of its frames.
kill_one() {
  local victim=0
  until ((victim > 0)); do
    sleep 0.3
    if compgen -G "$1/*/sequences/*/*/frames/*" > /dev/null; then
      victim=$(pgrep -f "railcast-generate dataset .* --out $1/" | head -1 || echo 0)
    fi
  done
  killed=$(tr '\0' ' ' < "/proc/$victim/cmdline" | grep -o -- "--shard [0-9/]*" || true)
  kill -9 "$victim"
  killed+=" after $(find "$1" -path '*/frames/*' | wc -l) frames of all"
}

for num_shards in 1 7 32; do
  out=$folder/set_$num_shards
  begin=$(date +%s.%N)
  job=$(scripts/cluster/submit.sh --build "$build" "$folder/recipe.json" "$out" "$num_shards")
  kill_one "$out.shards"
  await "$job" "$out.shards"
  end=$(date +%s.%N)
  hash=$(cd "$out" && find . -type f -print0 | sort -z | xargs -0 sha256sum | sha256sum | cut -c 1-16)
  echo "$num_shards shards: $(awk "BEGIN {printf \"%.1f\", $end - $begin}") s; killed $killed;" \
    "$(find "$out" -type f | wc -l) files, sha256 of all $hash"
  hashes+=("$hash")
done
[[ ${hashes[0]} == "${hashes[1]}" && ${hashes[0]} == "${hashes[2]}" ]] || {
  echo "error: the data sets differ" >&2
  exit 1
}
echo "the three data sets are the same"
