#!/usr/bin/env bash
# Makes the Debian packages of a build, checks them with lintian, installs them into an empty Debian 12, runs the main job
# there without a compiler, removes them and looks for what is left: debian_test.sh SOURCE_DIR BUILD_DIR WORK_DIR.
# Exits with 77, which skips the test, where no empty Debian can be made.
set -euo pipefail
# The mounts below vanish with this process, however it ends.
if [[ -z "${RAILCAST_OWN_MOUNTS:-}" ]] && ((EUID == 0)); then
  if ! unshare --mount true 2>/dev/null; then
    echo "skipped: no mounts of its own are allowed here"
    exit 77
  fi
  RAILCAST_OWN_MOUNTS=yes exec unshare --mount "$0" "$@"
fi
source_dir=$1 build=$2 work=$3

skip() {
  echo "skipped: $*"
  exit 77
}
fail() {
  echo "failed: $*" >&2
  exit 1
}

((EUID == 0)) || skip "only root can make an empty Debian"
for tool in debootstrap lintian dpkg-shlibdeps; do
  command -v "$tool" >/dev/null || skip "$tool is not installed"
done
(
  # shellcheck source=/dev/null
  source /etc/os-release
  [[ "${VERSION_CODENAME:-}" == bookworm ]]
) || skip "the packages of this system are not for Debian 12"

root=$work/root
rm -rf --one-file-system "$work"
mkdir -p "$work"

"$source_dir/scripts/package.sh" "$build"
packages=("$build"/packages/*.deb)
for package in railcast railcast-extras railcast-import railcast-viewer python3-railcast railcast-dev railcast-all; do
  compgen -G "$build/packages/${package}_*.deb" >/dev/null || fail "there is no package $package"
done

# The folder is thrown away: dpkg need not wait until each file is on the disk.
export DPKG_FORCE=unsafe-io
debootstrap --variant=minbase bookworm "$root" http://deb.debian.org/debian >"$work/debootstrap.log" 2>&1 ||
  skip "debootstrap: $(tail -1 "$work/debootstrap.log")"
tar -C "$root" --exclude='./var/cache/apt/archives/*' -cf "$work/debian.tar" .  # For container_test.sh.
mount -t proc proc "$root/proc" && mount --bind /dev "$root/dev" && mount --bind /dev/pts "$root/dev/pts" ||
  skip "nothing can be mounted here"
mkdir "$root/packages"
cp "${packages[@]}" "$root/packages"
inside() {
  chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive DPKG_FORCE=unsafe-io "$@"
}
inside apt-get update -q >"$work/apt.log" || skip "apt-get update: $(tail -1 "$work/apt.log")"
# The programs alone: no library of VTK or GDAL comes with them, and of PCL those without VTK.
num_packages() {
  inside dpkg-query -W | wc -l
}
num_before=$(num_packages)
inside sh -c 'apt-get install -q -y --no-install-recommends /packages/railcast_*.deb' >>"$work/apt.log" 2>&1 ||
  fail "railcast is not installed: see $work/apt.log"
echo "railcast brings $(($(num_packages) - num_before - 1)) packages"
(($(num_packages) - num_before <= 30)) || fail "railcast brings too many packages"
if inside dpkg-query -W -f='${Package}\n' | grep -E '^lib(pcl-(io|visualization)|vtk|gdal|sqlite|ddsc|cyclonedds|protobuf|pcap)'; then fail "railcast needs these packages"; fi
scenarios=/usr/share/railcast/scenarios
inside railcast-generate sequence "$scenarios/st_gallen_approach.json" --out /root/demo --frames 2
inside railcast-analyze verify /root/demo
inside railcast-analyze stats /root/demo --format text >"$work/stats.txt"
grep -q "person" "$work/stats.txt" || fail "stats does not mention the person: see $work/stats.txt"
says_what_it_lacks() {
  local extra=$1 said
  shift
  said=$(inside "$@" 2>&1) && fail "$* ran without its package"
  [[ "$said" == *"needs the extra $extra, which is not installed (Debian package railcast-$extra;"* ]] || fail "$* said: $said"
}
says_what_it_lacks import railcast-generate import map.osm --out /root/lines
says_what_it_lacks ros railcast-generate sequence "$scenarios/minimal.json" --out /root/bag --format mcap
says_what_it_lacks insert railcast-generate insert /root/demo plan.json --out /root/inserted
says_what_it_lacks study railcast-analyze study study.json --out /root/study
for page in railcast-generate railcast-generate-sequence railcast-analyze-stats; do
  zcat "$root/usr/share/man/man1/$page.1.gz" | grep -q '^\.SH NAME' || fail "$page has no manual page"
done
inside bash -c 'source /usr/share/bash-completion/completions/railcast-generate
  COMP_WORDS=(railcast-generate seq) COMP_CWORD=1; _railcast_generate; [[ "${COMPREPLY[*]}" == sequence ]]' ||
  fail "bash completes nothing"

# All others.
inside sh -c 'apt-get install -q -y --no-install-recommends xvfb xauth /packages/*.deb' >>"$work/apt.log" 2>&1 ||
  fail "the packages are not installed: see $work/apt.log"
inside xvfb-run --auto-servernum railcast-view /root/demo --frame 1 --camera driver --color-by label \
  --size 640x360 --screenshot /root/demo.png
(($(stat -c %s "$root/root/demo.png") > 20000)) || fail "the viewer's picture is empty"
inside python3 -c "
import railcast
frame = railcast.Simulator(railcast.SCENARIOS / 'st_gallen_approach.json').scan(30)
assert len(frame.points()) > 1000
print(railcast.__file__)" | grep -qx /usr/lib/python3/dist-packages/railcast/__init__.py || fail "python3-railcast"
inside railcast-generate sequence "$scenarios/minimal.json" --out /root/bag --frames 1 --format mcap
inside railcast-analyze stats /root/bag --format text >/dev/null
inside railcast-analyze study --help | grep -q '^Simulate the approaches' || fail "study does not run"
inside railcast-generate import --help | grep -q '^Fit the lines of a map' || fail "import does not run"

# An example is compiled against railcast-dev.
inside apt-get install -q -y --no-install-recommends cmake g++ make >>"$work/apt.log" 2>&1 || fail "see $work/apt.log"
mkdir "$root/root/example"
cp "$source_dir/examples/simulate_frame.cpp" "$root/root/example"
cat >"$root/root/example/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(example LANGUAGES C CXX)
find_package(railcast 1.0 REQUIRED)
add_executable(simulate_frame simulate_frame.cpp)
target_link_libraries(simulate_frame PRIVATE railcast::core)
CMAKE
inside sh -c 'cd /root/example && cmake -B build . && cmake --build build' >"$work/example.log" 2>&1 ||
  fail "$(tail -20 "$work/example.log")"
inside /root/example/build/simulate_frame "$scenarios/minimal.json"

inside sh -c 'apt-get purge -q -y "*railcast*"' >>"$work/apt.log" 2>&1 || fail "purge: see $work/apt.log"
left=$(inside find / -xdev -iname '*railcast*' -not -path '/packages/*' -not -path '/root/*' -not -path '/var/log/*')
[[ -z "$left" ]] || fail "removing the packages left: $left"
echo "passed"
