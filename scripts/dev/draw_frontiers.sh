#!/usr/bin/env bash
# Measures time against accuracy on four scenarios with the published raster, and on two of them with
# three sensors whose beams lie otherwise, into out/frontier, and copies the raster's charts to where
# docs/results/frontier_scenes.md shows them: draw_frontiers.sh [OPTION OF railcast-analyze frontier...]. The options
# are for the raster. What the same program has measured already is left as it is. Takes half an hour;
# for timings worth quoting nothing else may run on the machine. Called by measure_results.py, which
# makes tables of it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

scenes=(open_line parallel_wagons forest_rain fog_yard)
sensors=(pandar64 vls128 rosette)
version="$(build/release/analysis/railcast-analyze --version)"
version="${version#railcast }"

# frontier NAME SCENARIO [OPTION...]
frontier() {
  local name="$1" scenario="$2"
  shift 2
  if grep --quiet --no-messages "\"version\": \"$version\"" "out/frontier/$name/frontier.json"; then return; fi
  build/release/analysis/railcast-analyze frontier "$scenario" --out "out/frontier/$name" "$@"
}

for scene in "${scenes[@]}"; do
  frontier "$scene" "scenarios/$scene.json" "$@"
  cp "out/frontier/$scene/frontier.png" "docs/images/frontier_$scene.png"
done

# One frame of these sensors has as many second surfaces as four of the raster's, and the slowest
# rows are left out. The scan all around is mounted on the roof, as in README; the rosette looks
# ahead, as the raster does.
mkdir -p out/frontier/scenarios
for scene in open_line parallel_wagons; do
  for sensor in "${sensors[@]}"; do
    mount='{"position_m": [2.0, 0, 4.6], "pitch_deg": 3}'
    if [[ "$sensor" == rosette ]]; then mount='{"position_m": [2.2, 0, 2.5]}'; fi
    scenario="out/frontier/scenarios/${scene}_$sensor.json"
    printf '{"version": 1, "file": "%s", "lidar": {"file": "%s", "mount": %s}}\n' \
      "$PWD/scenarios/$scene.json" "$PWD/scenarios/sensors/$sensor.json" "$mount" >"$scenario"
    frontier "${scene}_$sensor" "$scenario" --frames 1 \
      --rows surface,surface+thin_conductors,footprint,brute_force_64
  done
done
