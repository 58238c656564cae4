#!/usr/bin/env python3
"""Tells whether a change of the code leaves every byte as it was that railcast writes and prints.

Usage: check_bytes.py BUILD --save FOLDER       before the change: keep all that railcast makes
       check_bytes.py BUILD --against FOLDER    after it: name each file that differs, and where; exit 1 if there is any

Of each scenario under scenarios/ two frames are made at its own fidelity and one with `footprint`, with cameras, what
`check` prints, the scenario with all defaults, and 4 m of its world; of each recipe a shard. To these come the runs of
small_runs.py: every command and report, every rung, format, protocol and layout of points, insertions into recordings of
each kind, a data set with shards, a study, an import. Real recordings and maps are taken where ../shared/data has them.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import byte_differences
import small_runs
from small_runs import ROOT

SHARED = ROOT.parent / "shared" / "data"
AHEAD_M = 20  # Of the vehicle, where the stretch of its world begins.
STRETCH_M = 4
# (arguments of railcast-generate, what it reads of SHARED)
REAL = (
    ("insert @ plan.json --frames 0..1 --out out", "lidar_hesai_more/qt64.db3"),
    ("insert @ plan.json --frames 0..1 --out out", "lidar_packets_nebula/vlp16_dual.pcap"),
    ("insert @ plan.json --out out", "lidar_ouster/OS-1-128_767798045_1024x10_20230712_120049.pcap"),
    ("import @ --within 15.61,48.195,15.64,48.215 --min-length 1500 --out out", "osm_sankt_poelten/sankt_poelten.json"),
)


def shipped_scenarios():
    for path in sorted((ROOT / "scenarios").glob("**/*.json")):
        if path.relative_to(ROOT).parts[1] in ("malformed", "schema"):
            continue
        content = json.loads(path.read_text())
        if isinstance(content, dict) and str(content.get("$schema")).endswith("scenario.schema.json"):
            yield path.relative_to(ROOT)


def run(program, arguments, folder, name, keeps_text=True):
    """Runs a command in a folder and keeps there what it prints, if asked or if it fails."""
    said, status = small_runs.run_words([program, *arguments], folder)
    if keeps_text or status:
        (folder / f"{name}.txt").write_text(f"{said.replace(str(folder), '@')}\nexit status {status}\n")


def make_scenario(program, scenario, folder):
    """Makes what is made of a shipped scenario."""
    folder.mkdir(parents=True)
    (folder / "scenarios").symlink_to(ROOT / "scenarios")
    run(program, ["check", scenario, "--resolved", "resolved.json"], folder, "check")
    run(program, ["sequence", scenario, "--out", "own", "--frames", "2", "--stride", "7"], folder, "own", False)
    run(program, ["sequence", scenario, "--out", "footprint", "--frames", "1", "--start-frame", "6", "--format", "ply",
                  "--fidelity", "footprint"], folder, "footprint", False)
    if (folder / "resolved.json").exists():
        vehicle = json.loads((folder / "resolved.json").read_text()).get("vehicle", {})
        from_m = vehicle.get("start_s_m", 0) + AHEAD_M
        run(program, ["world", scenario, "--from-s", str(from_m), "--to-s", str(from_m + STRETCH_M), "--max-mb", "100000",
                      "--out", "world.ply"], folder, "world", False)


def make_small(build, folder):
    """Runs small_runs.py's rows, and keeps the text of those that do not depend on a clock."""
    folder.mkdir(parents=True)
    small_runs.make_inputs(build, folder)
    (folder / "printed").mkdir()
    for row in small_runs.all_rows(build):
        said, status = small_runs.run_row(row, build, folder)
        if status or not (row[3] or f"{small_runs.LIVE}/" in row[1]):
            name = "_".join(f"{row[0]} {row[1]}".replace("/", " ").split())
            (folder / "printed" / f"{name[:200]}.txt").write_text(f"{said}\nexit status {status}\n")


def make_real(program, arguments, source, folder):
    """Runs a command on what was recorded or mapped elsewhere, if it is there."""
    folder.mkdir(parents=True)
    (folder / "scenarios").symlink_to(ROOT / "scenarios")
    (folder / "plan.json").write_text(json.dumps(small_runs.INPUTS["plan_standing.json"]))
    if (SHARED / source).exists():
        run(program, [word.replace("@", str(SHARED / source)) for word in arguments.split()], folder, "out")
    else:
        print(f"left out: {SHARED / source} is not there", flush=True)


def make_recipe(program, recipe, shard, folder):
    folder.mkdir(parents=True)
    (folder / "scenarios").symlink_to(ROOT / "scenarios")
    run(program, ["dataset", f"scenarios/recipes/{recipe}", "--out", "out", "--shard", shard], folder, "out", False)


def make_all(build, folder):
    program = build / "generator" / "railcast-generate"
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = [pool.submit(make_small, build, folder / "small")]
        jobs += [pool.submit(make_recipe, program, recipe, shard, folder / "recipes" / recipe)
                 for recipe, shard in (("small.json", "1/3"), ("factory.json", "3/250"))]
        jobs += [pool.submit(make_real, program, arguments, source, folder / "real" / str(number))
                 for number, (arguments, source) in enumerate(REAL)]
        jobs += [pool.submit(make_scenario, program, scenario, folder / "shipped" / scenario.relative_to("scenarios"))
                 for scenario in shipped_scenarios()]
        for job in jobs:
            job.result()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    group = parser.add_mutually_exclusive_group(required=True)
    group.add_argument("--save", type=pathlib.Path)
    group.add_argument("--against", type=pathlib.Path)
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    if arguments.save:
        arguments.save.mkdir(parents=True)
        make_all(build, arguments.save.resolve())
        print(f"{len(byte_differences.files_in(arguments.save))} files in {arguments.save}")
        return 0
    with tempfile.TemporaryDirectory() as temporary:
        now = pathlib.Path(temporary).resolve()
        make_all(build, now)
        different = list(byte_differences.differences(arguments.against, now))
        num_files = len(byte_differences.files_in(now))
    for name, what in different:
        print(f"{name}: {what}")
    print(f"{len(different)} of {num_files} files differ")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
