"""Runs every command of every program, to its end, and opens all that it wrote: every_command_test.py BUILD_DIR.

The runs are those of scripts/dev/small_runs.py. The commands, and their options that write files, are those that the
programs' --help lists: one without a run is a fault. Ends with 77 if what draws or typesets on a server is not installed.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts" / "dev"))
import open_files  # noqa: E402
import small_runs  # noqa: E402 (found through the line above)

SKIPPED = 77  # For ctest.
TOOLS = ("xvfb-run", "weasyprint")
# How the help of an option says that it names what is written, or that more is written.
WRITES = re.compile(r"\b(file|directory|folder)\b[^.;]*\bto (write|log|draw|record)\b|^Also write"
                    r"|\b(directory|folder) (for report|of the data set)", re.IGNORECASE)


def writing_options(command):
    return {name for option in command.options() if WRITES.search(option.text) for name in option.names
            if name.startswith("--")}


def listed_commands(build):
    """The commands that the programs' --help lists, with their options that write."""
    for program, place in small_runs.PROGRAMS.items():
        if (build / place / program).exists():
            asked = small_runs.help_text.ask(build / place / program)
            for command in asked.subcommands or [asked]:
                yield " ".join(command.words), writing_options(command)


def run_row(row, writing, build, folder):
    """What a row does wrong."""
    command, arguments, expected, _ = row
    before = set(folder.rglob("*"))
    try:
        said, status = small_runs.run_row(row, build, folder)
    except subprocess.TimeoutExpired as fault:
        yield str(fault)
        return
    if status != 0:
        yield f"exit status {status}: {said}"
        return
    if isinstance(expected, str) and expected not in said:
        yield f"must print {expected} (got {said})"
    words = arguments.split()
    named = [following for word, following in zip(words, words[1:]) if word in writing and not following.startswith("--")]
    for name in named + (expected if isinstance(expected, list) else []):
        if not (folder / name).exists():
            yield f"must write {name}"
    yield from open_files.faults_in(folder, before)


def missing_rows(listed, rows):
    """What --help lists and no row runs."""
    run = {(row[0], word) for row in rows for word in row[1].split()}
    for command, writing in sorted(listed.items()):
        if all(row[0] != command for row in rows):
            yield f"{command}: has no row in scripts/dev/small_runs.py"
        for option in sorted(writing):
            if (command, option) not in run:
                yield f"{command} {option}: writes, and has no row in scripts/dev/small_runs.py"


def main(build):
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if missing:
        print(f"skipped: {' and '.join(missing)} is not installed")
        return SKIPPED
    small_runs.enter_display()
    listed = dict(listed_commands(build))
    rows = [row for row in small_runs.all_rows(build) if row[0] in listed]
    faults = list(missing_rows(listed, rows))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        small_runs.make_inputs(build, folder)
        for row in rows:
            faults += [f"{row[0]} {row[1]}: {fault}" for fault in run_row(row, listed[row[0]], build, folder)]
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
