#!/usr/bin/env python3
"""Says how many tests of the test programs ran, which were skipped and why, and which took longest.

Usage: summarize_tests.py FOLDER        FOLDER: Testing/results of a build
"""

import collections
import pathlib
import sys
import xml.etree.ElementTree as ET

NUM_SLOWEST = 10


def read_tests(folder):
    """(name, seconds, why it was skipped or None) of every test that ran."""
    for path in sorted(folder.rglob("*.xml")):
        for case in ET.parse(path).getroot().iter("testcase"):
            if case.get("status") != "run":
                continue
            skipped = case.find("skipped")
            # The message begins with the place in the sources.
            why = None if skipped is None else skipped.get("message", "").strip().rsplit("\n", maxsplit=1)[-1]
            yield f"{case.get('classname')}.{case.get('name')}", float(case.get("time")), why


def summary_of(tests):
    tests = list(tests)
    reasons = collections.defaultdict(list)
    for name, _, why in tests:
        if why is not None:
            reasons[why].append(name)
    num_skipped = sum(map(len, reasons.values()))
    lines = [f"{len(tests) - num_skipped} tests of the test programs ran; skipped: {num_skipped}"]
    for why, names in sorted(reasons.items()):
        lines.append(f"  {why or 'no reason given'}: {', '.join(sorted(names))}")
    lines.append("the slowest:")
    slowest = sorted(tests, key=lambda test: -test[1])[:NUM_SLOWEST]
    lines += [f"  {seconds:6.1f} s  {name}" for name, seconds, _ in slowest]
    return "\n".join(lines)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    print(summary_of(read_tests(pathlib.Path(sys.argv[1]))))


if __name__ == "__main__":
    main()
