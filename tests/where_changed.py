#!/usr/bin/env python3
"""Runs a test where what it depends on has changed since it last passed.

Usage: where_changed.py NAME COMMAND...
       where_changed.py --is-due NAME
       where_changed.py --keep NAME...

These tests take half the time of all, and each depends on a part of the tree: packages on what is built of which libraries,
installed and packed; the site on pages and interfaces; damaged inputs on what reads them. tests/where_changed.json has the
files of each group of tests, and tests/passed.json a hash of these files for each test, as they were when it passed; --keep
writes it. With the same hash a test is skipped (77), unless RAILCAST_TRY_ALL is set, as `scripts/test.sh --all` does. With
RAILCAST_KEEP, as `scripts/test.sh --keep` sets it, a test that passes is kept. --is-due ends with 0 if the test is to be run.
"""

import fcntl
import hashlib
import json
import os
import pathlib
import subprocess
import sys

TESTS = pathlib.Path(__file__).resolve().parent
ROOT = TESTS.parent
GROUPS = TESTS / "where_changed.json"
PASSED = TESTS / "passed.json"
SKIPPED = 77  # For ctest.


def inputs_of(name):
    """The patterns of the group that a test is in."""
    for group in json.loads(GROUPS.read_text(encoding="utf-8")).values():
        if name in group["tests"]:
            return group["inputs"]
    raise SystemExit(f"{GROUPS}: has no group with the test {name}")


def hash_of_inputs(name):
    patterns = [*inputs_of(name), "tests/where_changed.py"]
    files = {path for pattern in patterns for path in ROOT.glob(pattern) if path.is_file() and "__pycache__" not in path.parts}
    hashed = hashlib.sha256(json.dumps(patterns).encode())
    for path in sorted(files):
        data = path.read_bytes()
        hashed.update(f"{path.relative_to(ROOT)}\n{len(data)}\n".encode() + data)
    return hashed.hexdigest()


def read_passed():
    return json.loads(PASSED.read_text(encoding="utf-8")) if PASSED.exists() else {}


def keep(hashes):
    with GROUPS.open(encoding="utf-8") as lock:  # Tests run beside each other.
        fcntl.flock(lock, fcntl.LOCK_EX)
        PASSED.write_text(json.dumps(read_passed() | hashes, indent=1, sort_keys=True) + "\n", encoding="utf-8")


def is_due(name):
    return bool(os.environ.get("RAILCAST_TRY_ALL")) or read_passed().get(name) != hash_of_inputs(name)


def main(words):
    if words[0] == "--keep":
        keep({name: hash_of_inputs(name) for name in words[1:]})
        return 0
    if words[0] == "--is-due":
        return 0 if is_due(words[1]) else 1
    name, *command = words
    if not is_due(name):
        print(f"skipped: nothing that {name} depends on has changed since it passed (scripts/test.sh --all runs it)")
        return SKIPPED
    tried = hash_of_inputs(name)  # They may be edited while the test runs.
    status = subprocess.run(command, check=False).returncode
    if status == 0 and os.environ.get("RAILCAST_KEEP"):
        keep({name: tried})
    elif status == 0:
        print(f"passed: tests/where_changed.py --keep {name} says so to those who run it next")
    return status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
