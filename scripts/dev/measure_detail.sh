#!/usr/bin/env bash
# Compares a scene that is coarser far away with full detail, for docs/results/detail.md: echoes by range with three
# sensors on two rungs, with plants and without, then times on three scenarios, then time and memory of a first
# frame. Needs a release build and GNU time; takes some 20 minutes. Nothing else should run meanwhile.
#
#   measure_detail.sh [FRAMES]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
if [[ ! -x /usr/bin/time ]]; then
  echo "error: needs GNU time; as root, run: apt-get install time" >&2
  exit 1
fi
compare=(build/release/tests/bench/railcast-measure detail)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for sensor in vir2rail pandar64 vls128; do
  for plants in "" ", no plants"; do
    vegetation='{"trees_per_hectare": 60}'
    [[ -z "$plants" ]] || vegetation='{"trees_per_hectare": 0, "grass": false}'
    printf '{"version": 1, "file": "%s", "world": {"alignment": "%s", "tracks": [{"name": "main"}, {"name": "second", "offset_m": 4.0}], "vegetation": %s}, "lidar": {"file": "%s", "mount": {"position_m": [2.2, 0, 2.5]}}}\n' \
      "$PWD/scenarios/st_gallen_approach.json" "$PWD/scenarios/alignments/st_gallen_wil.json" "$vegetation" \
      "$PWD/scenarios/sensors/$sensor.json" >"$work/scenario.json"
    for rung in surface footprint; do
      printf '\n%s, %s%s\n\n' "$sensor" "$rung" "$plants"
      "${compare[@]}" "$work/scenario.json" --rung "$rung" --frames "${1:-60}"
    done
  done
done
for scenario in st_gallen_approach open_line forest_rain; do
  for rung in plausibility footprint; do
    printf '\n%s, %s\n' "$scenario" "$rung"
    "${compare[@]}" "scenarios/$scenario.json" --rung "$rung" --turns 15
  done
done
for detail in full auto; do
  printf '{"version": 1, "file": "%s", "world": {"alignment": "%s", "tracks": [{"name": "main"}, {"name": "second", "offset_m": 4.0}], "vegetation": {"trees_per_hectare": 60}, "detail": "%s"}}\n' \
    "$PWD/scenarios/open_line.json" "$PWD/scenarios/alignments/st_gallen_wil.json" "$detail" >"$work/$detail.json"
  printf '\nfirst frame, detail %s\n' "$detail"
  /usr/bin/time -f '%U s of the processor, %M kB' build/release/generator/railcast-generate \
    sequence "$work/$detail.json" --out "$work/out_$detail" --frames 1 --threads 1 >/dev/null
done
