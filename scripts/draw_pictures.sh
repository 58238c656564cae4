#!/usr/bin/env bash
# Draws the viewer's pictures of README and docs into docs/images: the same bytes each time on one
# machine. Needs a release build; runs a minute.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

generate=build/release/generator/railcast-generate
runs=$(mktemp -d)
trap 'rm -rf "$runs"' EXIT

# A scenario like the demo's, but for the weather. JSON takes no comments: $1 is its weather.
like_demo() {
  printf '{"version": 1, "file": "%s", "weather": %s}' \
    "$PWD/scenarios/st_gallen_approach.json" "$1" > "$runs/$2.json"
  "$generate" sequence "$runs/$2.json" --out "$runs/$2" --frames 41 2> "$runs/log"
}
like_demo '{"rain_rate_mmph": 2.5}' demo
like_demo '{"fog_density_per_m": 0.02}' fog

# draw NAME OPTION...: within the runs' folder, so that pictures name no temporary one.
draw() {
  local name=$1 view=$PWD/build/release/viewer/railcast-view image=$PWD/docs/images/$1.png
  shift
  (cd "$runs" && xvfb-run --auto-servernum --server-args="-noreset -screen 0 1920x1080x24" \
    "$view" --screenshot "$image" "$@" > "$name.txt")
}
draw view_label demo --frame 20 --camera driver
draw view_overlays demo --frame 36 --camera driver --color-by range \
  --show surfaces,boxes,track,gauge
draw view_compare demo --compare fog --frame 32 --show boxes,empty-beams --color-by power \
  --color-range 1,20
draw view_noise demo --frame 40 --camera top --accumulate 32 --color-by noise
draw view_trace demo --frame 20 --camera driver --select person,wagon \
  --pick 668,352 --pick 761,431 --trace
ls -l docs/images/view_*.png
