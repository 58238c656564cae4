#!/usr/bin/env python3
"""Tells whether a change of the code leaves every byte of the shipped scenarios as it was.

Usage: check_bytes.py BUILD --save FILE       before the change: write the hash of every file that railcast makes
       check_bytes.py BUILD --against FILE    after it: name the files whose hashes differ, exit 1 if there are any

Of each scenario under scenarios/ two frames are made at its own fidelity and one with `footprint`, with cameras, and
what `check` and `world` print and write; of each recipe a shard of four scenarios. The program's own version does not count.
"""

import argparse
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Of the program, and hashes of what holds it.
VERSION = re.compile(rb'"(version|program|(manifest|report|line|files)_xxh3|(run|dataset)\.json|scenarios\.jsonl)": ?"[^"]+"')
# Of measured time, in what commands print.
TIME = re.compile(rb"in [0-9.]+ (s|ms)|\([0-9.]+ frames/s\)|[0-9.]+ ms")


def shipped_scenarios():
    for path in sorted((ROOT / "scenarios").glob("**/*.json")):
        if path.relative_to(ROOT).parts[1] in ("malformed", "schema"):
            continue
        content = json.loads(path.read_text())
        if isinstance(content, dict) and str(content.get("$schema")).endswith("scenario.schema.json"):
            yield path


def commands_of(program, scenario):
    """(name, arguments) of what is made of a scenario; "@" stands for the place of the output."""
    yield "own", [program, "sequence", scenario, "--out", "@", "--frames", "2", "--stride", "7"]
    yield "footprint", [program, "sequence", scenario, "--out", "@", "--frames", "1", "--start-frame", "5",
                        "--fidelity", "footprint", "--format", "ply"]
    yield "check", [program, "check", scenario]
    yield "world", [program, "world", scenario, "--max-mb", "100000", "--out", "@/world.ply"]


def hashes_of(name, arguments):
    """(file, hash) of everything that a command writes and prints."""
    with tempfile.TemporaryDirectory() as temporary:
        out = pathlib.Path(temporary) / "out"
        if str(arguments[-1]).startswith("@/"):
            out.mkdir()
        ran = subprocess.run([str(a).replace("@", str(out)) for a in arguments], cwd=ROOT, capture_output=True)
        printed = ran.stdout + ran.stderr if name.endswith("check") or ran.returncode else b""
        printed = TIME.sub(b"", printed.replace(str(out).encode(), b"@")) + str(ran.returncode).encode()
        yield f"{name}: printed", hashlib.sha256(printed).hexdigest()
        for path in sorted(out.glob("**/*")):
            if path.is_file():
                yield f"{name}/{path.relative_to(out)}", hashlib.sha256(VERSION.sub(b"", path.read_bytes())).hexdigest()


def all_hashes(build):
    program = build / "generator" / "railcast-generate"
    for scenario in shipped_scenarios():
        name = scenario.relative_to(ROOT / "scenarios")
        for kind, arguments in commands_of(program, scenario.relative_to(ROOT)):
            yield from hashes_of(f"{name} {kind}", arguments)
    for recipe, shard in (("small.json", "1/3"), ("factory.json", "3/250")):
        yield from hashes_of(f"recipes/{recipe}", [program, "dataset", f"scenarios/recipes/{recipe}", "--out", "@",
                                                   "--shard", shard])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    group = parser.add_mutually_exclusive_group(required=True)
    group.add_argument("--save", type=pathlib.Path)
    group.add_argument("--against", type=pathlib.Path)
    arguments = parser.parse_args()
    now = dict(all_hashes(arguments.build.resolve()))
    if arguments.save:
        arguments.save.write_text(json.dumps(now, indent=1) + "\n")
        print(f"{len(now)} hashes in {arguments.save}")
        return 0
    before = json.loads(arguments.against.read_text())
    different = [name for name in sorted(before.keys() | now.keys()) if before.get(name) != now.get(name)]
    for name in different:
        print(f"{name}: {'new' if name not in before else 'gone' if name not in now else 'differs'}")
    print(f"{len(different)} of {len(now)} differ")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
