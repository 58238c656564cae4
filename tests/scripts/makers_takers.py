"""Which command takes what which command makes: makers_takers.py BUILD_DIR [--write].

Makes one small recording of each kind by the runs of scripts/dev/small_runs.py and gives it to every command that takes
recordings. Each must work, or refuse it in one line that says what is missing. The table in
docs/results/makers_and_takers.md must be what was found; --write writes it. Ends with 77 if what draws on a server is not installed.
"""

import concurrent.futures
import contextlib
import io
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import traceback

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts" / "dev"), str(ROOT / "scripts")]
import small_runs  # noqa: E402 (found through the line above)

SKIPPED = 77  # For ctest.
PAGE = ROOT / "docs" / "results" / "makers_and_takers.md"
BEGIN, END = "<!-- table -->\n", "<!-- end of table -->\n"

# (name in the table, what is given to the takers, the runs that make it)
MAKERS = (
    ("sequence, `pcd`", "drive", ("generate sequence drive.json --frames 12 --out drive",)),
    ("sequence, `ply`", "ply", ("generate sequence rig.json --frames 3 --format ply --out ply",)),
    ("sequence, `kitti`", "kitti", ("generate sequence rig.json --frames 3 --format kitti --out kitti",)),
    ("sequence, `objects`", "objects", ("generate sequence rig.json --frames 3 --format objects --out objects",)),
    ("sequence, `mcap`", "mcap", ("generate sequence rig.json --frames 3 --format mcap --out mcap",)),
    ("sequence, `rosbag2`", "rosbag2", ("generate sequence rig.json --frames 3 --format rosbag2 --out rosbag2",)),
    ("sequence, `osi`", "osi", ("generate sequence rig.json --frames 3 --format osi --out osi",)),
    ("several sensors", "two", ("generate sequence two.json --frames 3 --merged --out two",)),
    ("merged clouds", "two/merged", ()),
    ("clouds of others", "clouds", ("copy drive/frames clouds",)),
    ("KITTI of others", "kitti_of_others", ("copy kitti/sequences kitti_of_others/sequences",)),
    ("capture", "vlp16.pcap", ("generate stream sensor_vlp16.json --protocol vlp16 --duration 0.3 --pcap vlp16.pcap",)),
    ("bag", "mcap/frames.mcap", ()),
    ("insertion into a sequence", "in_sequence", ("generate insert drive plan.json --frames 0..2 --out in_sequence",)),
    ("insertion into KITTI", "in_kitti", ("generate insert kitti plan_rig.json --out in_kitti",)),
    ("insertion into clouds", "in_clouds", ("generate insert clouds plan_clouds.json --out in_clouds",)),
    ("insertion into a capture", "in_capture", ("generate insert vlp16.pcap plan_standing.json --out in_capture",)),
    ("insertion into a bag", "in_bag", ("generate insert mcap/frames.mcap plan_rig.json --out in_bag",)),
    ("received stream", "arrived", ("receive",)),
    ("converted clouds", "converted", ("generate convert vlp16.pcap converted",)),
    ("converted to a bag", "converted_bag/frames.mcap", ("generate convert kitti converted_bag --format mcap",)),
    ("run over a survey", "surveyed", ("generate survey drive --frames 5 --out site",
                                       "generate sequence surveyed.json --frames 3 --out surveyed",)),
    ("data set", "whole_set", ("generate dataset recipe_small.json --out whole_set",)),
    ("data set of insertions", "set_of_insertions", ("generate dataset recipe_plans.json --out set_of_insertions",)),
)

