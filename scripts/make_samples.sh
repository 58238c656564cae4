#!/usr/bin/env bash
# Makes the sample data sets: make_samples.sh [BUILD_DIR [OUT_DIR]]. Without BUILD_DIR, installs missing packages and
# builds. OUT_DIR, out/samples if left out, is made anew. Three recipes make about 20 MB: persons beside a track (PCD), an approach in random weather (compressed
# PCD) and a level crossing (MCAP bags of ROS 2). Each has its card beside it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

build=${1:-build/release}
if (($# == 0)); then
  install_packages "${build_packages[@]}"
  scripts/build.sh railcast-generate railcast-analyze
fi
# Bytes depend on the instruction set; every x86-64 processor has this one.
isa=sse2
out=${2:-out/samples}
rm -rf "$out"

# sample NAME RECIPE [OPTION...]
sample() {
  local name=$1 recipe=scenarios/recipes/$2
  shift 2
  "$build/generator/railcast-generate" dataset "$recipe" --out "$out/$name/$name" --isa "$isa" "$@"
  "$build/analysis/railcast-analyze" verify "$out/$name/$name"
  "$build/analysis/railcast-analyze" card "$out/$name/$name" --licence MIT --out "$out/$name"
}
fields=x,y,z,intensity,ring,label,instance
sample persons small.json
sample weather weather_sample.json --format pcd-compressed --fields "$fields"
sample crossing crossing_sample.json --format mcap --fields "$fields"

echo
echo "Data sets and their cards (README.md, report.html):"
du -sh --apparent-size "$out"/*/
