#!/usr/bin/env bash
# Makes the statistics of four real sensors' captures in out/captures (see docs/results/validation.md).
# Usage: scripts/dev/report_captures.sh CAPTURES [BUILD]
#   CAPTURES  folder with vlp16_dual.pcap, vlp32c_single.pcap, pandar64.pcap and vls128_single.pcap
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/../.."
captures=${1:?usage: scripts/dev/report_captures.sh CAPTURES [BUILD]}
build=${2:-build/release}

mkdir -p out/captures
for capture in vlp16_dual vlp32c_single pandar64 vls128_single; do
  "$build/analysis/railcast-analyze" stats "$captures/$capture.pcap" --out "out/captures/$capture"
done
