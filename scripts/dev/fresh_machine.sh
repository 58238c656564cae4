#!/usr/bin/env bash
# Proves that the scripts install all that a bare machine needs: makes a minimal Debian 12 in
# FOLDER, clones the committed state into it and runs a command there.
#
#   fresh_machine.sh FOLDER [COMMAND...]     default: scripts/test.sh
#
# Needs root, debootstrap and about 8 GB; FOLDER must not exist and is left for inspection.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

if (($# == 0)) || [[ -e "$1" ]]; then
  echo "usage: fresh_machine.sh FOLDER [COMMAND...]; FOLDER must not exist" >&2
  exit 2
fi
folder=$(realpath --canonicalize-missing "$1")
shift

debootstrap --variant=minbase bookworm "$folder"
# Use the host's package sources and proxy.
apt-config dump | grep '^Acquire::https\?::' >"$folder/etc/apt/apt.conf.d/99host" || true
git clone --quiet --no-hardlinks . "$folder/railcast"

# The mounts vanish with the namespace.
# shellcheck disable=SC2016  # Expanded by the inner shells.
unshare --mount --pid --fork bash -euc '
  mount --bind "$0" "$0"  # As on a machine, / is mounted.
  mount -t proc proc "$0/proc"
  mount --rbind /sys "$0/sys"
  mount --rbind /dev "$0/dev"
  exec chroot "$0" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
    bash -euc '\''cd /railcast && "$@"'\'' -- "$@"' "$folder" "${@:-scripts/test.sh}"
