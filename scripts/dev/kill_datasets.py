#!/usr/bin/env python3
"""Kills railcast-generate dataset at random moments and compares what it makes at last.

    scripts/dev/kill_datasets.py BUILD [KILLS]

A run of scenarios/recipes/small.json is killed (SIGKILL) at a random moment and begun again, ten
times; then it may finish. Every file must be that of a run that nobody killed. Repeats this until
there were KILLS (200) kills.
"""

import hashlib
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RECIPE = ROOT / "scenarios/recipes/small.json"
KILLS_A_RUN = 10


def files_of(folder):
    return {str(file.relative_to(folder)): hashlib.sha256(file.read_bytes()).hexdigest()
            for file in sorted(folder.rglob("*")) if file.is_file()}


def main():
    if not 2 <= len(sys.argv) <= 3:
        sys.exit(__doc__)
    program = Path(sys.argv[1]).resolve() / "generator/railcast-generate"
    num_kills = int(sys.argv[2]) if len(sys.argv) == 3 else 200
    moments = random.Random(7)
    done = survived = 0
    with tempfile.TemporaryDirectory() as folder:
        def command(name):
            return [program, "dataset", RECIPE, "--out", Path(folder) / name]

        begin = time.monotonic()
        subprocess.run(command("whole"), check=True, capture_output=True)
        whole_s = time.monotonic() - begin
        expected = files_of(Path(folder) / "whole")
        while done < num_kills:
            for _ in range(KILLS_A_RUN):
                run = subprocess.Popen(command("killed"), stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
                try:
                    # Each run continues, so that several of them share the whole duration.
                    run.wait(moments.uniform(0.0, 2.0 * whole_s / KILLS_A_RUN))
                    survived += 1
                except subprocess.TimeoutExpired:
                    run.kill()
                    run.wait()
                    done += 1
            subprocess.run(command("killed"), check=True, capture_output=True)
            found = files_of(Path(folder) / "killed")
            if found != expected:
                names = [name for name in expected.keys() | found.keys()
                         if expected.get(name) != found.get(name)]
                sys.exit(f"error: after {done} kills these files differ: {sorted(names)}")
            shutil.rmtree(Path(folder) / "killed")
    print(f"{done} kills (and {survived} runs that ended before): the same {len(expected)} files")


if __name__ == "__main__":
    main()
