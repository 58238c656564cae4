#!/usr/bin/env bash
# Measures time against accuracy on four scenarios, with the published raster, with three sensors
# whose beams lie otherwise and with a narrow view, into out/frontier, and copies the raster's charts
# to where docs/frontier.md shows them: draw_frontiers.sh [OPTION OF railcast-analyze frontier...].
# The options are for the raster. What the same program has measured already is left as it is. Takes
# an hour; for timings worth quoting nothing else may run on the machine. Called by
# measure_results.py, which makes tables of it.
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
for scene in "${scenes[@]}"; do
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

# A narrow view of 0.05 degrees, in which beams overlap.
for scene in "${scenes[@]}"; do
  scenario="out/frontier/scenarios/${scene}_narrow.json"
  pattern='"type": "raster", "horizontal_fov_deg": 12, "vertical_fov_deg": 6, "angular_resolution_deg": 0.05'
  printf '{"version": 1, "file": "%s", "lidar": {"file": "%s", "mount": %s, "scan": %s}}\n' \
    "$PWD/scenarios/$scene.json" "$PWD/scenarios/sensors/vir2rail.json" \
    '{"position_m": [2.2, 0, 2.5]}' "{\"rate_hz\": 10, \"pattern\": {$pattern}}" >"$scenario"
  frontier "${scene}_narrow" "$scenario" --frames 1 \
    --rows surface,surface+thin_conductors,footprint,brute_force_64
done
