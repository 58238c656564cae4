"""Runs every command of every program once, to its end, and opens all that it wrote: every_command_test.py BUILD_DIR.

The commands are those that the programs' --help lists: one without a row here is a fault. Each row's inputs are what the
rows above it have made. Ends with 77 if what draws or typesets on a server is not installed.
"""

import csv
import html.parser
import json
import pathlib
import shutil
import socket
import sqlite3
import struct
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree

SKIPPED = 77  # For ctest.
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "packaging"))
sys.dont_write_bytecode = True
import help_text  # noqa: E402 (found through the line above)

PROGRAMS = {"railcast-generate": "generator", "railcast-import": "generator", "railcast-analyze": "analysis",
            "railcast-view": "viewer"}
TOOLS = ("xvfb-run", "weasyprint")

# The command, its arguments, files that it must write or words that it must print, and a program that runs beside it:
# what receives, or a line to be sent to it.
ROWS = (
    ("railcast-generate check", "drive.json --resolved resolved.json", ["resolved.json"], None),
    ("railcast-generate sequence", "drive.json --frames 40 --out drive", ["drive/frames/000039.pcd"], None),
    ("railcast-generate sequence", "coarse.json --frames 8 --out again --picture again.png", ["again/poses.csv", "again.png"],
     None),
    ("railcast-generate trace", "drive.json --frame 3 --firing 900", "frame 3 firing 900", None),
    ("railcast-generate world", "drive.json --from-s 100 --to-s 110 --out world.glb", ["world.glb"], None),
    ("railcast-generate insert", "drive plan.json --frames 3 --out inserted", ["inserted/insert.jsonl"], None),
    ("railcast-generate survey", "drive --frames 5 --out site", ["site/world.json", "site/scene.survey"], None),
    ("railcast-generate dataset", "recipe.json --shard 1/2 --out shards/1", ["shards/1/scenarios.jsonl"], None),
    ("railcast-generate dataset", "recipe.json --shard 2/2 --out shards/2", ["shards/2/scenarios.jsonl"], None),
    ("railcast-generate merge", "shards/1 shards/2 --out set", ["set/report.json"], None),
    ("railcast-generate stream", "standing.json --protocol vlp16 --duration 0.4 --pcap standing.pcap",
     ["standing.pcap"], None),
    ("railcast-generate replay", "drive --rate 20 --to 127.0.0.1:PORT", ["arrived/frames.csv"],
     ("railcast-analyze receive", "127.0.0.1:PORT --frames 5 --out arrived")),
    ("railcast-generate import", "map.geojson --out line", ["line/line.world.json"], None),
    ("railcast-import import", "map.geojson --out line_again", ["line_again/line.world.json"], None),
    ("railcast-analyze verify", "drive", "drive: whole", None),
    ("railcast-analyze stats", "drive --out stats", ["stats/report.html", "stats/stats.json"], None),
    ("railcast-analyze card", "set --out card", ["card/README.md"], None),
    ("railcast-analyze compare", "again again --out compare", ["compare/report.html", "compare/compare.json"], None),
    ("railcast-analyze detect", "drive --out detect", ["detect/report.html", "detect/detect.json"], None),
    ("railcast-analyze evaluate", "drive --out evaluate", ["evaluate/report.html", "evaluate/evaluate.json"], None),
    ("railcast-analyze collect", "127.0.0.1:PORT --frames 1 --out mine.jsonl", ["mine.jsonl"],
     ("", '{"frame": 0, "detections": []}')),
    ("railcast-analyze sight", "drive.json --step-m 50 --out sight", ["sight/report.html", "sight/sight.json"], None),
    ("railcast-analyze study", "study.json --out study", ["study/report.html", "study/study.json"], None),
    ("railcast-analyze dossier", "study --out dossier", ["dossier/dossier.pdf", "dossier/report.html"], None),
    ("railcast-analyze fit", "standing.pcap --scenario standing.json --out fit", ["fit/report.html", "fit/fitted.json"], None),
    ("railcast-analyze frontier", "coarse.json --frames 1 --rows geometry,surface --out frontier",
     ["frontier/report.html", "frontier/frontier.csv"], None),
    ("railcast-analyze preset", "standing.pcap --scenario standing.json --out preset", ["preset/preset.json"], None),
    ("railcast-analyze receive", "127.0.0.1:PORT --frames 2 --out arrived_again", ["arrived_again/frames.csv"],
     ("railcast-generate replay", "drive --rate 20 --to 127.0.0.1:PORT")),
    ("railcast-view", "drive --frame 20 --show boxes,track --size 320x200 --screenshot view.png", ["view.png"], None),
)

