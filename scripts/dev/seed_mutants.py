#!/usr/bin/env python3
"""Says how many faults that are put into the product's sources its test programs find.

Usage: seed_mutants.py seed NUM SEED            NUM of at most 1000
       seed_mutants.py reach BUILD FOLDER
       seed_mutants.py kill BUILD FOLDER [SECONDS]

seed changes NUM places of the tree, chosen by SEED, so that all faults are compiled at once and RAILCAST_MUTANT=K switches
the Kth on: a statement is left out, or a condition always or never holds. Work on a copy of the tree; the places are
written to mutants.json. reach runs ctest's entries of test programs once and keeps in FOLDER which faults each passed;
what fails without a fault is left out. kill runs, for each fault, the entries that pass it, those that pass the fewest
first, until one fails, and fails only with the fault, or their time exceeds SECONDS (120). Both go on where they were
stopped.
"""

import concurrent.futures
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import time

PLACES = "mutants.json"
MOST_S = 300.0  # A test that takes longer has failed, or ten times as long as without a fault.
MOST_MUTANTS = 1000  # As mutant.h has it.
ROOMS = ("core", "generator", "analysis", "viewer")
# A call or an assignment that fills a line; what declares something has two words before its bracket or sign.
STATEMENT = re.compile(r"^(\s+)((?:[a-z_][\w.]*(?:->[\w.]+|\[[^\]]*\])*)(?:\(.*\)| [-+*/|&]?= .*|\+\+|--);)$")
KEYWORDS = re.compile(r"^\s*(return|case|break|throw|using|static_assert|goto|delete|default|if|for|while|switch|explicit)\b")
CONDITION = re.compile(r"^(\s*(?:\} else )?if )\((.*)\)((?: \{| [^;{}]*;)?)$")


def is_balanced(text):
    depth = 0
    for sign in text:
        depth += (sign == "(") - (sign == ")")
        if depth < 0:
            return False
    return depth == 0


def mutants_of(path):
    """(line number, what is left out, line with {K} for the mutant's number) of each place in a source."""
    before = "{"
    for number, line in enumerate(path.read_text(encoding="utf-8").split("\n")):
        found = CONDITION.match(line)
        if found and is_balanced(found[2]) and is_balanced(found[3]) and ";" not in found[2] and " = " not in found[2]:
            begin, condition, end = found.groups()
            # Only the value changes, so that an `else` that follows still compiles.
            yield number, "always", f"{begin}(({condition}) || railcast_mutants::Is({{K}})){end}"
            yield number, "never", f"{begin}(({condition}) && !railcast_mutants::Is({{K}})){end}"
        found = STATEMENT.match(line)
        if found and before[-1:] in ";{}" and not KEYWORDS.match(line) and is_balanced(line) and "const " not in line:
            yield number, "left out", f"{found[1]}if (!railcast_mutants::Is({{K}})) {found[2]}"
        if line.strip() and not line.lstrip().startswith("//"):
            before = line.rstrip()


def seed(num, key):
    sources = sorted(path for room in ROOMS for path in pathlib.Path(room).rglob("*.cpp"))
    places = [(path, *place) for path in sources for place in mutants_of(path)]
    chosen, lines = [], set()
    for place in random.Random(key).sample(places, len(places)):
        if len(chosen) < num and (place[0], place[1]) not in lines:
            lines.add((place[0], place[1]))
            chosen.append(place)
    chosen.sort(key=lambda place: (str(place[0]), place[1]))
    for k, (path, number, _, text) in enumerate(chosen):
        rows = path.read_text(encoding="utf-8").split("\n")
        rows[number] = text.replace("{K}", str(k))
        path.write_text("\n".join(rows), encoding="utf-8")
    for path in {place[0] for place in chosen}:
        path.write_text('#include "scripts/dev/mutant.h"\n' + path.read_text(encoding="utf-8"), encoding="utf-8")
    table = [{"path": str(path), "line": number + 1, "what": what} for path, number, what, _ in chosen]
    pathlib.Path(PLACES).write_text(json.dumps(table, indent=1), encoding="utf-8")
    print(f"{len(table)} of {len(places)} places")


