#!/usr/bin/env bash
# Builds and tests the tree as it is without its extras: without_extras.sh [--configure] FOLDER [EXTRA...]
#
# Copies the tree into FOLDER, but for builds, outputs and the folders of extras; then configures, builds and runs the
# tests there. Extras that are named, such as core/packets, are kept, and so must be those that they use. With --configure
# nothing is built.
set -euo pipefail
tree=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)

only_configures=
if [[ ${1:-} == --configure ]]; then
  only_configures=1
  shift
fi
if (($# == 0)) || [[ $1 == -* ]]; then
  sed -n '2,/^set /{/^# \?/s///p}' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
folder=$(realpath --canonicalize-missing "$1")
shift
if [[ -e $folder ]]; then
  echo "$folder: must not exist" >&2
  exit 1
fi
kept=$(printf '|%s/' "${@/\///extras/}")
kept=${kept#|}

mkdir -p "$folder"
cd "$tree"
files() {
  find . \( -path ./build -o -path ./out -o -path ./.git \) -prune -o ! -type d -printf '%P\n'
}
{
  files | grep -v -E '^(tests/)?(core|generator|analysis)/extras/'
  if (($# > 0)); then
    files | grep -E "^(tests/)?($kept)|/extras/[^/]*$"
  fi
} | tar -c --files-from - | tar -x --directory "$folder"
cmake -S "$folder" -B "$folder/build" -G Ninja --log-level=NOTICE -D CMAKE_BUILD_TYPE=RelWithDebInfo \
  -D CMAKE_UNITY_BUILD=ON -D CMAKE_UNITY_BUILD_BATCH_SIZE=32 -D CMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -DNDEBUG" \
  -D RAILCAST_TEST_BY_PROGRAM=ON
if [[ -n $only_configures ]]; then
  exit
fi
cmake --build "$folder/build"
# The lints of this tree hold lists and pages that name all of its files, and the test of this script keeps extras.
ctest --test-dir "$folder/build" --output-on-failure --parallel "$(nproc)" --exclude-regex '\.ThisTree|^Extras\.TheProduct'
