#!/usr/bin/env bash
# Counts the cost of each rung and each effect, for docs/results/performance.md and the table of effects
# (core/detect/detector/effect_table.h): instructions per firing of Simulator::Scan, without those for making
# the scene, on frame 0 of scenarios/open_line.json in heavy rain (so that every effect has work)
# with one thread; then the savings without each effect of the rung footprint; then what the sensor's
# own effects and mirror images cost (docs/effects.md). Needs valgrind; takes some fifteen minutes.
#
#   measure_effect_costs.sh [RAILCAST_GENERATE]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenario="$PWD/scenarios/open_line.json"
weather="$PWD/scenarios/weather/heavy_rain.json"
generate="$(realpath "${1:-build/release/generator/railcast-generate}")"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

# count NAME: prints the instructions per firing of the scenario in $work.
count() {
  rm -rf "$work/out"
  valgrind --tool=callgrind --callgrind-out-file=/dev/null \
    --toggle-collect='railcast::Simulator::Parts::Scan*' \
    "$generate" sequence "$work/scenario.json" --frames 1 --threads 1 --out "$work/out" \
    >"$work/said" 2>"$work/counted"
  local firings collected
  firings="$(sed -n 's/^firings by outcome (\([0-9]*\)).*/\1/p' "$work/said")"
  collected="$(sed -n 's/.*Collected : *\([0-9]*\).*/\1/p' "$work/counted")"
  printf '%s %s\n' "$1" "$((collected / firings))"
}

# instructions NAME RUNG EFFECT...: prints the instructions per firing with the effects switched
# off.
instructions() {
  local name="$1" rung="$2" effects="" effect
  shift 2
  for effect in "$@"; do effects+="${effects:+, }\"$effect\": false"; done
  printf '{"version": 1, "file": "%s", "weather": "%s", "fidelity": "%s", "effects": {%s}}\n' \
    "$scenario" "$weather" "$rung" "$effects" >"$work/scenario.json"
  count "$name"
}

# sensor NAME SECTION: prints the instructions per firing of rung surface beside a person in a
# retroreflecting vest, with a section of `lidar`.
sensor() {
  printf '{"version": 1, "file": "%s", "fidelity": "surface", "lidar": {"file": "%s", %s}}\n' \
    "$PWD/scenarios/parallel_wagons.json" "$PWD/scenarios/sensors/vir2rail.json" \
    "\"mount\": {\"position_m\": [2.0, 0, 2.5]}${2:+, $2}" >"$work/scenario.json"
  count "$1"
}

for rung in geometry plausibility surface; do instructions "$rung" "$rung"; done
all="$(instructions footprint footprint)"
echo "$all"
for effect in surface_response surface_condition extinction pulse_stretch detection \
  detection_probability footprint thin_conductors; do
  without="$(instructions "without_$effect" footprint "$effect")"
  echo "$without: $effect costs $((${all#* } - ${without#* }))"
done

# What 64 sub-rays of the footprint cost more than 16 (core/fidelity/effect_search.h).
printf '{"version": 1, "file": "%s", "weather": "%s", "fidelity": "footprint", "lidar": %s}\n' \
  "$scenario" "$weather" \
  "{\"file\": \"$PWD/scenarios/sensors/vir2rail.json\", \"mount\": {\"position_m\": [2.2, 0, 2.5]},
    \"beam\": {\"divergence_mrad\": [3.0, 1.5], \"footprint_rays\": 16}}" >"$work/scenario.json"
fewer="$(count footprint_16)"
echo "$fewer: 64 sub-rays cost $((${all#* } - ${fewer#* })) more"

# of CLASSES: prints those where only beams have a width that may meet them (core/fidelity/effect_search.h).
of() {
  printf '{"version": 1, "file": "%s", "weather": "%s", "fidelity": "footprint", "lidar": %s}\n' \
    "$scenario" "$weather" \
    "{\"file\": \"$PWD/scenarios/sensors/vir2rail.json\", \"mount\": {\"position_m\": [2.2, 0, 2.5]},
      \"beam\": {\"divergence_mrad\": [3.0, 1.5], \"footprint_of\": [$1]}}" >"$work/scenario.json"
  count "footprint_of $1"
}
of '"derailer"'  # There is none.
of '"rail", "mast", "cantilever", "contact_wire", "messenger_wire", "dropper", "signal", "cable_trough"'

sensor clean ""
sensor dirt '"cover": {"dirt_coverage": 0.1}'
sensor drops '"cover": {"drop_coverage": 0.1}'
sensor halo '"receiver": {"halo_share_at_1_deg": 1e-6}'
sensor saturation '"receiver": {"saturation_power_ratio": 1000}'
sensor ghost '"receiver": {"ghost_reflectance": 0.1}'

# puddles SHARE: prints the instructions per firing of rung surface on the open line with puddles.
puddles() {
  printf '{"version": 1, "file": "%s", "fidelity": "surface", "weather": {"puddle_share": %s}}\n' \
    "$scenario" "$1" >"$work/scenario.json"
  count "puddles_$1"
}
for share in 0 0.2; do puddles "$share"; done

# yard NAME EFFECTS: prints those of rung surface in the yard with puddles.
yard() {
  printf '{"version": 1, "file": "%s", "fidelity": "surface", "effects": {%s}}\n' \
    "$PWD/scenarios/wet_yard.json" "$2" >"$work/scenario.json"
  count "$1"
}
yard yard_without_mirror_paths '"mirror_paths": false'
yard yard_with_mirror_paths ''
