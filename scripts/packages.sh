# The Debian 12 packages that railcast needs, in one place. To be sourced by bash.
# shellcheck shell=bash disable=SC2034  # The lists are for the scripts that source this.

# To configure and build every target. The tests' libraries are here because the presets build
# the tests; libpcl-dev and libvtk9-dev are nine tenths of the download.
build_packages=(
  cmake
  g++
  git  # The version names the commit.
  libbenchmark-dev
  libboost-dev
  libcli11-dev
  libeigen3-dev
  libembree-dev
  libexpat1-dev
  libgmock-dev
  libgtest-dev
  libopenmesh-dev
  libpcap-dev
  libpcl-dev
  librandom123-dev
  libtbb-dev
  libvtk9-dev
  libx11-dev
  libxxhash-dev
  ninja-build
  nlohmann-json3-dev
  pkg-config
  zlib1g-dev
)

# To draw pictures on a machine without a display.
display_packages=(
  gnuplot-nox
  xauth
  xvfb
)

# What the tests call: readers and validators that are not ours, and a hand for the viewer's window.
test_packages=(
  "${display_packages[@]}"
  chromium
  poppler-utils
  python3
  python3-jsonschema
  python3-numpy
  python3-open3d
  python3-yaml
  tshark
  xdotool
)

# What scripts/check.sh calls.
check_packages=(
  clang-14
  clang-format-14
  clang-tidy-14
  git
)

# install_packages PACKAGE...: installs those that are missing; asks apt nothing if none is.
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
  "${as_root[@]}" apt-get update -q
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -q -y --no-install-recommends "${missing[@]}"
}
