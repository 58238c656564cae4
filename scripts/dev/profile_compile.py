#!/usr/bin/env python3
"""Tells what the time of a build goes into: by room, and by header, template and function.

Usage: profile_compile.py BUILD [--units PATTERN] [--jobs N] [--top N] [--no-trace]

The first table sums the seconds of every job in BUILD's .ninja_log by room and by kind of job (they are seconds of the
clock: on a machine that does other work, too, they are too many). The others are what clang++-19 -ftime-trace says of
each unit whose output matches PATTERN (a regular expression; all units by default): the time spent on each header with
what it includes, on the instances of each template with what these instantiate, and on the code of each function. BUILD
stays as it is.
"""

import argparse
import collections
import concurrent.futures
import json
import pathlib
import re
import shlex
import subprocess
import tempfile

# What only GCC knows, and its precompiled headers.
ONLY_GCC = {"-Winvalid-pch", "-Wno-stringop-overflow", "-Wno-restrict", "-fno-semantic-interposition", "-Werror"}
TEMPLATE_ARGUMENTS = re.compile(r"<[^<>]*>")


def seconds_of_jobs(build):
    """{output: seconds} of the last time that each job ran."""
    seconds = {}
    for line in (build / ".ninja_log").read_text().splitlines():
        fields = line.split("\t")
        if len(fields) == 5:
            seconds[fields[3]] = (int(fields[1]) - int(fields[0])) / 1000
    return seconds


def room_of(output):
    """("core/io", "tests") of "tests/core/io/CMakeFiles/..."."""
    return re.split(r"/CMakeFiles/|/[^/]*$", output)[0]


def print_rooms(build, top):
    rooms = collections.Counter()
    kinds = collections.Counter()
    for output, seconds in seconds_of_jobs(build).items():
        kind = "compile" if output.endswith(".o") else "precompile" if output.endswith(".gch") else "link and other"
        rooms[room_of(output)] += seconds
        kinds[kind] += seconds
    print(f"{sum(kinds.values()):.0f} s of jobs: " + ", ".join(f"{name} {s:.0f}" for name, s in kinds.most_common()))
    for room, seconds in rooms.most_common(top):
        print(f"{seconds:9.1f} s  {room}")


def traced(entry):
    """The events of the unit that `entry` of compile_commands.json compiles."""
    words = iter(shlex.split(entry["command"])[1:])
    kept = []
    with tempfile.TemporaryDirectory() as folder:
        for word in words:
            if word in ("-include", "--param"):
                next(words)
            elif word == "-o":
                next(words)
                kept += ["-o", f"{folder}/unit.o"]
            elif word not in ONLY_GCC:
                kept.append(word)
        ran = subprocess.run(["clang++-19", *kept, "-w", "-ftime-trace", "-ftime-trace-granularity=200"],
                             cwd=entry["directory"], capture_output=True, text=True)
        if ran.returncode:
            return None
        return json.loads(pathlib.Path(folder, "unit.json").read_text())["traceEvents"]


def template_of(name):
    """"std::vector<>" of "std::vector<int, std::allocator<int>>"."""
    while TEMPLATE_ARGUMENTS.search(name.replace("<>", "")):
        name = TEMPLATE_ARGUMENTS.sub("§", name.replace("<>", "§"))
    return re.sub("§+", "<>", name.replace("<>", "§"))


def exclusive(events, name):
    """(detail, seconds) of the events of that name, each without what events of the same name inside of it took."""
    chosen = sorted((e for e in events if e.get("name") in name and e.get("ph") == "X"), key=lambda e: (e["ts"], -e["dur"]))
    stack = []
    for event in chosen:
        while stack and stack[-1][1] <= event["ts"]:
            yield stack.pop()[2:]
        if stack:
            stack[-1][3] -= event["dur"] * 1e-6
        stack.append([event["ts"], event["ts"] + event["dur"], event["args"].get("detail", ""), event["dur"] * 1e-6])
    while stack:
        yield stack.pop()[2:]


def print_traces(build, pattern, jobs, top):
    entries = [e for e in json.loads((build / "compile_commands.json").read_text())
               if re.search(pattern, e["command"].split(" -o ")[1].split()[0])]
    sums = {"headers, without what they include": collections.Counter(),
            "templates, without what they instantiate": collections.Counter(),
            "code of functions": collections.Counter(), "phases": collections.Counter()}
    events_of = {"headers, without what they include": ("Source",),
                 "templates, without what they instantiate": ("InstantiateClass", "InstantiateFunction"),
                 "code of functions": ("OptFunction",)}
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for done, events in enumerate(pool.map(traced, entries), 1):
            print(f"\r{done} of {len(entries)} units", end="", flush=True)
            if events is None:
                failed += 1
                continue
            for title, names in events_of.items():
                for detail, seconds in exclusive(events, names):
                    key = template_of(detail) if "template" in title else detail
                    sums[title][key] += seconds
            for event in events:
                if event.get("name", "").startswith("Total ") and event["name"][6:] in (
                        "ExecuteCompiler", "Frontend", "Backend", "Source", "PerformPendingInstantiations"):
                    sums["phases"][event["name"][6:]] += event["dur"] * 1e-6
    print(f"\r{len(entries)} units, {failed} of them did not compile with clang")
    for title, counter in sums.items():
        print(f"\n{title}: {sum(counter.values()):.0f} s" if title != "phases" else "\nphases, one inside of another")
        for name, seconds in counter.most_common(top):
            print(f"{seconds:9.1f} s  {name[:150]}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--units", default="", metavar="PATTERN")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--top", type=int, default=40)
    parser.add_argument("--no-trace", action="store_true", help="only the table of rooms")
    arguments = parser.parse_args()
    print_rooms(arguments.build, arguments.top)
    if not arguments.no_trace:
        print_traces(arguments.build, arguments.units, arguments.jobs, arguments.top)


if __name__ == "__main__":
    main()
