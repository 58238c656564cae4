#!/usr/bin/env bash
# Counts what each effect costs, for core/fidelity/effect_costs.h: instructions per firing of
# Simulator::Scan, less the making of the scene, on frame 0 of a scenario that gives every effect
# work, rung footprint, one thread; then what is saved without each effect. Needs valgrind; a run
# takes about a minute.
#
#   measure_effect_costs.sh [SCENARIO] [RAILCAST_GENERATE]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scenario="$(realpath "${1:-scenarios/forest_rain.json}")"
generate="$(realpath "${2:-build/release/generator/railcast-generate}")"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

# instructions NAME RUNG EFFECT...: per firing, with the effects switched off.
instructions() {
  local name="$1" rung="$2" effects="" effect
  shift 2
  for effect in "$@"; do effects+="${effects:+, }\"$effect\": false"; done
  printf '{"version": 1, "file": "%s", "fidelity": "%s", "effects": {%s}}\n' \
    "$scenario" "$rung" "$effects" >"$work/scenario.json"
  rm -rf "$work/out"
  valgrind --tool=callgrind --callgrind-out-file=/dev/null \
    --toggle-collect='railcast::Simulator::Parts::Scan*' \
    "$generate" sequence "$work/scenario.json" --frames 1 --threads 1 --out "$work/out" \
    >"$work/said" 2>"$work/counted"
  local firings collected
  firings="$(sed -n 's/^firings by outcome (\([0-9]*\)).*/\1/p' "$work/said")"
  collected="$(sed -n 's/.*Collected : *\([0-9]*\).*/\1/p' "$work/counted")"
  printf '%s %s\n' "$name" "$((collected / firings))"
}

instructions geometry geometry
all="$(instructions footprint footprint)"
echo "$all"
for effect in surface_response surface_condition extinction pulse_stretch detection \
  detection_probability footprint thin_conductors; do
  without="$(instructions "without_$effect" footprint "$effect")"
  echo "$without: $effect costs $((${all#* } - ${without#* }))"
done
