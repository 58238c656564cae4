"""Runs the command lines of README and of the pages in docs/, and opens what they write: page_commands_test.py BUILD_DIR.

Each page's shell blocks are run as they are written, one after another, in a folder of the page's own. There the
programs' names are those of run_small.py, which runs them at their smallest size. Scenarios that are shipped are small
ones, as are files that readers are meant to have. Synopses, `command SCENARIO [--option]`, are run without what is in
brackets; the options there must exist. page_tables.py says what stands for what, and what is not run for which reason.
"""

import ctypes
import fcntl
import itertools
import json
import os
import pathlib
import re
import resource
import shutil
import socket
import struct
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "dev"))
import check_bytes  # noqa: E402
import open_files  # noqa: E402
import page_tables  # noqa: E402
import run_small  # noqa: E402
import small_runs  # noqa: E402 (found through the line above)

SKIPPED = 77  # For ctest.
CLONE_NEWUSER, CLONE_NEWNET, SIOCSIFFLAGS, IFF_UP = 0x10000000, 0x40000000, 0x8914, 1  # Of Linux.
BLOCK = re.compile(r"^```(sh|)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
INDENTED = re.compile(r"^    (railcast-.*)$", re.MULTILINE)
BRACKETS = re.compile(r"\[[^][]*\]")
LONG = {"alignment": {"course": {"type": "elements", "elements": [{"type": "straight", "length_m": 1000}]}}}
BLOCK_LIMIT_S = 120
# Ends what a block has left running, as Ctrl-C would, and asks for its exit status.
TERMINATED = 143  # Of a program that had not yet said what it does then.
END = ("jobs=$(jobs -p); for job in $jobs; do kill $job 2> /dev/null || true; done; "
       f"for job in $jobs; do wait $job || test $? = {TERMINATED}; done\n")


def logical_lines(body):
    """The lines of a block without a language, with those that a deeper indentation continues."""
    lines = []
    for line in body.splitlines():
        if line.startswith(" ") and lines:
            lines[-1] += f" {line.strip()}"
        else:
            lines.append(line)
    return lines


def blocks_of(text):
    """The shell of a page; of blocks without a language only railcast's commands count."""
    yield from INDENTED.findall(text)
    for language, body in BLOCK.findall(text):
        if language == "sh":
            yield body
        else:
            commands = [line for line in logical_lines(body) if re.match(r"(railcast-[a-z]+|ros2|examples/\w+\.py) ", line)]
            if commands:
                yield "\n".join(commands) + "\n"


def synopsis_faults(line, build):
    """Options in a synopsis that the program's help does not have."""
    words = line.split()
    program = pathlib.Path(words[0]).name
    command = [words[1]] if len(words) > 1 and re.fullmatch("[a-z]+", words[1]) else []
    asked = [build / small_runs.PROGRAMS[program] / program, *command, "--help"]
    shown = subprocess.run(asked, text=True, stdout=subprocess.PIPE, check=False).stdout
    for option in re.findall(r"--[a-z][-a-z]*", line):
        if not re.search(rf"(?<!\S){option}\b(?!-)", shown.replace(",", " ")):
            yield f"{line}: {program} {' '.join(command)} has no option {option}"


def without_brackets(line):
    while BRACKETS.search(line):
        line = BRACKETS.sub("", line)
    return line.replace("...", "")


def stood_in(line, numbers):
    """A line with what takes the place of the reader's things, and with an end of streams for which it waits."""
    for pattern, instead in page_tables.WORDS:
        line = re.sub(pattern, instead, line)
    while "@N" in line:
        line = line.replace("@N", str(next(numbers)), 1)
    command = line.split(" #")[0].rstrip()
    if " stream " in command and "--duration" not in command and not command.endswith("&"):
        line = f"{command} --duration 0.3"
    return line


def shell_of(body, page, numbers, used, build):
    """(shell to run, faults) of a block."""
    lines, faults = [], []
    for line in body.splitlines():
        command = line.split(" #")[0].rstrip()
        if re.match(r"(build/release/\w+/)?railcast-", command) and (BRACKETS.search(command) or "..." in command):
            faults += synopsis_faults(command, build)
            line = without_brackets(command)
        start = next((each for each in page_tables.LEFT_OUT.get(page, ()) if command.startswith(each)), None)
        if start:
            used.add((page, start))
            line = ":"
        elif re.search(r"\brailcast-[a-z]+ ", line):
            line = stood_in(line, numbers)
        elif line.startswith("examples/"):
            line = re.sub(r"--frames \d+", f"--frames {run_small.MOST_FRAMES}", line)
        lines.append(line)
    return "\n".join([*lines, END]), faults


def small_scenarios(folder):
    """The shipped files, with small scenarios, recipes and studies in the place of those that take long."""
    coarse = small_runs.COARSE
    small = dict.fromkeys(check_bytes.shipped_scenarios(), coarse)
    small[pathlib.Path("scenarios/brake_wagon.json")] = {**coarse, "output": {"frame": "vehicle"}}
    names = {"two_sensors.json": "two.json", "tunnel_motion.json": "rig.json", "minimal.json": "rig.json"}
    small |= {pathlib.Path("scenarios") / name: small_runs.INPUTS[file] for name, file in names.items()}
    for path in (ROOT / "scenarios").rglob("*"):
        place = path.relative_to(ROOT)
        (folder / place).parent.mkdir(parents=True, exist_ok=True)
        if path.is_dir():
            continue
        if place in small:
            above = "/".join([".."] * (len(place.parts) - 2) or ["."])
            content = json.dumps(small[place]).replace('"scenarios/', f'"{above}/')
            (folder / place).write_text(content)
        elif place.parts[1] == "recipes":
            bases = [{"file": "../minimal.json"}]
            (folder / place).write_text(json.dumps(small_runs.INPUTS["recipe.json"] | {"bases": bases}))
        elif place.parts[1] == "studies" and not place.stem.endswith("_recipe"):
            recipe = {**small_runs.INPUTS["study.json"], "recipe": "../recipes/small.json"}
            (folder / place).write_text(json.dumps(recipe))
        elif place == pathlib.Path("scenarios/insert/recipe.json"):
            split = {"by": "scenario", "train": 0.5, "val": 0.25, "test": 0.25}
            (folder / place).write_text(json.dumps(json.loads(path.read_text()) | {"num_scenarios": 4, "split": split}))
        else:
            (folder / place).symlink_to(path)


def make_programs(folder, build):
    """Programs by their names and by their places in the build's folder, and what stands for those that are not run."""
    here = f'#!/bin/sh\nexec /usr/bin/python3 -B {run_small.__file__} {build} "$0" "$@"\n'
    nothing = "#!/bin/sh\nexit 0\n"
    places = ("generator", "analysis", "viewer", "tests/bench")
    programs = [path for place in places for path in (build / place).glob("railcast-*")]
    texts = {f"bin/{path.name}": here for path in programs}
    texts |= {f"build/release/{path.relative_to(build)}": here for path in programs}
    for name in itertools.chain(*page_tables.OTHERS.values()):
        texts[name if "/" in name or "." in name else f"bin/{name}"] = nothing
    for name, text in texts.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
        (folder / name).chmod(0o755)
    for tool in page_tables.SHELL_TOOLS:
        path = shutil.which(tool, path="/usr/bin:/bin")
        if path:
            (folder / "bin" / tool).symlink_to(path)
    (folder / "build/release/python").symlink_to(build / "python")
    for source in [*(ROOT / "scripts").glob("*.py"), *(ROOT / "examples").iterdir()]:
        place = folder / source.relative_to(ROOT)
        place.parent.mkdir(exist_ok=True)
        if not place.exists():
            place.symlink_to(source)
    (folder / "core").symlink_to(ROOT / "core")


def make_stand_ins(build, folder):
    """What the readers have, made by those rows of small_runs.py that need no other."""
    small_runs.make_inputs(build, folder)
    made = {"drive", "again", "shards/1", "shards/2", "set", "standing.pcap", "study", "inserted", "formats/mcap",
            "formats/rosbag2", "formats/kitti", "live/brakes.jsonl"}
    for row in small_runs.all_rows(build):
        if made & set(re.findall(r"--(?:out|pcap|commands-log) (\S+)", row[1])):
            said, status = small_runs.run_row(row, build, folder)
            if status:
                raise RuntimeError(f"{row[0]} {row[1]}: {said}")
    for name, file in page_tables.READERS.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).symlink_to(folder / file)
    (folder / "detected.jsonl").write_text('{"frame": 0, "detections": []}\n')
    tiny = {**small_runs.DRIVE, "lidar": {**small_runs.DRIVE["lidar"], "scan": small_runs.raster(5)},
            "world": {**small_runs.DRIVE["world"], **LONG, "terrain": {}}}
    (folder / "tiny.json").write_text(json.dumps(tiny))


