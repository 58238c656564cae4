#!/usr/bin/env bash
# Runs the tests under the thread sanitizer: tsan.sh [CTEST OPTION...].
#
# Debian's TBB is not instrumented, so that everything TBB synchronizes looks like a race, and
# suppressing whatever passes through TBB would hide railcast's own races, too. Therefore Debian's
# source of TBB is built with the sanitizer into build/tsan_tbb and takes precedence over the
# system's.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source scripts/packages.sh

install_packages "${build_packages[@]}" "${test_packages[@]}" xz-utils

tbb=$PWD/build/tsan_tbb
if [[ ! -e $tbb/lib_relwithdebinfo/libtbb.so ]]; then
  mkdir -p "$tbb/lists/partial"
  echo "deb-src http://deb.debian.org/debian bookworm main" >"$tbb/sources.list"
  private_apt=(apt-get -q -o "Dir::Etc::SourceList=$tbb/sources.list" -o Dir::Etc::SourceParts=/dev/null
    -o "Dir::State::Lists=$tbb/lists" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache=)
  "${private_apt[@]}" update
  (cd "$tbb" && "${private_apt[@]}" source --download-only onetbb && tar -xf onetbb_*.orig.tar.xz)
  cmake -S "$tbb"/oneTBB-* -B "$tbb" -G Ninja -D CMAKE_BUILD_TYPE=RelWithDebInfo -D TBB_TEST=OFF \
    -D TBB_STRICT=OFF -D TBB_SANITIZE=thread -D TBB_OUTPUT_DIR_BASE=lib
  cmake --build "$tbb" --target tbb
fi

cmake --preset tsan
cmake --build --preset tsan
LD_LIBRARY_PATH=$tbb/lib_relwithdebinfo ctest --preset tsan "$@"
