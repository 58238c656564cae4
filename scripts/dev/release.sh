#!/usr/bin/env bash
# Makes a release of the present commit, or says what stands against it: release.sh [--check].
#
# Checks that nothing is uncommitted, that CHANGELOG.md, CITATION.cff and docs/results/results.json are of the version, and that
# what the release before wrote is kept in tests/releases; runs all tests; makes packages, wheel, samples and site
# in out/release, with their sums; and sets the tag. --check stops after the checks, which take a second.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

number=$(sed -nE 's/^project\(railcast VERSION ([0-9.]+).*/\1/p' CMakeLists.txt)
version=$number$(sed -nE 's/^set\(RAILCAST_PRERELEASE "(.*)"\)/\1/p' CMakeLists.txt)
faults=0
fault() {
  echo "release.sh: $*" >&2
  faults=$((faults + 1))
}

[[ -z "$(git status --porcelain)" ]] || fault "there are changes that are not committed"
if git rev-parse -q --verify "refs/tags/v$version" >/dev/null; then fault "the tag v$version exists already"; fi
newest=$(sed -nE 's/^## (.*)/\1/p' CHANGELOG.md | head -1)
[[ "$newest" == "$version" ]] || fault "CHANGELOG.md begins with $newest (must be $version)"
cited=$(sed -nE 's/^version: (.*)/\1/p' CITATION.cff)
[[ "$cited" == "$version" ]] || fault "CITATION.cff has the version $cited (must be $version)"
before=$(sed -nE 's/^## ([0-9.]+)$/\1/p' CHANGELOG.md | grep -vxF "$version" | head -1)
[[ -d "tests/releases/$before" ]] ||
  fault "tests/releases lacks $before: check that release out, build it, and run scripts/dev/keep_release.py BUILD"
scripts/dev/results.py check >/dev/null 2>&1 ||
  fault "the pages do not have the figures of docs/results/results.json: run scripts/dev/results.py"
if ((faults > 0)); then exit 1; fi
echo "nothing stands against releasing $version"
if [[ "${1:-}" == --check ]]; then exit; fi

scripts/test.sh --all
RAILCAST_PRESET=package scripts/build.sh installed
# Makes the packages, too. A test that is skipped ends with 77, and so does this script.
tests/package/debian_test.sh "$PWD" "$PWD/build/package" "$PWD/build/package/debian"
tests/package/container_test.sh "$PWD" "$PWD/build/package" "$PWD/build/package/container"
out=out/release
rm -rf "$out"
mkdir -p "$out"
cp build/package/packages/*.deb "$out"
python=/usr/bin/python3
"$python" -m pip wheel . --no-deps --no-index --config-settings build-dir="$PWD/build/package" --wheel-dir "$out"
scripts/make_samples.sh build/package
tar -C out -czf "$out/railcast-$version-samples.tar.gz" samples
scripts/make_site.sh build/package
tar -C build/package -czf "$out/railcast-$version-site.tar.gz" site
git archive --prefix "railcast-$version/" -o "$out/railcast-$version.tar.gz" HEAD
(cd "$out" && sha256sum -- * >SHA256SUMS)
git tag -a "v$version" -m "railcast $version"
echo "$PWD/$out: to be published with the tag v$version"
