#!/usr/bin/env bash
# Approaches a standing wagon and a person in clear air, rain and fog, prints the results, and writes
# them into the table of docs/results/braking.md. Every run is in lockstep, so that the figures are
# reproducible, on a busy machine, too.
#
# Usage: scripts/dev/brake_runs.sh [BUILD_DIR]
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${1:-build/release}
runs=$(mktemp)
simulation=
trap '[[ -z $simulation ]] || kill "$simulation" 2>/dev/null; rm -f "$runs"' EXIT

for scenario in brake_wagon brake_person; do
  for weather in clear heavy_rain thick_fog; do
    "$build/generator/railcast-generate" stream "scenarios/$scenario.json" --lockstep \
      --fields x,y,z --commands-port 27401 >/dev/null &
    simulation=$!
    options=()
    [[ $weather == clear ]] || options=(--weather "scenarios/weather/$weather.json")
    printf '%-13s %-11s ' "$scenario" "$weather" | tee -a "$runs"
    { examples/brake_client.py --lockstep "${options[@]}" || true; } | tee -a "$runs"
    kill -INT "$simulation"
    wait "$simulation"
    simulation=
  done
done
scripts/dev/brake_table.py "$runs" docs/results/braking.md
