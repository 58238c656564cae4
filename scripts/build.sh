#!/usr/bin/env bash
# Installs what the build needs, then builds: build.sh [TARGET...], default all. RAILCAST_PRESET names
# the preset, default release.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

preset=${RAILCAST_PRESET:-release}

install_packages "${build_packages[@]}"

launcher=()
if command -v ccache >/dev/null; then
  # ccache cannot cache what is compiled with precompiled headers.
  launcher=(-D CMAKE_C_COMPILER_LAUNCHER=ccache -D CMAKE_CXX_COMPILER_LAUNCHER=ccache
    -D CMAKE_DISABLE_PRECOMPILE_HEADERS=ON)
fi
cmake --preset "$preset" "${launcher[@]}"
cmake --build --preset "$preset" --target "${@:-all}"
