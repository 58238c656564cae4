"""Runs the commands of a tutorial in an empty folder and looks for the lines that it shows.

usage: tutorial_test.py BUILD_FOLDER PAGE
"""

import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^(<!-- not run -->\n)?```(sh|text)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def missing_lines(shown, output):
    """The shown lines that the output does not have, each whole."""
    lines = {line.rstrip() for line in output.splitlines()}
    return [line for line in shown.splitlines() if line.rstrip() not in lines]


def run_page(text, folder):
    """Runs the page's shell blocks, one after the other, and yields its faults."""
    output, num_run = "", 0
    for match in BLOCK.finditer(text):
        left_out, kind, body = match.groups()
        if kind == "text":
            for line in missing_lines(body, output):
                yield f"shown, but not printed: {line}\n  printed:\n{output}"
        elif not left_out:
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", body], cwd=folder, text=True,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
            output, num_run = done.stdout, num_run + 1
            if done.returncode != 0:
                yield f"exit status {done.returncode} of\n{body}\n{output}"
    if num_run < 5:
        yield f"only {num_run} blocks were run"


def main(build, page):
    text = (ROOT / page).read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "build").mkdir()
        (folder / "build/release").symlink_to(build)
        (folder / "scenarios").symlink_to(ROOT / "scenarios")
        faults = list(run_page(text, folder))
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]))
