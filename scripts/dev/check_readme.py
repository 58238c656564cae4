#!/usr/bin/env python3
"""Holds README's commands, and what the demo says at its end, against what scripts/demo.sh and README build and make.

Usage: check_readme.py [--run] [BUILD]        BUILD: the build's folder, default build/release

Without --run, names a fault for each program, file and option of README's commands that is not there after the demo and
the commands before it, and for each file that cmake --install installs and they do not build. It needs a configured
build; nothing is built.

With --run, runs all commands on the tree of the demo, which has been run before, and scripts/build.sh installed after
it: in a temporary folder, into which build, scenarios and out/demo are linked. Frontiers, of one frame, are ended
after a minute if they take longer; the window of the viewer is closed after some seconds; what builds, and the
benchmark, are left out. Takes some minutes.

Exit status: 0 if nothing is wrong, else 1.
"""

import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^```(sh|python)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
DOCUMENT = re.compile(r"<<'(\w+)'\n.*?^\1$", re.MULTILINE | re.DOTALL)
PLACE = "build/release"  # The build's folder in README and in the scripts.
BUILD_SCRIPT = "scripts/build.sh"
# What the demo says of a file at its end.
CLAIM = re.compile(r"^  \$PWD/(\S+) +(.*)$", re.MULTILINE)
STAGE = re.compile(r"^build_stage \d+ .+$", re.MULTILINE)  # What the demo builds.
PYTHONPATH = f"{PLACE}/python"
WINDOW_S = 15
FRONTIER_S = 60
# How each command is run that would not end, or not soon: by what it contains, the command that takes its place.
INSTEAD = (
    (BUILD_SCRIPT, None),
    ("scripts/demo.sh", None),
    ("scripts/test.sh", None),
    ("railcast-bench", None),
    ("railcast-view out/", f"timeout {WINDOW_S} xvfb-run -a {{}} || (($? == 124))"),
    ("malformed", "{} || (($? == 1))"),
    ("frontier", f"timeout {FRONTIER_S} {{}} --frames 1 --rows geometry || (($? == 124))"),
)


def commands_of(block):
    """The commands of a block of shell, without comments and documents."""
    lines = [line.split(" #", maxsplit=1)[0].rstrip() for line in DOCUMENT.sub("", block).splitlines()]
    return [line for line in lines if line and not line.startswith("#")]


def ninja(build, *arguments):
    """The lines that a tool of ninja prints, with paths relative to the build's folder."""
    listed = subprocess.run(["ninja", "-C", build, "-t", *arguments], check=True, capture_output=True, text=True)
    return [line.replace(f"{build}/", "") for line in listed.stdout.splitlines()]


def outputs_of(build, targets):
    """The files that are there when these targets are built: what they are made of and, of an alias, what it names."""
    named = {line.strip() for target in targets for line in ninja(build, "query", target)}
    return named | set(ninja(build, "inputs", *targets))


def targets_of(command):
    """What a line of shell has scripts/build.sh or a stage of the demo build."""
    words = shlex.split(command, comments=True)
    if words[:1] == [BUILD_SCRIPT]:
        return words[1:]
    return words[2:] if words[:1] == ["build_stage"] else []


def installed_files(build):
    """The files of the build's folder that cmake --install copies."""
    for script in build.rglob("cmake_install.cmake"):
        for file in re.findall(r'FILES? "([^"]+)"', script.read_text("utf-8")):
            if file.startswith(f"{build}/"):
                yield os.path.relpath(file, build)


def install_faults(build, built):
    targets = {line.split(":", maxsplit=1)[0] for line in ninja(build, "targets", "all")}
    for file in sorted(set(installed_files(build))):
        if file in targets and file not in built:
            yield f"cmake --install: needs {file}, which neither scripts/demo.sh nor README builds"


def options_faults(words, build):
    """Options of a railcast program's command that its help does not have."""
    program = next((place for place, word in enumerate(words) if word.startswith(f"{PLACE}/")), None)
    if program is None or not (build / os.path.relpath(words[program], PLACE)).exists():
        return
    command = [str(build / os.path.relpath(words[program], PLACE))]
    if program + 1 < len(words) and re.fullmatch("[a-z]+", words[program + 1]):
        command.append(words[program + 1])
    shown = subprocess.run([*command, "--help"], capture_output=True, text=True, check=False).stdout
    known = set(re.findall(r"(?<!\S)--[a-z][a-z-]*", shown.replace(",", " ")))
    for word in words[program:]:
        if word.startswith("--") and word not in known:
            yield f"{' '.join(command)}: has no option {word}"


def command_faults(command, build, built, made):
    """What a command names that is neither in the sources, nor built, nor made before it."""
    words = shlex.split(command.rstrip("&"))
    for place, word in enumerate(words):
        path = word.rstrip("/")
        if path.startswith(f"{PLACE}/"):
            if os.path.relpath(path, PLACE) not in built:
                yield f"{command}: {path} is not built"
        elif path.startswith(("scenarios/", "scripts/", "docs/")) and not (ROOT / path).exists():
            yield f"{command}: there is no {path}"
        elif path.startswith("out/") and words[place - 1] != "--out":
            if not any(path == each or path.startswith(f"{each}/") for each in made):
                yield f"{command}: nothing makes {path}"
    yield from options_faults(words, build)
    made |= {words[place + 1] for place, word in enumerate(words[:-1]) if word in ("--out", "--picture", "--screenshot")}


def demo_faults(demo, made):
    """What the demo says of files that it does not make, and numbers in it that its commands do not have."""
    numbers = set(re.findall(r"--frames? (\d+)", demo))
    for path, words in CLAIM.findall(demo):
        if not any(path.rstrip("/") == each or path.startswith(f"{each}/") for each in made):
            yield f"scripts/demo.sh: nothing makes {path}"
        for number in re.findall(r"\b\d+\b", words):
            if number not in numbers:
                yield f"scripts/demo.sh: says {number} of {path}, but no command has --frame or --frames {number}"


def claimed_files_faults():
    """What the demo names and has not made."""
    for path, words in CLAIM.findall((ROOT / "scripts" / "demo.sh").read_text("utf-8")):
        if not (ROOT / path).exists():
            yield f"scripts/demo.sh: has not made {path}"
        elif path.endswith("/"):
            num_files, num_claimed = len(list((ROOT / path).iterdir())), int(words.split()[0])
            if num_files != num_claimed:
                yield f"scripts/demo.sh: has made {num_files} files in {path} and says {num_claimed}"


def faults(text, build):
    demo = (ROOT / "scripts" / "demo.sh").read_text("utf-8")
    built = outputs_of(build, [target for line in STAGE.findall(demo) for target in targets_of(line)])
    made = set(re.findall(r"(?:--out|--picture|--screenshot) (out/[\w./]+)", demo.replace("\\\n ", "")))
    yield from demo_faults(demo, made)
    is_all_built = False
    for kind, block in BLOCK.findall(text):
        for command in commands_of(block) if kind == "sh" else ():
            if command.startswith(BUILD_SCRIPT):
                built |= outputs_of(build, targets_of(command))
                is_all_built = True
            if "railcast-generate" in command and "railcast-generate sequence" not in command and not is_all_built:
                yield f"{command}: the demo builds railcast-generate with its command sequence alone"
            yield from command_faults(command, build, built, made)
        for path in re.findall(r'"(out/[^"]*|scenarios/[^"]*)"', block) if kind == "python" else ():
            if not (ROOT / path).exists() and not any(path.startswith(f"{each}/") for each in made):
                yield f"python: nothing makes {path}"
    yield from install_faults(build, built)
    if PYTHONPATH in text and not any(re.fullmatch(r"python/railcast/_railcast\..*so", file) for file in built):
        yield f"PYTHONPATH={PYTHONPATH}: the module is not built"


def shell_of(block):
    """A block of shell as it is run."""
    for command in commands_of(block):
        for contained, instead in INSTEAD:
            if contained in command:
                block = block.replace(command, ":" if instead is None else instead.format(command), 1)
                break
    return block + "\nwait\n"


def run_all(text, build):
    """Runs all blocks one after another and yields the faults."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "build").mkdir()
        (folder / "out").mkdir()
        (folder / PLACE).symlink_to(build)
        (folder / "scenarios").symlink_to(ROOT / "scenarios")
        (folder / "out" / "demo").symlink_to(ROOT / "out" / "demo")
        environment = {**os.environ, "PYTHONPATH": str(build / "python")}
        commands = [["bash", "-euo", "pipefail", "-c", shell_of(block)] if kind == "sh" else
                    ["/usr/bin/python3", "-c", block] for kind, block in BLOCK.findall(text)]
        commands.append(["cmake", "--install", PLACE, "--prefix", str(folder / "installed")])
        for command in commands:
            print(command[-1], flush=True)
            ended = subprocess.run(command, cwd=folder, env=environment, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True, check=False)
            if ended.returncode != 0:
                yield f"exit status {ended.returncode} of\n{command[-1]}\n{ended.stdout}"


def main(arguments):
    is_run = "--run" in arguments
    rest = [argument for argument in arguments if argument != "--run"]
    build = pathlib.Path(rest[0] if rest else ROOT / PLACE).resolve()
    text = (ROOT / "README.md").read_text("utf-8")
    found = [*claimed_files_faults(), *run_all(text, build)] if is_run else list(faults(text, build))
    for fault in found:
        print(fault, file=sys.stderr)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
