#!/usr/bin/env bash
# Installs missing packages, builds everything, compiles every public header on its own and runs all
# tests: test.sh [CTEST OPTION...]. RAILCAST_PRESET names the preset, default release. At the end it names the
# tests that were skipped, with their reasons, the slowest, and those over their budget of time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

install_packages "${build_packages[@]}" "${test_packages[@]}"
scripts/build.sh all all_verify_interface_header_sets
preset=${RAILCAST_PRESET:-release}
results="$PWD/build/$preset/Testing/results"
# Foxglove's readers of bags are not in Debian. Where npm or its registry is missing, the tests that
# call them are skipped.
if command -v npm >/dev/null; then
  readers="$PWD/build/bag_readers"
  mkdir -p "$readers"
  cp tests/generator/extras/package.json "$readers"
  npm install --prefix "$readers" --no-audit --no-fund --no-package-lock --silent ||
    echo "test.sh: npm could not install the readers of bags"
  export NODE_PATH="$readers/node_modules"
fi
rm -rf "$results"
costs="build/$preset/Testing/Temporary/CTestCostData.txt"
if [[ ! -e "$costs" ]]; then
  mkdir -p "$(dirname "$costs")"
  scripts/dev/summarize_tests.py --costs >"$costs"
fi
status=0
ctest --preset "$preset" --parallel "$(nproc)" --output-junit "$(dirname "$results")/ctest.xml" "$@" || status=$?
scripts/dev/summarize_tests.py "$results"
exit "$status"
