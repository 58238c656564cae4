#!/usr/bin/env bash
# Makes the sample data sets: make_samples.sh [BUILD_DIR [OUT_DIR]]. Without BUILD_DIR, installs missing packages and
# builds. Three recipes make about 20 MB: persons on and beside a track (PCD), an approach in random weather
# (compressed PCD) and a level crossing (MCAP bags of ROS 2). Each has its card beside it. OUT_DIR is out/samples if left
# out; its folders persons, weather and crossing are made anew.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

build=${1:-build/release}
if (($# == 0)); then
  install_packages "${display_packages[@]}"
  scripts/build.sh railcast-generate railcast-analyze
fi
# Bytes depend on the instruction set; every x86-64 processor has this one.
isa=sse2
out=${2:-out/samples}
for program in "$build/generator/railcast-generate" "$build/analysis/railcast-analyze"; do
  [[ -x "$program" ]] || { echo "error: $program is not there" >&2; exit 1; }
done

# sample NAME RECIPE [OPTION...]
sample() {
  local name=$1 recipe=scenarios/recipes/$2
  shift 2
  rm -rf "${out:?}/$name"
  "$build/generator/railcast-generate" dataset "$recipe" --out "$out/$name/$name" --isa "$isa" "$@"
  "$build/analysis/railcast-analyze" verify "$out/$name/$name"
  "$build/analysis/railcast-analyze" card "$out/$name/$name" --licence MIT --out "$out/$name"
}
fields=x,y,z,intensity,ring,label,instance
sample persons small.json
sample weather weather_sample.json --format pcd-compressed --fields "$fields"
sample crossing crossing_sample.json --format mcap --fields "$fields"
# Of railcast, and of the line of the approach.
cp LICENSE scenarios/alignments/LICENSE.ttobench "$out"

echo
echo "Data sets and their cards (README.md, report.html):"
du -sh --apparent-size "$out"/*/
