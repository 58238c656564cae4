#!/usr/bin/env bash
# Installs missing packages, builds everything, compiles every public header on its own and runs all
# tests: test.sh [CTEST OPTION...].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

install_packages "${build_packages[@]}" "${test_packages[@]}"
scripts/build.sh all all_verify_interface_header_sets
ctest --preset release --parallel "$(nproc)" "$@"
