#!/usr/bin/env bash
# Lints the Containerfile, and builds its second stage where buildah is installed: of the packages and the empty Debian
# that debian_test.sh has made, because no registry of images can be reached: container_test.sh SOURCE_DIR BUILD_DIR
# WORK_DIR. Exits with 77, which skips the test, where neither is possible.
set -euo pipefail
source_dir=$1 build=$2 work=$3
containerfile=$source_dir/scripts/packaging/Containerfile
debian=$(dirname "$work")/debian/debian.tar

fail() {
  echo "failed: $*" >&2
  exit 1
}

is_tested=false
linter=${NODE_PATH:-}/.bin/dockerfile-utils
if [[ -x "$linter" ]]; then
  [[ -z "$("$linter" lint "$containerfile")" ]] || fail "$("$linter" lint "$containerfile")"
  # It finds what it should.
  printf 'FROM debian\nEXPOSE none\n' >"${TMPDIR:-/tmp}/Containerfile.$$"
  [[ -n "$("$linter" lint "${TMPDIR:-/tmp}/Containerfile.$$")" ]] || fail "the linter finds no fault"
  rm "${TMPDIR:-/tmp}/Containerfile.$$"
  is_tested=true
fi

export BUILDAH_ISOLATION=chroot STORAGE_DRIVER=vfs
if ((EUID == 0)) && command -v buildah >/dev/null && [[ -e "$debian" ]]; then
  rm -rf "$work"
  mkdir -p "$work/context/scripts/packaging" "$work/context/packages"
  buildah="buildah --root $work/storage --runroot $work/run"
  trap '$buildah umount --all >/dev/null 2>&1 || true; rm -rf "$work"' EXIT
  cp "$source_dir/scripts/packaging/container_entry.sh" "$work/context/scripts/packaging"
  cp "$build"/packages/railcast_*.deb "$work/context/packages"
  {
    printf 'FROM scratch AS build\nCOPY packages /railcast/build/package/packages\n'
    sed -n '/^FROM .*bookworm-slim/,$p' "$containerfile"
  } >"$work/context/Containerfile"

  base=$($buildah from scratch) && mounted=$($buildah mount "$base") || {
    echo "skipped: buildah may not make containers here"
    exit 77
  }
  tar -C "$mounted" --exclude="./dev/*" -xf "$debian"
  $buildah umount "$base" >/dev/null
  $buildah commit -q "$base" docker.io/library/debian:bookworm-slim >/dev/null
  $buildah bud --pull=never -f "$work/context/Containerfile" -t railcast "$work/context" >"$work/build.log" 2>&1 ||
    fail "$(tail -20 "$work/build.log")"
  container=$($buildah from --pull=never railcast)
  inside() {
    $buildah run "$container" -- "$@"
  }
  [[ "$(inside id -u)" == 1000 ]] || fail "the image runs as root"
  inside railcast generate sequence /usr/share/railcast/scenarios/minimal.json --out demo --frames 1
  inside railcast analyze verify demo
  status=0
  said=$(inside railcast unknown 2>&1) || status=$?
  [[ "$said" == *'must be generate or analyze (got "unknown")'* ]] && ((status != 0)) || fail "unknown: $said"
  if inside sh -c 'command -v c++ || command -v cmake'; then fail "the image has a compiler"; fi
  is_tested=true
fi
$is_tested || {
  echo "skipped: neither dockerfile-utils (npm) nor buildah is installed"
  exit 77
}
echo passed
