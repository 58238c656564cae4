#!/usr/bin/env python3
"""Inspects the recordings of a folder: inspect_data.py BUILD_DIR DATA [--write].

The table in docs/results/inspected.md must be what was found; --write writes it. Ends with 77 if DATA is not there.
"""

import json
import pathlib
import subprocess
import sys

SKIPPED = 77  # For ctest.
PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs/results/inspected.md"
BEGIN, END = "<!-- table -->\n", "<!-- end of table -->\n"
HEAD = ("| recording | what | sensor | frames | insert | weather | survey | fit | remarks |\n"
        "|---|---|---|---|---|---|---|---|---|\n")
ENDINGS = (".pcap", ".pcapng", ".mcap", ".db3", ".pcd", ".ply", ".bin", ".las", ".xyz", ".pts", ".asc", ".pc")
# Folders of messages of all kinds, of which hardly any has points.
OTHERS = ("mcap/conformance", "rosbag2/", "meshes", "mcap/spec")
SHORT = {"yes": "yes", "with an option": "option", "no": "no"}


def inspected(program, file, data):
    """The row of a recording."""
    ended = subprocess.run([program, "inspect", file, "--format", "json", "--frames", "5"], capture_output=True, text=True,
                           check=False)
    name = file.relative_to(data)
    if ended.returncode != 0:
        lines = [line for line in ended.stderr.splitlines() if line.strip() and ": remark " not in line]
        said = lines[-1] if lines else f"ended with {ended.returncode}"
        return f"| {name} | refused: {said.replace(str(data) + '/', '').replace('|', '&#124;')} | | | | | | | |\n"
    report = json.loads(ended.stdout)
    rows = {section["key"]: section["tables"][0]["rows"] for section in report["sections"]}
    jobs = {row["job"]: SHORT[row["fit"]] for row in rows["jobs"]}
    what = {row["what"]: row["figure"] for row in rows["what"]}
    remarks = ", ".join(f"{remark['name']} {remark['number']}" for remark in report["remarks"])
    return (f"| {name} | {what['kind']} | {what['sensor']} | {what['frames']} | {jobs['insert']} | {jobs['weather']} | "
            f"{jobs['survey']} | {jobs['fit']} | {remarks} |\n")


def recordings(data):
    """Those of a folder, in the order of their names."""
    return sorted(file for file in data.rglob("*") if file.suffix.lower() in ENDINGS
                  and not str(file.relative_to(data)).startswith(OTHERS))


def main(build, data, write):
    if not data.is_dir():
        print(f"skipped: {data} is not there")
        return SKIPPED
    program = build / "analysis" / "railcast-analyze"
    table = HEAD + "".join(inspected(program, file, data) for file in recordings(data))
    page = PAGE.read_text()
    before, after = page[:page.index(BEGIN) + len(BEGIN)], page[page.index(END):]
    if write:
        PAGE.write_text(before + table + after)
    elif page != before + table + after:
        print(f"{PAGE}: the table must be what was found; --write writes it:\n{table}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), "--write" in sys.argv[3:]))
