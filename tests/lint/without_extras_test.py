"""Configures the tree as scripts/dev/without_extras.sh leaves it: without any extra, and with one and those that it uses.

Usage: without_extras_test.py TREE
"""

import pathlib
import subprocess
import sys
import tempfile

TREE = pathlib.Path(sys.argv[1])


def options_without(*kept):
    """The options of extras that a tree with those in `kept` has."""
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / "tree"
        subprocess.run([TREE / "scripts/dev/without_extras.sh", "--configure", copy, *kept], check=True)
        names = {path.name for path in TREE.glob("*/extras/*") if path.is_dir()}
        cache = (copy / "build/CMakeCache.txt").read_text(encoding="utf-8")
        return {name for name in names if f"RAILCAST_BUILD_{name.upper()}:BOOL=ON" in cache}


assert options_without() == set(), options_without()
study = options_without("core/recipe", "analysis/detectors", "analysis/rare", "analysis/study")
assert study == {"recipe", "detectors", "rare", "study"}, study