# (name in the table, the commands, with @ for the recording and OUT for what they write; the first that works counts)
TAKERS = (
    ("`stats`", "analyze stats @ --format json"),
    ("`inspect`", "analyze inspect @ --format json"),
    ("`view`", "view @ --size 160x100 --screenshot OUT.png"),
    ("`view --compare`", "view @ --compare @ --size 160x100 --screenshot OUT.png"),
    ("`railcast.open`", "python open"),
    ("`railcast.Dataset`", "python dataset"),
    ("`detect`", "analyze detect @ --format json"),
    ("`evaluate`", "analyze evaluate @ --format json"),
    ("`compare`", "analyze compare @ @ --format json"),
    ("`fit`", "analyze fit @ --scenario SCENARIO --format json", "analyze fit @ --format json"),
    ("`preset`", "analyze preset @ --scenario SCENARIO --out OUT"),
    ("`insert`", "generate insert @ PLAN --format pcd --out OUT", "generate insert @ PLAN --out OUT"),
    ("`convert`", "generate convert @ OUT --format ply"),
    ("`survey`", "generate survey @ --sensor-height 2.5 --out OUT", "generate survey @ --out OUT",
     "generate survey @ --standing --out OUT"),
    ("`replay`", "generate replay @ --rate-hz 50 --to 127.0.0.1:PORT", "generate replay @ --rate 50 --to 127.0.0.1:PORT",
     "generate replay @ --rate 50"),
    ("`verify`", "analyze verify @"),
    ("`card`", "analyze card @ --out OUT"),
    ("OSDaR", "script export_osdar.py @ --out OUT"),
    ("KITTI objects", "script export_kitti_objects.py OUT --train @"),
)
PYTHON = {
    "open": "import sys, railcast\nfor frame in railcast.open(sys.argv[1]): frame.points()\n",
    "dataset": "import sys, railcast\nset = railcast.Dataset(sys.argv[1])\nassert len(set) > 0\nset[0]\n",
}


INPUTS = {
    "recipe_small.json": {**small_runs.INPUTS["recipe.json"], "num_scenarios": 2, "num_frames": 2},
    "recipe_plans.json": {"version": 1, "seed": 5, "num_scenarios": 2, "num_frames": 2,
                          "bases": [{"file": "plan.json", "recordings": ["drive"]}],
                          "objects": [{"name": "box", "count": {"type": "choice", "values": [1]},
                                       "object": {"type": "box", "size_m": [1, 1, 1], "h_m": 0},
                                       "ahead_m": {"type": "uniform", "min": 15, "max": 30}}]},
    "plan_clouds.json": {**small_runs.INPUTS["plan_standing.json"], "lidar": small_runs.DRIVE["lidar"]},
    "surveyed.json": {**small_runs.DRIVE, "world": "site/world.json",
                      "vehicle": {"start_s_m": 1, "may_overlap": True}},
}


# The scenario of a recording's sensor, and a plan for it.
OF_OTHERS = {**dict.fromkeys(("drive", "in_sequence", "surveyed", "arrived", "whole_set", "two/merged"),
                             ("drive.json", "plan.json")),
             **dict.fromkeys(("clouds", "in_clouds"), ("drive.json", "plan_clouds.json")),
             **dict.fromkeys(("vlp16.pcap", "in_capture", "converted"), ("sensor_vlp16.json", "plan_standing.json"))}
REFUSALS = ("ValueError", "TypeError", "railcast._railcast.InputError")


def words_of(build, text):
    program, *words = text.split()
    return [str(build / small_runs.PROGRAMS[f"railcast-{program}"] / f"railcast-{program}"), *words]


