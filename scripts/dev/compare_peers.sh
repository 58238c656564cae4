#!/usr/bin/env bash
# Times other programs' ways of tracing rays beside railcast's, on the demo without plants and then
# with all leaves as triangles: compare_peers.sh [SCENARIO]. Installs and builds what it needs and
# prints two tables in Markdown, for docs/results/embree.md. Takes ten minutes and 10 GB of memory; for
# figures worth quoting nothing else may run on the machine.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source scripts/packages.sh

install_packages "${build_packages[@]}" "${peer_packages[@]}"
cmake --preset release -D RAILCAST_BUILD_PEERS=ON >/dev/null
trap 'cmake --preset release -D RAILCAST_BUILD_PEERS=OFF >/dev/null' EXIT  # For later builds.
cmake --build --preset release --target railcast-peers >/dev/null
build/release/tests/bench/railcast-peers --turns 15 "$@"
echo
build/release/tests/bench/railcast-peers --plants --turns 3 "$@"
