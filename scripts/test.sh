#!/usr/bin/env bash
# Installs missing packages, builds everything and runs the tests of what has changed: test.sh [--all] [--keep]
# [CTEST OPTION...]. RAILCAST_PRESET names the preset, default release. At the end it names the tests that were skipped, with
# their reasons, the slowest, and those over their budget of time.
#
#   --all   also the tests of packages, pages, folders, damaged inputs and stability, and of headers compiled on their
#           own, which else run where what they depend on has changed since they passed (tests/where_changed.py)
#   --keep  says in tests/passed.json which of those passed, to be committed
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
while [[ "${1:-}" == --all || "${1:-}" == --keep ]]; do
  case "$1" in
    --all) export RAILCAST_TRY_ALL=1 ;;
    --keep) export RAILCAST_KEEP=1 ;;
  esac
  shift
done
source scripts/packages.sh

install_packages "${build_packages[@]}" "${test_packages[@]}"
targets=(all)
if tests/where_changed.py --is-due Headers.CompileOnTheirOwn; then
  targets+=(all_verify_interface_header_sets)
fi
scripts/build.sh "${targets[@]}"
if [[ -n "${RAILCAST_KEEP:-}" && "${#targets[@]}" -eq 2 ]]; then
  tests/where_changed.py --keep Headers.CompileOnTheirOwn
fi
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
