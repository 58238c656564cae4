#!/usr/bin/env bash
# Counts what certificates of 1 % add to the frames of an insertion, for docs/certificate.md: instructions of 20 frames less
# those of 10, with and without. Two persons and a box are put into frames of a VLP-16 in PCD, on rung surface, with one
# thread. Needs valgrind; takes some five minutes.
#
#   measure_insert_certificate.sh [BUILD]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build="$(realpath "${1:-build/release}")/generator"
scenarios="$PWD/scenarios"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

cat >"$work/scenario.json" <<END
{"version": 1, "file": "$scenarios/minimal.json", "fidelity": "footprint",
 "lidar": {"file": "$scenarios/sensors/vlp16.json", "mount": {"position_m": [2.2, 0, 2.5]}}}
END
cat >"$work/plan.json" <<END
{"version": 1, "fidelity": "surface",
 "materials": "$scenarios/materials/railway.json", "labels": "$scenarios/labels.json",
 "world": {"recording": {}, "objects": [
   {"name": "near", "type": "person", "s_m": 12, "h_m": 0, "heading_deg": 90},
   {"name": "far", "type": "person", "s_m": 25, "d_m": 1.6},
   {"name": "box", "type": "box", "size_m": [0.8, 0.8, 0.8], "s_m": 18, "d_m": -1.6}]}}
END
"$build/railcast-generate" sequence "$work/scenario.json" --frames 20 --out "$work/recording" >"$work/said" 2>&1

# instructions FRAMES SHARE: of the program that insert is, which railcast-generate starts.
instructions() {
  rm -rf "$work/inserted"
  valgrind --tool=callgrind --callgrind-out-file=/dev/null "$build/railcast-recordings" insert "$work/recording" \
    "$work/plan.json" --frames "0..$(($1 - 1))" --certify "$2" --threads 1 --out "$work/inserted" >"$work/said" 2>"$work/counted"
  sed -n 's/.*Collected : *\([0-9]*\).*/\1/p' "$work/counted"
}

with=$(($(instructions 20 1%) - $(instructions 10 1%)))
without=$(($(instructions 20 off) - $(instructions 10 off)))
printf '%d instructions in 10 frames, with certificates %d: %d permille more\n' \
  "$without" "$with" "$(((with - without) * 1000 / without))"
