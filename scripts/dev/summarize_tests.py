#!/usr/bin/env python3
"""Says how many tests of the test programs ran, which were skipped and why, and which took longest; and which of ctest's
entries took more than their share of the time.

Usage: summarize_tests.py FOLDER [--keep]
       summarize_tests.py --costs

FOLDER is Testing/results of a build, beside which `ctest --output-junit` has written ctest.xml. Each entry that takes ten
seconds or more has its budget in tests/time_budget.json, in seconds. Machines differ, so that an entry is over its budget
where its part of the whole is half more than there. --keep writes the measured times into the table.
--costs prints the table in the form of ctest's own CTestCostData.txt, by which it begins with what takes longest.
"""

import collections
import json
import pathlib
import sys
import xml.etree.ElementTree as ET

NUM_SLOWEST = 10
BUDGET = pathlib.Path(__file__).resolve().parents[2] / "tests" / "time_budget.json"
LEAST_S = 10.0  # An entry that takes less needs no budget.
TOLERANCE = 1.5


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


def read_entries(junit):
    """{entry of ctest: seconds}."""
    return {case.get("name"): float(case.get("time")) for case in ET.parse(junit).getroot().iter("testcase")}


def over_budget(entries, budget):
    """A line for each entry that is over its budget, or takes long and has none."""
    both = entries.keys() & budget.keys()
    if not both:
        return []
    pace = sum(entries[name] for name in both) / sum(budget[name] for name in both)
    lines = []
    for name, seconds in sorted(entries.items()):
        allowed = TOLERANCE * pace * budget.get(name, LEAST_S / TOLERANCE)
        if seconds > max(allowed, LEAST_S * pace):
            lines.append(f"  {name}: {seconds:.0f} s, {allowed:.0f} are allowed at this machine's pace")
    return lines


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if sys.argv[1] == "--costs":
        for name, seconds in json.loads(BUDGET.read_text()).items():
            print(name, 1, seconds)
        print("---")
        return
    folder = pathlib.Path(sys.argv[1])
    print(summary_of(read_tests(folder)))
    junit = folder.parent / "ctest.xml"
    if not junit.is_file():
        return
    entries = read_entries(junit)
    if "--keep" in sys.argv:
        kept = {name: round(seconds) for name, seconds in sorted(entries.items()) if seconds >= LEAST_S}
        BUDGET.write_text(json.dumps(kept, indent=1) + "\n")
    lines = over_budget(entries, json.loads(BUDGET.read_text()))
    print(f"{len(entries)} entries took {sum(entries.values()):.0f} s in all; over their budget: {len(lines)}")
    print("\n".join(lines), end="\n" if lines else "")


if __name__ == "__main__":
    main()
