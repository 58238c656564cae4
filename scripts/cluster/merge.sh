#!/usr/bin/env bash
# The last job of submit.sh: merges the shards, which names those that are missing, and verifies the
# data set. Files are links to those of the shards where the file system allows it.
#
#   merge.sh BUILD OUT SHARDS
set -euo pipefail
build=$1
out=$2
shards=()
for i in $(seq "$3"); do shards+=("$out.shards/$i"); done
"$build/generator/railcast-generate" merge "${shards[@]}" --out "$out"
"$build/analysis/railcast-analyze" verify "$out"
