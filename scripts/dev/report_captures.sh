#!/usr/bin/env bash
# The statistics of four real sensors' captures, kept in docs/reports (see docs/validation.md).
# Usage: scripts/dev/report_captures.sh CAPTURES [BUILD]
#   CAPTURES  folder with vlp16_dual.pcap, vlp32c_single.pcap, pandar64.pcap and vls128_single.pcap
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/../.."
captures=${1:?usage: scripts/dev/report_captures.sh CAPTURES [BUILD]}
build=${2:-build/release}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p docs/reports
for capture in vlp16_dual vlp32c_single pandar64 vls128_single; do
  # Link without a folder, since the page states its source.
  ln -s "$(realpath "$captures/$capture.pcap")" "$scratch/$capture.pcap"
  (cd "$scratch" && "$OLDPWD/$build/analysis/railcast-analyze" stats "$capture.pcap" --out out)
  cp "$scratch/out/report.html" "docs/reports/$capture.html"
done
