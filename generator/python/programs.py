"""The programs that a wheel has beside the module: `railcast-generate` and `railcast-analyze`."""

import os
import pathlib
import sys


def _become(name):
    """Runs the program in place of Python."""
    program = pathlib.Path(__file__).parent / "bin" / name
    os.execv(program, [name, *sys.argv[1:]])


def generate():
    """Makes frames from a scenario: `railcast-generate --help`."""
    _become("railcast-generate")


def analyze():
    """Measures and compares point clouds: `railcast-analyze --help`."""
    _become("railcast-analyze")
