#!/usr/bin/env python3
"""Runs a test of packages, wheel or installed libraries where what they are made of has changed since it last passed.

Usage: where_changed.py NAME COMMAND...
       where_changed.py --keep NAME...

These tests take a fifth of the time of all, and what they find depends on few files: those that say what is built of
which libraries, installed and packed, public headers, and examples. tests/package/passed.json has a hash of these files
for each test, as they were when it passed; --keep writes it. With the same hash the test is skipped (77), unless
RAILCAST_TRY_PACKAGES is set, as scripts/dev/release.sh does.
"""

import hashlib
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PASSED = pathlib.Path(__file__).with_name("passed.json")
SKIPPED = 77  # For ctest.
FOLDERS = ("core/include", "examples", "generator/python", "scripts/packaging", "tests/package")
FILES = ("pyproject.toml", "scripts/package.sh", "scripts/packages.sh", "tests/python/wheel_test.py")
BUILT = ("core", "generator", "analysis", "viewer")


def inputs():
    """What packages are made of, beside the sources that are compiled."""
    yield ROOT / "CMakeLists.txt"
    yield from (ROOT / name for name in FILES)
    for folder in FOLDERS:
        yield from (path for path in (ROOT / folder).rglob("*") if path.is_file() and path != PASSED)
    for folder in BUILT:
        for pattern in ("CMakeLists.txt", "*.cmake", "*.in"):
            yield from (ROOT / folder).rglob(pattern)


def hash_of_inputs():
    hashed = hashlib.sha256()
    for path in sorted(set(inputs())):
        if "__pycache__" in path.parts:
            continue
        data = path.read_bytes()
        hashed.update(f"{path.relative_to(ROOT)}\n{len(data)}\n".encode() + data)
    return hashed.hexdigest()


def read_passed():
    return json.loads(PASSED.read_text(encoding="utf-8")) if PASSED.exists() else {}


def main(words):
    now = hash_of_inputs()
    if words[0] == "--keep":
        passed = read_passed() | dict.fromkeys(words[1:], now)
        PASSED.write_text(json.dumps(passed, indent=1, sort_keys=True) + "\n", encoding="utf-8")
        return 0
    name, *command = words
    if read_passed().get(name) == now and not os.environ.get("RAILCAST_TRY_PACKAGES"):
        print(f"skipped: nothing that packages are made of has changed since {name} passed (RAILCAST_TRY_PACKAGES=1 runs it)")
        return SKIPPED
    status = subprocess.run(command, check=False).returncode
    if status == 0:
        print(f"passed: tests/package/where_changed.py --keep {name} says so to those who run it next")
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
