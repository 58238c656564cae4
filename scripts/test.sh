#!/usr/bin/env bash
# Installs missing packages, builds everything, compiles every public header on its own and runs all
# tests: test.sh [CTEST OPTION...]. RAILCAST_PRESET names the preset, default release. At the end it names the
# tests that were skipped, with their reasons, and the slowest.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

install_packages "${build_packages[@]}" "${test_packages[@]}"
scripts/build.sh all all_verify_interface_header_sets
preset=${RAILCAST_PRESET:-release}
results="$PWD/build/$preset/Testing/results"
rm -rf "$results"
status=0
# A test of ctest may be a program of many tests.
GTEST_OUTPUT="xml:$results/" ctest --preset "$preset" --parallel "$(nproc)" "$@" || status=$?
scripts/dev/summarize_tests.py "$results"
exit "$status"