def test_programs(build):
    """{name: (command, folder, environment)} of ctest's entries that are programs with tests of GoogleTest."""
    listed = json.loads(subprocess.check_output(["ctest", "--test-dir", build, "--show-only=json-v1"]))
    programs = {}
    for test in listed["tests"]:
        properties = {each["name"]: each["value"] for each in test["properties"]}
        command = [word for word in test.get("command", []) if not word.startswith("--gtest_output")]
        if not any(word.startswith(("--gtest", "--tests_of")) for word in command):
            continue
        more = dict(word.split("=", 1) for word in properties.get("ENVIRONMENT", []))
        programs[test["name"]] = (command + ["--gtest_fail_fast"], properties["WORKING_DIRECTORY"], more)
    return programs


def run_entry(program, most_s=MOST_S, **more):
    """(whether it passed, its seconds)."""
    command, folder, environment = program
    begin = time.time()
    # In a group of its own, to end what it has started with it.
    running = subprocess.Popen(command, cwd=folder, env=os.environ | environment | more, stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        return running.wait(most_s) == 0, time.time() - begin
    except subprocess.TimeoutExpired:
        os.killpg(running.pid, signal.SIGKILL)
        running.wait()
        return False, time.time() - begin


def in_parallel(work, items):
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(work, items))


def reach(build, folder):
    programs = test_programs(build)

    def run(name):
        into = folder / name.replace("/", "_")
        if (into / "entry.json").exists():
            return
        into.mkdir(parents=True, exist_ok=True)
        passed, seconds = run_entry(programs[name], RAILCAST_MUTANTS_REACHED=str(into))
        (into / "entry.json").write_text(json.dumps({"name": name, "passed": passed, "seconds": seconds}), encoding="utf-8")

    in_parallel(run, programs)


def read_entries(folder):
    for path in sorted(folder.glob("*/entry.json")):
        entry = json.loads(path.read_text(encoding="utf-8"))
        if entry["passed"]:
            yield entry | {"reached": {int(file.name) for file in path.parent.iterdir() if file.name.isdigit()}}


def kill(build, folder, limit_s):
    programs = test_programs(build)
    places = json.loads(pathlib.Path(PLACES).read_text(encoding="utf-8"))
    entries = sorted(read_entries(folder), key=lambda entry: len(entry["reached"]))
    results = folder / "results.jsonl"
    done = {json.loads(line)["mutant"] for line in results.open()} if results.exists() else set()

    def run(k):
        spent_s, killer, ran = 0.0, None, []
        reaching = [entry for entry in entries if k in entry["reached"]]
        for entry in reaching:
            if spent_s > limit_s:
                break
            program = programs[entry["name"]]
            passed, seconds = run_entry(program, min(MOST_S, 30.0 + 10.0 * entry["seconds"]), RAILCAST_MUTANT=str(k))
            spent_s += seconds
            ran.append(entry["name"])
            if not passed and run_entry(program)[0]:
                killer = entry["name"]
                break
        line = places[k] | {"mutant": k, "killer": killer, "num_reaching": len(reaching), "ran": ran}
        with results.open("a", encoding="utf-8") as file:
            file.write(json.dumps(line) + "\n")

    # In an order of chance, so that those that are done are a sample where it was stopped.
    in_parallel(run, [k for k in random.Random(0).sample(range(len(places)), len(places)) if k not in done])


def main(arguments):
    if len(arguments) == 4 and arguments[1] == "seed" and int(arguments[2]) <= MOST_MUTANTS:
        seed(int(arguments[2]), int(arguments[3]))
    elif len(arguments) == 4 and arguments[1] == "reach":
        reach(arguments[2], pathlib.Path(arguments[3]).resolve())
    elif len(arguments) in (4, 5) and arguments[1] == "kill":
        kill(arguments[2], pathlib.Path(arguments[3]).resolve(), float(arguments[4]) if len(arguments) == 5 else 120.0)
    else:
        print(__doc__, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