def run_block(shell, folder):
    """What is wrong with a block, after its run."""
    environment = {**os.environ, "PATH": str(folder / "bin"), "PYTHONDONTWRITEBYTECODE": "1"}
    before = set(folder.rglob("*"))
    running = subprocess.Popen(["/bin/bash", "-eu", "-c", shell], cwd=folder, env=environment, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, start_new_session=True)
    try:
        said = running.communicate(timeout=BLOCK_LIMIT_S)[0]
    except subprocess.TimeoutExpired:
        os.killpg(running.pid, 9)
        said = f"does not end within {BLOCK_LIMIT_S} s: {running.communicate()[0]}"
    if running.returncode != 0:
        yield f"exit status {running.returncode} of\n{shell}\n{said}"
    yield from (fault for fault in open_files.faults_in(folder, before) if not fault.startswith("commands_run"))


def page_faults(page, build, stand_ins, used):
    """What is wrong with the commands of a page."""
    text = (ROOT / page).read_text("utf-8")
    blocks = list(blocks_of(text))
    if page in page_tables.RUN_ELSEWHERE:
        lines = (line for body in blocks for line in body.splitlines() if line.startswith("railcast-"))
        yield from (f"{page}: {fault}" for line in lines for fault in synopsis_faults(line.split(" #")[0], build))
        return
    if not blocks:
        return
    numbers = itertools.count(1)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name).resolve()
        for path in stand_ins.iterdir():
            (folder / path.name).symlink_to(path)
        (folder / "out").unlink()
        (folder / "out").mkdir()
        for path in (stand_ins / "out").iterdir():
            (folder / "out" / path.name).symlink_to(path)
        for body in blocks:
            shell, faults = shell_of(body, page, numbers, used, build)
            yield from (f"{page}: {fault}" for fault in [*faults, *run_block(shell, folder)])


