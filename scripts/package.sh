#!/usr/bin/env bash
# Makes the Debian packages railcast, railcast-extras, railcast-import, railcast-viewer, python3-railcast, railcast-dev and
# railcast-all, and checks them with lintian: package.sh [BUILD_DIR]. Without BUILD_DIR, installs missing packages and
# builds the preset `package`.
# The packages are written to BUILD_DIR/packages.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source scripts/packages.sh

build=${1:-build/package}
install_packages "${build_packages[@]}" "${package_packages[@]}" "${python_packages[@]}"
if (($# == 0)); then
  RAILCAST_PRESET=package scripts/build.sh installed
fi
rm -rf "$build/packages"
(cd "$build" && cpack -G DEB >cpack.log) || {
  cat "$build/cpack.log" >&2
  exit 1
}
rm -rf "$build/packages/_CPack_Packages"
lintian --allow-root --fail-on error,warning --tag-display-limit 0 "$build"/packages/*.deb
ls -l "$build"/packages/*.deb
