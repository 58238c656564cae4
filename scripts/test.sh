#!/usr/bin/env bash
# Installs missing packages, builds everything, compiles every public header on its own and runs all
# tests: test.sh [CTEST OPTION...]. RAILCAST_PRESET names the preset, default release.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

install_packages "${build_packages[@]}" "${test_packages[@]}"
scripts/build.sh all all_verify_interface_header_sets
preset=${RAILCAST_PRESET:-release}
ctest --preset "$preset" --parallel "$(nproc)" "$@"
# A test of ctest may be a program of many tests.
awk '/^\[  PASSED  \] / { num += $4 } END { print num + 0, "tests of the test programs passed" }' \
  "build/$preset/Testing/Temporary/LastTest.log"
