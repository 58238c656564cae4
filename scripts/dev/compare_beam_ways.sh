#!/usr/bin/env bash
# Times ways of tracing the beams of effect `footprint` beside the one that railcast uses:
# compare_beam_ways.sh [TURNS]. Installs and builds what it needs and prints tables in Markdown, for
# docs/notes/beam_trace.md. Takes some minutes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source scripts/packages.sh

install_packages "${build_packages[@]}"
cmake --preset release >/dev/null
cmake --build --preset release --target railcast-beamways >/dev/null

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# scenario NAME LIDAR: the open line with another sensor or another pattern.
scenario() {
  printf '{"version": 1, "file": "%s", "lidar": {"file": "%s", "mount": {"position_m": %s}%s}}\n' \
    "$PWD/scenarios/open_line.json" "$PWD/scenarios/sensors/$2.json" "$3" "${4:-}" \
    >"$folder/$1.json"
}
scenario pandar64 pandar64 '[2.0, 0, 4.6], "pitch_deg": 3'
scenario vls128 vls128 '[2.0, 0, 4.6], "pitch_deg": 3'
pattern='"type": "raster", "horizontal_fov_deg": 12, "vertical_fov_deg": 6, "angular_resolution_deg": 0.05'
scenario narrow vir2rail '[2.2, 0, 2.5]' ", \"scan\": {\"rate_hz\": 10, \"pattern\": {$pattern}}"
build/release/tests/bench/railcast-beamways --turns "${1:-5}" scenarios/open_line.json \
  "$folder"/{pandar64,vls128,narrow}.json
