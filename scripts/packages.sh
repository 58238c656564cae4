# The Debian 12 packages that railcast needs, in one place. To be sourced by bash.
# shellcheck shell=bash disable=SC2034  # The lists are for the scripts that source this.

# For railcast-generate with its command sequence alone (RAILCAST_STAGE=1).
first_packages=(
  cmake
  g++
  git  # The version string contains the commit.
  libcli11-dev
  libeigen3-dev
  libembree-dev
  libjpeg-dev
  liblzf-dev
  libpng-dev
  librandom123-dev
  libtbb-dev
  libxxhash-dev
  libyaml-cpp-dev
  ninja-build
  nlohmann-json3-dev
  zlib1g-dev
)

# Besides those, for railcast-analyze and railcast-view (RAILCAST_STAGE=2); libpcl-dev and libvtk9-dev are nine tenths of the
# download.
second_packages=(
  libboost-dev
  libkainjow-mustache-dev
  liblz4-dev
  libnlopt-cxx-dev
  libpcl-dev
  libvtk9-dev
  libx11-dev
)

# The libraries of the core and of its tests.
core_packages=(
  libeigen3-dev
  libembree-dev
  libgmock-dev
  libgtest-dev
  libopenmesh-dev
  librandom123-dev
  libtbb-dev
  nlohmann-json3-dev
)

# For configuring and building every target. The tests' libraries are included because the presets build the tests.
build_packages=(
  "${first_packages[@]}"
  "${second_packages[@]}"
  "${core_packages[@]}"
  cyclonedds-dev
  libassimp-dev
  libbenchmark-dev
  libbz2-dev
  libexpat1-dev
  libfastcdr-dev
  libfastrtps-dev
  libgdal-dev
  libosmium2-dev
  libpcap-dev
  libproj-dev
  libprotobuf-dev
  libprotozero-dev
  libsqlite3-dev
  libssl-dev  # SHA-256 of the types of messages.
  libsystemd-dev  # Says to systemd that a stream is ready.
  libzstd-dev
  pkg-config
  protobuf-compiler
  pybind11-dev
  python3-dev
)

# For drawing pictures on a machine without a display.
display_packages=(
  gnuplot-nox
  xauth
  xvfb
)

# Prints dossiers (railcast-analyze dossier).
document_packages=(
  weasyprint
)

# Called by scripts/package.sh.
package_packages=(
  dpkg-dev
  file
  lintian
)

# Called by pip wheel.
wheel_packages=(
  binutils
  patchelf
)

# Imported by the Python module.
python_packages=(
  python3-numpy
)

# Called by scripts/reproduce_paper.sh; scripts/dev/draw_pictures.sh needs them, too.
paper_packages=(
  graphviz
  python3
)

# Called by scripts/make_site.sh.
site_packages=(
  doxygen
  furo
  python3-breathe
  python3-myst-parser
  python3-sphinx
  webp
)

# Called by the tests: independent readers and validators, and a tool that operates the viewer's
# window.
test_packages=(
  "${display_packages[@]}"
  "${document_packages[@]}"
  "${package_packages[@]}"
  "${python_packages[@]}"
  "${site_packages[@]}"
  "${wheel_packages[@]}"
  buildah
  chromium
  crun
  debootstrap
  poppler-utils
  python3
  python3-ipykernel
  python3-jsonschema
  python3-matplotlib
  python3-nbclient
  python3-open3d
  python3-pip
  python3-venv
  python3-yaml
  qemu-user  # Stands for a processor without AVX.
  strace  # Stands for an old kernel.
  tshark
  xdotool
)

# Called by scripts/dev/check.sh.
check_packages=(
  clang-19
  clang-format-14
  clang-tidy-19
  git
  libclang-rt-19-dev  # Sanitizers and libFuzzer.
)

# Called by scripts/dev/arm64.sh.
cross_packages=(
  g++-aarch64-linux-gnu
  mmdebstrap
  qemu-user
)

# Built into railcast-peers by scripts/dev/compare_peers.sh.
peer_packages=(
  libopen3d-dev
)

# install_packages PACKAGE...: installs the missing ones; does not call apt if none is missing.
install_packages() {
  local package missing=()
  for package in "$@"; do
    if [[ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" != installed ]]; then
      missing+=("$package")
    fi
  done
  if ((${#missing[@]} == 0)); then
    return
  fi
  local as_root=()
  if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
      echo "error: not root and no sudo; as root, run: apt-get install ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing ${missing[*]}"
  # After an installation that was killed, apt-get refuses to work until dpkg has been repaired.
  # What dpkg cannot configure for lack of a dependency is left to --fix-broken.
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive dpkg --configure -a || true
  "${as_root[@]}" apt-get update -q
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -q -y --no-install-recommends --fix-broken "${missing[@]}"
}
