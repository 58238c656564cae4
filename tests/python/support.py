"""What the tests of the Python module share. Run by ctest, which sets RAILCAST_BUILD."""

import os
import pathlib
import subprocess
import sys

SKIPPED = 77  # For ctest.

try:
    import numpy as np
except ImportError:
    print(f"skipped: {sys.executable} has no numpy (python3-numpy)")
    sys.exit(SKIPPED)

BUILD = pathlib.Path(os.environ["RAILCAST_BUILD"])
ROOT = pathlib.Path(__file__).resolve().parents[2]
GENERATE = BUILD / "generator" / "railcast-generate"
SCENARIO = ROOT / "scenarios" / "st_gallen_approach.json"


def generate(*arguments):
    """Runs railcast-generate; returns what it printed."""
    command = [str(word) for word in (GENERATE, *arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def faults_of(*arguments):
    """The lines with which railcast-generate fails."""
    command = [str(word) for word in (GENERATE, *arguments)]
    ended = subprocess.run(command, check=False, capture_output=True, text=True)
    assert ended.returncode == 1, ended
    return ended.stderr.rstrip("\n")


def read_pcd(path):
    """An independent reader of binary PCD: the structured array of its fields."""
    raw = path.read_bytes()
    end = raw.index(b"\n", raw.index(b"\nDATA binary") + 1) + 1
    head = dict(line.split(" ", 1) for line in raw[:end].decode().splitlines() if line[0] != "#")
    dtype = np.dtype([(name, f"<{kind.lower()}{size}")
                      for name, kind, size in zip(*(head[key].split() for key in ("FIELDS", "TYPE", "SIZE")))])
    return np.frombuffer(raw, dtype, offset=end).reshape(int(head["HEIGHT"]), int(head["WIDTH"]))
