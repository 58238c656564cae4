#!/usr/bin/env bash
# Installs what is missing, builds everything, compiles every public header alone and runs every
# test: test.sh [CTEST OPTION...].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

install_packages "${build_packages[@]}" "${test_packages[@]}"
scripts/build.sh all all_verify_interface_header_sets
ctest --preset release --parallel "$(nproc)" "$@"