LINE = {"alignment": {"course": {"type": "elements", "elements": [{"type": "straight", "length_m": 400}]}},
        "vegetation": {"trees_per_hectare": 0, "grass": False}, "catenary": {"enabled": False},
        "terrain": {"half_width_m": 20}}
SHARED = {"materials": str(ROOT / "scenarios/materials/railway.json"), "labels": str(ROOT / "scenarios/labels.json")}
PERSON = {"name": "person", "type": "person", "s_m": 160}
# A raster of 7,200 beams drives towards a person on the track.
DRIVE = {"version": 1, "fidelity": "surface", **SHARED,
         "lidar": {"name": "raster", "range_max_m": 100, "mount": {"position_m": [2.2, 0, 2.5]},
                   "scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 60,
                                                       "vertical_fov_deg": 30, "angular_resolution_deg": 0.5}}},
         "world": {**LINE, "objects": [PERSON]},
         "vehicle": {"start_s_m": 100, "may_overlap": True, "motion": {"profile": [{"time_s": 0, "speed_mps": 10}]}}}
INPUTS = {
    "drive.json": DRIVE,
    "coarse.json": {**DRIVE, "lidar": {**DRIVE["lidar"], "scan": {"rate_hz": 10, "pattern": {
        "type": "raster", "horizontal_fov_deg": 60, "vertical_fov_deg": 30, "angular_resolution_deg": 2}}}},
    # Walls all around, so that there are planes to fit and to compare.
    "standing.json": {**DRIVE, "lidar": {"file": str(ROOT / "scenarios/sensors/vlp16.json"),
                                         "mount": {"position_m": [2.2, 0, 2.5]}},
                      "world": {**LINE, "objects": [
                          {"name": f"wall {number}", "type": "box", "size_m": size, "s_m": s_m, "d_m": d_m}
                          for number, (size, s_m, d_m) in enumerate((([0.5, 30, 10], 120, 0), ([0.5, 30, 10], 85, 0),
                                                                     ([40, 0.5, 10], 100, 12), ([40, 0.5, 10], 100, -12)))]},
                      "vehicle": {"start_s_m": 100, "may_overlap": True}},
    "plan.json": {"version": 1, "fidelity": "surface", **SHARED,
                  "world": {"recording": {}, "objects": [
                      {"name": "box", "type": "box", "size_m": [1, 1, 1], "s_m": 15, "d_m": 2}]}},
    "recipe.json": {"version": 1, "seed": 5, "num_scenarios": 4, "num_frames": 30, "bases": [{"file": "coarse.json"}],
                    "set": {"/world/objects": []},
                    "groups": [{"name": "weather", "options": [{"name": "clear", "set": {"/weather": {}}},
                                                               {"name": "fog", "set": {"/weather": {"visibility_m": 60}}}]}],
                    "objects": [{"name": "person", "count": {"type": "choice", "values": [1]},
                                 "object": {"type": "person"}, "draws": {"/d_m": {"type": "uniform", "min": -1, "max": 1}},
                                 "ahead_m": {"type": "uniform", "min": 40, "max": 60}, "gauge": "foul"}]},
    "study.json": {"version": 1, "question": "Seen?", "recipe": "recipe.json"},
    "map.geojson": {"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"railway": "rail", "maxspeed": "80"},
         "geometry": {"type": "LineString", "coordinates": [[15.6 + 0.0005 * i, 48.2] for i in range(60)]}}]},
}


def check(is_right, rule):
    if not is_right:
        raise ValueError(rule)


def open_rows(data):
    rows = list(csv.reader(data.decode().splitlines()))
    check(len({len(row) for row in rows}) == 1, "must have rows of one length")


def open_html(data):
    parser = html.parser.HTMLParser()
    parser.feed(data.decode())
    parser.close()
    check(data.rstrip().endswith(b"</html>"), "must end")


def open_png(data):
    check(data.startswith(b"\x89PNG\r\n\x1a\n") and data.endswith(b"IEND\xaeB`\x82"), "must be a whole PNG")


def open_pdf(data):
    check(data.startswith(b"%PDF-") and data.rstrip().endswith(b"%%EOF"), "must be a whole PDF")


def open_pcd(data):
    head, body = data.split(b"\nDATA binary\n", 1)
    fields = dict(line.split(b" ", 1) for line in head.splitlines() if line[:1] != b"#")
    size = sum(int(each) for each in fields[b"SIZE"].split())
    check(len(body) == size * int(fields[b"POINTS"]) > 0, "must have as many points as its header says")


def open_pcap(data):
    at, num_packets = 24, 0
    while at < len(data):
        at += 16 + struct.unpack_from("<I", data, at + 8)[0]
        num_packets += 1
    check(at == len(data) and num_packets > 100, "must hold whole packets")


