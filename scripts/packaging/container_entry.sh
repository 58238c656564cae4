#!/bin/sh
# What an image of railcast runs: `generate ...` is railcast-generate, `analyze ...` railcast-analyze.
case "$1" in
  generate | analyze)
    program=railcast-$1
    shift
    exec "$program" "$@"
    ;;
esac
echo "railcast: the first word must be generate or analyze (got \"$1\")" >&2
exit 2
