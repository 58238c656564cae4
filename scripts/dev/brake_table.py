#!/usr/bin/env python3
"""Writes what scripts/dev/brake_runs.sh measured into the table of a page.

usage: brake_table.py RUNS PAGE

RUNS has a line per run: scenario, weather and the report of examples/brake_client.py. The rows of the
first table behind PAGE's line <!-- figures: scripts/dev/brake_runs.sh --> are replaced.
"""

import pathlib
import re
import sys

MARK = "<!-- figures: scripts/dev/brake_runs.sh -->\n"
REPORT = re.compile(r"(\S+) +(\S+) +detected at ([\d.]+) m with ([\d.]+) m/s, braking distance "
                    r"([\d.]+) m, gap left (-?[\d.]+) m")
WEATHERS = {"clear": "clear", "heavy_rain": "rain of 10 mm/h",
            "thick_fog": "fog, visibility 100 m"}


def row(line, last_scenario):
    report = REPORT.fullmatch(line)
    if report is None:
        raise SystemExit(f"must be the report of a run that stopped for something (got {line!r})")
    scenario, weather, detected, speed, braking, gap = report.groups()
    name = scenario.removeprefix("brake_")
    speed_kmh = 3.6 * float(speed)
    what = "" if scenario == last_scenario else f"{name}, {speed_kmh:.0f} km/h "
    left = f"{gap} m" if float(gap) > 0 else f"**{gap} m**: it runs into the {name}"
    return f"| {what}| {WEATHERS[weather]} | {detected} m | {braking} m | {left} |", scenario


def table(lines):
    rows, scenario = [], None
    for line in lines:
        text, scenario = row(line, scenario)
        rows.append(text)
    head = "| | weather | detected at | braking distance | gap left |\n|---|---|---|---|---|\n"
    return head + "\n".join(rows) + "\n"


def with_table(page, lines):
    before, mark, after = page.partition(MARK)
    if not mark:
        raise SystemExit(f"the page must have the line {MARK.strip()}")
    _, _, rest = after.partition("\n\n")
    return before + mark + table(lines) + "\n" + rest


def main(arguments):
    if len(arguments) != 2:
        raise SystemExit(__doc__)
    runs, page = map(pathlib.Path, arguments)
    lines = [line.strip() for line in runs.read_text(encoding="utf-8").splitlines()]
    page.write_text(with_table(page.read_text(encoding="utf-8"), lines), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