def pages():
    manual = sorted(str(path.relative_to(ROOT)) for path in (ROOT / "docs").rglob("*.md") if path.parent.name != "notes")
    return ["README.md", "examples/README.md", "scenarios/README.md", *manual]


def leave_network():
    """Goes on in a network of its own, where that is permitted, since pages name ports that others may have."""
    user, group = os.getuid(), os.getgid()
    libc = ctypes.CDLL(None)
    if libc.unshare(CLONE_NEWNET) != 0:
        if libc.unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0:
            return
        for name, text in (("uid_map", f"{user} {user} 1"), ("setgroups", "deny"), ("gid_map", f"{group} {group} 1")):
            pathlib.Path("/proc/self", name).write_text(text)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        fcntl.ioctl(any_socket, SIOCSIFFLAGS, struct.pack("16sh", b"lo", IFF_UP))


def cpu_s():
    """What the programs that have ended took."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main(build, asked):
    if not shutil.which("xvfb-run"):
        print("skipped: xvfb-run is not installed")
        return SKIPPED
    small_runs.enter_display()
    leave_network()
    faults, used = [], set()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name).resolve()
        make_stand_ins(build, folder)
        (folder / "scenarios").unlink()
        small_scenarios(folder)
        make_programs(folder, build)
        for page in asked or pages():
            begin_s = cpu_s()
            found = list(page_faults(page, build, folder, used))
            print(f"{cpu_s() - begin_s:6.2f} CPU s  {page}", *found, sep="\n", flush=True)
            faults += found
    unused = {(page, line) for page, lines in page_tables.LEFT_OUT.items() for line in lines} - used
    for page, line in sorted(unused) if not asked else ():
        faults.append(f"{page}: has no line that begins with {line}")
        print(faults[-1])
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]))
