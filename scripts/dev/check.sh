#!/usr/bin/env bash
# Runs the checks that a change must pass before it is merged.
#
#   check.sh            format, architecture, links, build, tests, programs and fuzzers with clang
#   check.sh --fast     format, architecture and links of the docs only: seconds, no build
#   check.sh --tidy     all of the above, and clang-tidy over the sources that differ from main
#   check.sh --tidy-all as --tidy, over every source: takes an hour
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source scripts/packages.sh

usage() {
  sed -n '2,/^set /{/^# \?/s///p}' "${BASH_SOURCE[0]}"
}

check_format() {
  echo "== format"
  local unformatted
  unformatted=$(git ls-files --cached --others --exclude-standard '*.h' '*.cpp' |
    xargs --no-run-if-empty clang-format-14 --dry-run 2>&1 |
    sed -n 's/^\([^:]*\):[0-9]*:[0-9]*: .*clang-format.*/\1/p' | sort --unique)
  if [[ -n "$unformatted" ]]; then
    printf 'error: run clang-format-14 -i %s\n' "${unformatted//$'\n'/ }" >&2
    return 1
  fi
}

check_architecture() {
  echo "== architecture"
  scripts/dev/lint_architecture.py
  python3 -B scripts/dev/lint_budget.py
}

check_docs() {
  echo "== docs"
  scripts/dev/lint_docs.py
}

# configure_tidy FOLDER CMAKE-OPTION...
configure_tidy() {
  echo "== clang-tidy"
  cmake -B "$@" -G Ninja --log-level=ERROR -D CMAKE_C_COMPILER=clang-19 -D CMAKE_CXX_COMPILER=clang++-19 \
    -D CMAKE_BUILD_TYPE=RelWithDebInfo -D CMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null
}

# run_tidy FOLDER OPTION...: runs clang-tidy over the sources that it reads.
run_tidy() {
  xargs --no-run-if-empty --max-args=1 --max-procs="$(nproc)" \
    clang-tidy-19 --quiet -p "$@" 2> >(grep -v ' warnings\? generated' >&2)
}

# Runs clang-tidy over those sources that differ from main, with each compiled by clang on its own, including its headers.
check_tidy() {
  configure_tidy build/tidy
  changed_sources | sort --unique | while read -r file; do
    if [[ -f "$file" ]] && grep --quiet --fixed-strings "\"$PWD/$file\"" \
      build/tidy/compile_commands.json; then
      echo "$file"
    fi
  done | run_tidy build/tidy
}

# Runs clang-tidy over every source, 16 as one: most of the time is spent on headers.
check_tidy_all() {
  configure_tidy build/tidy_all -D CMAKE_UNITY_BUILD=ON -D CMAKE_UNITY_BUILD_BATCH_SIZE=16
  ninja -C build/tidy_all -t targets all | sed -n 's/^\(.*\(\.pb\.h\|\/version\.cpp\)\): .*/\1/p' |
    xargs ninja -C build/tidy_all --quiet
  cp tests/.clang-tidy build/tidy_all/tests
  sed -n 's/^ *"file": "\(.*\)".*/\1/p' build/tidy_all/compile_commands.json |
    grep --extended-regexp --invert-match '^/usr/|_verify_interface_header_sets/|/shipped_files\.cpp$|\.pb\.cc$' | sort --unique |
    run_tidy build/tidy_all --checks=-bugprone-suspicious-include \
      --header-filter='/(core|generator|analysis|viewer|tests|examples)/'
}

# Compiles the programs with clang, with warnings as errors, and the fuzzers, which need it. The tests beside these
# replay the corpora with the address and undefined-behaviour sanitizers.
check_clang() {
  echo "== clang"
  cmake -B build/clang -G Ninja --log-level=ERROR -D CMAKE_C_COMPILER=clang-19 \
    -D CMAKE_CXX_COMPILER=clang++-19 -D CMAKE_CXX_FLAGS=-O0 -D CMAKE_UNITY_BUILD=ON \
    -D CMAKE_COMPILE_WARNING_AS_ERROR=ON -D RAILCAST_BUILD_TESTS=OFF >/dev/null
  cmake --build build/clang
  cmake -B build/fuzz -G Ninja --log-level=ERROR -D CMAKE_C_COMPILER=clang-19 \
    -D CMAKE_CXX_COMPILER=clang++-19 -D RAILCAST_BUILD_FUZZERS=ON >/dev/null
  cmake --build build/fuzz --target fuzzers
  ctest --test-dir build/fuzz/tests/fuzz --output-on-failure --parallel "$(nproc)"
}

changed_sources() {
  git diff --name-only "$(git merge-base main HEAD)" -- '*.cpp'
  git ls-files --others --exclude-standard '*.cpp'
}

mode="${1:-}"
case "$mode" in
  "" | --fast | --tidy | --tidy-all) ;;
  --help)
    usage
    exit
    ;;
  *)
    usage >&2
    exit 2
    ;;
esac

install_packages "${check_packages[@]}"
check_format
check_architecture
check_docs
if [[ "$mode" == --fast ]]; then
  exit
fi
echo "== build and tests"
scripts/test.sh
check_clang
case "$mode" in
  --tidy) check_tidy ;;
  --tidy-all) check_tidy_all ;;
esac
echo "All checks passed."
