#!/usr/bin/env bash
# Measures time against accuracy on four scenarios and copies the charts to where docs/frontier.md
# shows them: draw_frontiers.sh [OPTION OF railcast-analyze frontier...]. Prints the tables. Takes
# some minutes; for timings worth quoting nothing else may run on the machine.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

for name in open_line parallel_wagons forest_rain fog_yard; do
  build/release/analysis/railcast-analyze frontier "scenarios/$name.json" \
    --out "out/frontier/$name" "$@"
  cp "out/frontier/$name/frontier.png" "docs/images/frontier_$name.png"
done
