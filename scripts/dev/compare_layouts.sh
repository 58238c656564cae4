#!/usr/bin/env bash
# Times ways of giving scenes and rays to Embree beside the one that railcast uses:
# compare_layouts.sh [TURNS]. Installs and builds what it needs and prints a table in Markdown, for
# docs/notes/embree.md. Takes ten minutes and 8 GB of memory.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source scripts/packages.sh

install_packages "${build_packages[@]}"
cmake --preset release >/dev/null
cmake --build --preset release --target railcast-layouts >/dev/null

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for sensor in pandar64 vls128; do
  cat >"$folder/$sensor.json" <<JSON
{
  "version": 1,
  "file": "$PWD/scenarios/st_gallen_approach.json",
  "lidar": {
    "file": "$PWD/scenarios/sensors/$sensor.json",
    "mount": {"position_m": [2.0, 0, 4.6], "pitch_deg": 3}
  }
}
JSON
done
build/release/tests/bench/railcast-layouts --turns "${1:-9}" scenarios/st_gallen_approach.json \
  scenarios/open_line.json scenarios/forest_rain.json "$folder"/*.json