def open_glb(data):
    length, json_length = struct.unpack_from("<II", data, 8)
    check(length == len(data) and json.loads(data[20:20 + json_length])["meshes"], "must be a whole glTF")


def open_database(data):
    with tempfile.NamedTemporaryFile() as file:
        file.write(data)
        file.flush()
        check(sqlite3.connect(file.name).execute("PRAGMA integrity_check").fetchone() == ("ok",), "must be whole")


def open_something(data):
    check(data, "must not be empty")


OPENERS = {".json": json.loads, ".jsonl": lambda data: [json.loads(line) for line in data.splitlines()],
           ".csv": open_rows, ".html": open_html, ".svg": xml.etree.ElementTree.fromstring, ".png": open_png,
           ".pdf": open_pdf, ".pcd": open_pcd, ".pcap": open_pcap, ".glb": open_glb, ".sqlite": open_database,
           ".md": bytes.decode, ".txt": bytes.decode, ".npy": open_something, ".survey": open_something,
           ".gnuplot": bytes.decode}


def words_of(command, arguments, build, port):
    program, _, subcommand = command.partition(" ")
    words = [build / PROGRAMS[program] / program, *subcommand.split(), *arguments.replace("PORT", str(port)).split()]
    return ["xvfb-run", "-a", "-s", "-noreset", *words] if program == "railcast-view" else words


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


def wait_for_receiver(port, receiver):
    """Until a program listens at this UDP port."""
    while f":{port:04X} " not in pathlib.Path("/proc/net/udp").read_text() and receiver.poll() is None:
        time.sleep(0.02)


def is_receiving(command):
    return command in ("railcast-analyze receive", "railcast-analyze collect")


def run_beside(command, arguments, beside, build, folder):
    """Runs a command with another one, or while a line is sent to it; the receiving one begins first."""
    port = free_port()
    other, text = beside
    both = [(command, arguments)] + ([(other, text)] if other else [])
    both.sort(key=lambda each: not is_receiving(each[0]))
    running = subprocess.Popen(words_of(*both[0], build, port), cwd=folder, text=True, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT)
    try:
        wait_for_receiver(port, running)
        if other:
            ended = subprocess.run(words_of(*both[1], build, port), cwd=folder, text=True, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, check=False)
            check(ended.returncode == 0, f"{both[1][0]}: exit status {ended.returncode}: {ended.stdout}")
        else:
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
                sender.sendto(text.encode(), ("127.0.0.1", port))
        return running.communicate(timeout=60)[0], running.returncode
    finally:
        running.kill()


def run_row(row, build, folder):
    """What a row does wrong."""
    command, arguments, expected, beside = row
    before = set(folder.rglob("*"))
    if beside:
        try:
            said, status = run_beside(command, arguments, beside, build, folder)
        except (ValueError, subprocess.TimeoutExpired) as fault:
            yield str(fault)
            return
    else:
        ended = subprocess.run(words_of(command, arguments, build, 0), cwd=folder, text=True, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, check=False)
        said, status = ended.stdout, ended.returncode
    if status != 0:
        yield f"exit status {status}: {said}"
        return
    if isinstance(expected, str) and expected not in said:
        yield f"must print {expected} (got {said})"
    for name in expected if isinstance(expected, list) else ():
        if not (folder / name).is_file():
            yield f"must write {name}"
    for path in sorted(set(folder.rglob("*")) - before):
        if path.is_file():
            try:
                OPENERS[path.suffix](path.read_bytes())
            except (ValueError, KeyError, struct.error, sqlite3.Error, xml.etree.ElementTree.ParseError) as fault:
                yield f"{path.relative_to(folder)}: cannot be opened: {fault!r}"


def listed_commands(build):
    """Those that the programs' --help lists."""
    for program, place in PROGRAMS.items():
        if (build / place / program).exists():
            shown = subprocess.run([build / place / program, "--help"], check=True, text=True, stdout=subprocess.PIPE)
            names = help_text.read_help([program], shown.stdout)[1]
            yield from (f"{program} {name}" for name in names) if names else (program,)


def main(build):
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if missing:
        print(f"skipped: {' and '.join(missing)} is not installed")
        return SKIPPED
    listed = set(listed_commands(build))
    faults = [f"{command}: has no row in {__file__}" for command in sorted(listed - {row[0] for row in ROWS})]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for file, content in INPUTS.items():
            (folder / file).write_text(json.dumps(content), "utf-8")
        (folder / "shards").mkdir()
        for row in ROWS:
            if row[0] in listed:
                faults += [f"{row[0]} {row[1]}: {fault}" for fault in run_row(row, build, folder)]
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
