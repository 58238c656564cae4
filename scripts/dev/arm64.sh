#!/usr/bin/env bash
# Compiles the core for ARM64 and runs the tests of detect and trace there, by emulation: arm64.sh BUILD_DIR. Then
# compares what these tests computed, byte by byte, with what those of BUILD_DIR compute on this machine. Installs the
# cross compiler; takes 15 minutes on two cores, most of them for compiling. Everything is in build/arm64.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source scripts/packages.sh

build=${1:?the build directory of this machine is missing}
tests=(detect_test trace_test)
cross=$PWD/build/arm64
install_packages "${cross_packages[@]}"

root=$cross/root
if [[ ! -e "$root.done" ]]; then
  rm -rf "$root"
  mkdir -p "$cross"
  # Unpacked only: nothing of it runs but by the emulator.
  libraries=("${core_packages[@]}" libc6-dev libstdc++-12-dev)
  mmdebstrap --architectures=arm64 --variant=extract --include="$(IFS=, && echo "${libraries[*]}")" \
    bookworm "$root"
  touch "$root.done"
fi
cmake -S . -B "$cross/build" -G Ninja --toolchain "$PWD/scripts/dev/arm64.cmake" -D CMAKE_BUILD_TYPE=Release \
  -D CMAKE_UNITY_BUILD=ON -D RAILCAST_BUILD_IO=OFF \
  -D RAILCAST_BUILD_ASSIMP=OFF -D RAILCAST_BUILD_VIEWER=OFF -D CMAKE_DISABLE_FIND_PACKAGE_pybind11=ON \
  -D RAILCAST_BUILD_BENCHMARKS=OFF
cmake --build "$cross/build" --target "${tests[@]}"

# The recorded bytes of a test's results, a line each.
recorded() {
  grep -oE '<testcase name="[^"]*"|<property name="bytes_of_[^>]*' "$1" |
    awk '/^<testcase/ {test = $0; next} {print test, $0}'
}

for test in "${tests[@]}"; do
  here=$(find "$build/tests" -name "$test" -type f -executable)
  there=$(find "$cross/build/tests" -name "$test" -type f -executable)
  # The emulator does not keep the limits on memory that one test sets.
  qemu-aarch64 -L "$root" "$there" --gtest_brief=1 --gtest_filter=-OutOfMemory* \
    --gtest_output="xml:$cross/$test.arm64.xml"
  "$here" --gtest_brief=1 --gtest_filter=-OutOfMemory* --gtest_output="xml:$cross/$test.xml" >/dev/null
  recorded "$cross/$test.xml" >"$cross/$test.bytes"
  recorded "$cross/$test.arm64.xml" >"$cross/$test.arm64.bytes"
  [[ -s "$cross/$test.bytes" ]] || { echo "error: $here records no bytes" >&2; exit 1; }
  diff "$cross/$test.bytes" "$cross/$test.arm64.bytes"
  echo "$test: passed on ARM64, with the same bytes in $(wc -l <"$cross/$test.bytes") results"
done
