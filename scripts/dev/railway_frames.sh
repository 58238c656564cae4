#!/usr/bin/env bash
# Compares real frames of railways with simulated ones, and writes the tables and pictures of docs/results/railway.md.
# The frames have no licence: figures measured on them may be published, they themselves may not.
#
# Usage: scripts/dev/railway_frames.sh FOLDER [BUILD_DIR]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
folder=${1:?usage: scripts/dev/railway_frames.sh FOLDER [BUILD_DIR]}
if [[ ! -d $folder ]]; then
  echo "railway_frames.sh: skipped, because there is no folder $folder"
  exit 0
fi
exec /usr/bin/python3 "$root/scripts/dev/railway_frames.py" "$folder" "${2:-$root/build/release}"