def run(words, folder):
    ended = subprocess.run(words, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    return ended.returncode, ended.stderr


def run_python(text, words):
    """What run() gives, of a program in Python that is run here, because the start of one takes longer than its work."""
    sys.argv = words
    with tempfile.TemporaryFile("w+") as said, contextlib.redirect_stdout(io.StringIO()):
        before = os.dup(2)
        os.dup2(said.fileno(), 2)  # Of libraries, too.
        status = 0
        with contextlib.redirect_stderr(said):
            try:
                exec(compile(text, words[0], "exec"), {"__name__": "__main__"})  # pylint: disable=exec-used
            except SystemExit as ended:
                status = ended.code or 0
                if isinstance(status, str):
                    status = print(status, file=said) or 1
            except Exception:  # pylint: disable=broad-exception-caught  # What it is, the last line says.
                status = traceback.print_exc() or 1
        said.flush()
        os.dup2(before, 2)
        os.close(before)
        said.seek(0)
        return status, said.read()


def make(maker, build, folder):
    """Runs what makes a recording; what it prints if it fails."""
    for text in maker[2]:
        if text.startswith("copy "):
            _, source, target = text.split()
            shutil.copytree(folder / source, folder / target)
        elif text == "receive":
            said, status = small_runs.run_beside(
                "railcast-analyze receive", "127.0.0.1:PORT --frames 3 --out arrived",
                ("railcast-generate replay", "drive --rate 20 --to 127.0.0.1:PORT"), build, folder)
            if status != 0:
                raise RuntimeError(f"{maker[0]}: {said}")
        else:
            status, said = run(words_of(build, text), folder)
            if status != 0:
                raise RuntimeError(f"{maker[0]}: {text}: {said}")


def words_of_taker(text, recording, out, build):
    scenario, plan = OF_OTHERS.get(recording, ("rig.json", "plan_rig.json"))
    kind, *words = text.split()
    words = [{"@": recording, "PLAN": plan, "SCENARIO": scenario}.get(word, word.replace("OUT", out).replace(
        "PORT", str(small_runs.free_port()))) for word in words]
    return words if kind in ("python", "script") else words_of(build, " ".join([kind, *words]))


def take(maker, taker, build, folder):
    """None if the taker takes what the maker made, else the line with which it refuses it."""
    recording = maker[1]
    refusals = []
    for number, text in enumerate(taker[1:]):
        out = f"out/{MAKERS.index(maker)}_{TAKERS.index(taker)}_{number}"
        words = words_of_taker(text, recording, out, build)
        if text.startswith("python"):
            status, complaint = run_python(PYTHON[words[0]], [words[0], recording])
        elif text.startswith("script"):
            status, complaint = run_python((ROOT / "scripts" / words[0]).read_text(), words)
        else:
            status, complaint = run(words, folder)
        if status == 0:
            return None
        lines = complaint.strip().splitlines()
        if text.startswith("python"):  # What a program does not catch ends with the name and the text of the exception.
            lines = [said for name, _, said in (line.partition(": ") for line in lines[-1:]) if name in REFUSALS]
        if status != 1 or len(lines) != 1:
            raise RuntimeError(f"{' '.join(words)}: exit status {status}: {lines[-1:]}")
        refusals.append(lines[0])
    return refusals[-1].removeprefix("error: ").replace(str(folder), "").replace(recording, "RECORDING")


def page_of(found):
    """The page's table, and the lines with which takers refuse."""
    rows = ["| | " + " | ".join(taker[0] for taker in TAKERS) + " |", "|---" * (len(TAKERS) + 1) + "|"]
    for maker in MAKERS:
        cells = ["yes" if found[maker, taker] is None else "–" for taker in TAKERS]
        rows.append(f"| {maker[0]} | " + " | ".join(cells) + " |")
    text = "\n".join(rows) + "\n"
    for taker in TAKERS:
        said = {}
        for maker in MAKERS:
            if found[maker, taker] is not None:
                said.setdefault(found[maker, taker], []).append(maker[0])
        if said:
            text += f"\n{taker[0]} refuses\n\n" + "".join(
                f"- {', '.join(makers)}: `{line}`\n" for line, makers in said.items())
    return text


def main(build, writes):
    if not shutil.which("xvfb-run"):
        print("skipped: xvfb-run is not installed")
        return SKIPPED
    small_runs.enter_display()
    sys.path.insert(0, str(build / "python"))
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary).resolve()
        small_runs.make_inputs(build, folder)
        for name, content in INPUTS.items():
            (folder / name).write_text(json.dumps(content))
        (folder / "out").mkdir()
        for maker in MAKERS:
            make(maker, build, folder)
        cells = [(maker, taker) for maker in MAKERS for taker in TAKERS]
        with concurrent.futures.ProcessPoolExecutor(os.cpu_count(), initializer=os.chdir, initargs=(folder,)) as pool:
            results = [pool.submit(take, maker, taker, build, folder) for maker, taker in cells]
        faults = [f"{maker[0]} / {taker[0]}: {result.exception()}"
                  for (maker, taker), result in zip(cells, results) if result.exception()]
        if faults:
            print("\n".join(faults))
            return 1
        text = page_of(dict(zip(cells, (result.result() for result in results))))
    page = PAGE.read_text()
    begin, end = page.index(BEGIN) + len(BEGIN), page.index(END)
    if writes:
        PAGE.write_text(page[:begin] + text + page[end:])
    elif page[begin:end] != text:
        print(f"{PAGE} is not what was found; write it with --write:\n{text}")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), "--write" in sys.argv))
