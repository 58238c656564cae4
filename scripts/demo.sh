#!/usr/bin/env bash
# In two stages, from a bare Debian 12: demo.sh [--first]
#   1. installs what `railcast-generate sequence` needs, builds it, simulates 50 frames of an on-sight approach on the
#      St.Gallen - Wil line into out/demo and draws the last of them (out/first.png);
#   2. installs what `railcast-analyze` and `railcast-view` need, builds them, draws a frame (out/demo.png) and analyses
#      all of them (out/stats).
# --first ends after the first stage. What a stage has made stays if the next one is interrupted. All other commands are
# built by scripts/build.sh.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

if (($# > 1)) || [[ "${1:-}" != "" && "$1" != --first ]]; then
  echo "usage: scripts/demo.sh [--first]" >&2
  exit 2
fi
build=build/release

# build_stage NUMBER TARGET...: builds with what the stage needs, or with more if more has been configured here.
build_stage() {
  local configured
  configured=$(sed -n 's/^RAILCAST_STAGE:[A-Z]*=//p' "$build/CMakeCache.txt" 2>/dev/null || echo "$1")
  if [[ -z "$configured" ]]; then
    scripts/build.sh "${@:2}"
    return
  fi
  cmake --preset release -D RAILCAST_STAGE:STRING=$((configured > $1 ? configured : $1))
  cmake --build --preset release --target "${@:2}"
}

# end_stage NUMBER: says how long the stage took.
end_stage() {
  printf '\nStage %d took %d:%02d minutes.\n' "$1" $((SECONDS / 60)) $((SECONDS % 60))
  SECONDS=0
}

SECONDS=0
install_packages "${first_packages[@]}"
build_stage 1 railcast-generate
rm -rf out/demo out/demo.png out/first.png out/stats
mkdir -p out
"$build/generator/railcast-generate" sequence scenarios/st_gallen_approach.json --out out/demo --frames 50 \
  --certify 10% --picture out/first.png
end_stage 1
cat <<TEXT
Look at
  $PWD/out/first.png             the last frame: points in the colours of their labels
  $PWD/out/demo/frames/          50 labelled point clouds, PCD: pcl_viewer, Open3D
  $PWD/out/demo/objects.jsonl    every object's box, points and occlusion, a line per frame
  $PWD/out/demo/poses.csv        where the sensor was
  $PWD/out/demo/manifest.json    version, seed and counts
TEXT
if [[ "${1:-}" == --first ]]; then
  echo "scripts/demo.sh without --first builds the analysis and the viewer, too."
  exit
fi

printf '\nNext, the analysis and the viewer are built; Ctrl-C leaves all of the above as it is.\n\n'
install_packages "${second_packages[@]}" "${display_packages[@]}"
build_stage 2 railcast-analyze railcast-view
xvfb-run --auto-servernum --server-args="-noreset -screen 0 1920x1080x24" \
  "$build/viewer/railcast-view" out/demo --frame 36 --camera driver --color-by label \
  --screenshot out/demo.png
"$build/analysis/railcast-analyze" stats out/demo --out out/stats
end_stage 2
cat <<TEXT
Look at
  $PWD/out/demo.png              frame 36: wagons and a person, points coloured by label
  $PWD/out/stats/report.html     dropout, density, noise, intensity: open it in a browser
scripts/build.sh builds all other commands.
TEXT
