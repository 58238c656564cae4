#!/usr/bin/env python3
"""Measures live runs on this machine, sender and receiver on loopback, as in
docs/results/live.md.

Usage: measure_live.py BUILD_DIR [steady|clients|limits|late|fast|certified]... [--seconds S]

steady: the published scan at 10 and 20 Hz, spread and in bursts: frames lost and late, lateness.
clients: VLP-16 at 20 Hz and HDL-32E at 10 Hz into PCL's own grabbers.
limits: the highest rate that each rung sustains without a late frame, in one of three tries: virtual
machines occasionally pause for tens of milliseconds.
late: the late frames of the most expensive runs, received on the same cores: VLS-128, and footprint on
the published scan, at 10 and 20 Hz; footprint and footprint_of, which gives a width to things alone, on
Pandar64, too. For two cores: taskset -c 0,1 measure_live.py BUILD_DIR late.
fast: the published scan at 10 Hz from a train at 160 km/h, on an open line, through hills and through
a station: what a frame takes, and how long the longest one, which waits for the world if any does.
certified: the published scan at 10 Hz, three times in turn without and with --certify 1%: a
frame's latency, from its last firing to its last datagram, what certificates take, and how many frames
have none for want of time. Only if it is named.
"""

import argparse
import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

SCENARIOS = pathlib.Path(__file__).resolve().parents[2] / "scenarios"
PUBLISHED_SCAN = {"type": "raster", "horizontal_fov_deg": 60, "vertical_fov_deg": 30,
                  "angular_resolution_deg": 0.25}
SUMMARY = re.compile(r"(\d+) frames?, (\d+) late; (\d+) datagrams, (\d+) bytes; to receivers "
                     r"(\d+) sent, (\d+) refused")
QUANTILES = re.compile(r"^  (compute|send|lateness) +([\d.]+) +([\d.]+) +([\d.]+) +([\d.]+) ms", re.M)
FEW_SUB_RAYS = {"footprint_rays": 16}
PLAIN = ("unlabeled", "ground", "ballast", "sleeper", "slab_track", "road", "grass", "bush", "tree")
NO_SURFACES = ("rain", "snow", "fog", "ego", "false_alarm", "halo", "spray", "mirror_image", "ghost")
WIDTH_WHERE_IT_MATTERS = {"footprint_of": [
    label["name"] for label in json.loads((SCENARIOS / "labels.json").read_text(encoding="utf-8"))["labels"]
    if label["name"] not in PLAIN + NO_SURFACES]}
# By the name that is printed: the rung, and keys of the sensor's beam.
RUNGS = {"geometry": ("geometry", {}), "plausibility": ("plausibility", {}), "surface": ("surface", {}),
         "footprint_of": ("footprint", WIDTH_WHERE_IT_MATTERS), "footprint_16": ("footprint", FEW_SUB_RAYS),
         "footprint": ("footprint", {})}


class Bench:
    """The programs under test."""

    def __init__(self, build, folder):
        self.generate = build / "generator" / "railcast-generate"
        self.analyze = build / "analysis" / "railcast-analyze"
        self.pcl_client = build / "tests" / "bench" / "pcl-client"
        self.folder = folder

    def scenario(self, lidar):
        """The demo scenario with another sensor, a longer drive, and no obstacle."""
        demo = json.loads((SCENARIOS / "st_gallen_approach.json").read_text(encoding="utf-8"))
        world = demo["world"]
        world["alignment"] = str(SCENARIOS / world["alignment"])
        world["objects"] = [each for each in world["objects"]
                            if "motion" not in each and each["name"] != "foul_wagon"]
        file = self.folder / "scenario.json"
        file.write_text(json.dumps({
            "version": 1, "file": str(SCENARIOS / "st_gallen_approach.json"), "lidar": lidar,
            "world": world,
            "vehicle": {"start_s_m": 2190,
                        "motion": {"profile": [{"time_s": 0, "speed_mps": 11.1}]}}}))
        return file

    def published(self, rate_hz, beam=None):
        return self.scenario({"file": str(SCENARIOS / "sensors" / "vir2rail.json"),
                              "mount": {"position_m": [2.2, 0, 2.5]}, "beam": beam or {},
                              "scan": {"rate_hz": rate_hz, "pattern": PUBLISHED_SCAN}})

    def spinning(self, name, rate_hz):
        """A preset that turns at another rate: at the same pace of firings, so with fewer or more columns."""
        file = SCENARIOS / "sensors" / name
        scan = json.loads(file.read_text(encoding="utf-8"))["scan"]
        columns = int(scan["pattern"]["columns"] * scan["rate_hz"] / rate_hz)
        return self.scenario({"file": str(file), "mount": {"position_m": [2.2, 0, 2.5]},
                              "scan": {"rate_hz": rate_hz, "pattern": {**scan["pattern"], "columns": columns}}})

    def sensor(self, name, beam=None):
        file = SCENARIOS / "sensors" / name
        lidar = {"file": str(file), "mount": {"position_m": [2.2, 0, 2.5]}}
        if beam:
            lidar["beam"] = {**json.loads(file.read_text(encoding="utf-8"))["beam"], **beam}
        return self.scenario(lidar)

    def stream(self, scenario, seconds, *options):
        """Runs the sender and returns its summary."""
        command = [self.generate, "stream", scenario, "--duration", str(seconds), *options]
        output = subprocess.run(list(map(str, command)), check=True, capture_output=True,
                                text=True).stdout
        frames, late, _, _, sent, refused = map(int, SUMMARY.search(output).groups())
        return {"frames": frames, "late": late, "sent": sent, "refused": refused,
                **{row[0]: [float(value) for value in row[1:]]
                   for row in QUANTILES.findall(output)}}

    def stream_and_receive(self, scenario, seconds, *options):
        receiver = subprocess.Popen([str(self.analyze), "receive"], stdout=subprocess.PIPE,
                                    text=True)
        try:
            sent = self.stream(scenario, seconds, *options)
        finally:
            receiver.send_signal(signal.SIGINT)
        return sent, receiver.communicate()[0]


def steady(bench, seconds):
    for rate_hz in (10, 20):
        for pacing in ("spread", "burst"):
            sent, received = bench.stream_and_receive(bench.published(rate_hz), seconds,
                                                      "--pacing", pacing)
            print(f"published scan, {rate_hz} Hz, {pacing}, {seconds:g} s: {sent['frames']} frames, "
                  f"{sent['late']} late, {sent['refused']} datagrams refused")
            for row in ("compute", "send", "lateness"):
                print(f"  {row}: p50 {sent[row][0]:.3f}, p99 {sent[row][2]:.3f}, "
                      f"max {sent[row][3]:.3f} ms")
            print("  " + received.strip().replace("\n", "\n  "), flush=True)


def clients(bench, seconds):
    for name, protocol, kind in (("vlp16_20hz.json", "vlp16", "vlp"),
                                 ("hdl32e.json", "hdl32e", "hdl")):
        client = subprocess.Popen([str(bench.pcl_client), kind, "127.0.0.1", "2368",
                                   str(seconds - 1)], stdout=subprocess.PIPE, text=True)
        sent = bench.stream(bench.sensor(name), seconds, "--protocol", protocol)
        print(f"{name}, {seconds:g} s: {sent['frames']} frames, {sent['late']} late; PCL: "
              f"{client.communicate()[0].strip()}", flush=True)


def limits(bench, seconds):
    for name, (rung, beam) in RUNGS.items():
        low_hz, high_hz = 4.0, 128.0
        while high_hz / low_hz > 1.1:
            rate_hz = (low_hz * high_hz) ** 0.5
            scenario = bench.published(rate_hz, beam)
            if any(bench.stream_and_receive(scenario, seconds, "--fidelity", rung)[0]["late"] == 0
                   for _ in range(3)):
                low_hz = rate_hz
            else:
                high_hz = rate_hz
        print(f"{name}: {low_hz:.0f} Hz for {seconds:g} s without a late frame", flush=True)


def late(bench, seconds):
    for name, rate_hz, scenario, rung in (
            ("VLS-128", 10, lambda: bench.sensor("vls128.json"), "surface"),
            ("VLS-128", 20, lambda: bench.spinning("vls128.json", 20), "surface"),
            ("published scan", 10, lambda: bench.published(10), "footprint"),
            ("published scan", 20, lambda: bench.published(20), "footprint"),
            ("published scan", 20, lambda: bench.published(20, FEW_SUB_RAYS), "footprint_16"),
            ("published scan", 10, lambda: bench.published(10, WIDTH_WHERE_IT_MATTERS), "footprint_of"),
            ("Pandar64", 10, lambda: bench.sensor("pandar64.json", WIDTH_WHERE_IT_MATTERS), "footprint_of"),
            ("Pandar64", 10, lambda: bench.sensor("pandar64.json"), "footprint")):
        sent, received = bench.stream_and_receive(scenario(), seconds, "--fidelity", RUNGS[rung][0])
        print(f"{name}, {rung}, {rate_hz} Hz, {seconds:g} s: {sent['frames']} frames, {sent['late']} late; "
              f"compute p50 {sent['compute'][0]:.1f}, p99 {sent['compute'][2]:.1f} ms; send p50 "
              f"{sent['send'][0]:.1f} ms; lateness p50 {sent['lateness'][0]:.2f}, p99 "
              f"{sent['lateness'][2]:.2f} ms")
        print("  " + received.strip().splitlines()[1], flush=True)


def fast(bench, seconds):
    for name in ("open_line.json", "hills.json", "osm_sankt_poelten/line.json"):
        file = bench.folder / "fast.json"
        vehicle = json.loads((SCENARIOS / name).read_text(encoding="utf-8"))["vehicle"]
        file.write_text(json.dumps({
            "version": 1, "file": str(SCENARIOS / name), "fidelity": "plausibility",
            "lidar": {"file": str(SCENARIOS / "sensors" / "vir2rail.json"),
                      "mount": {"position_m": [2.2, 0, 2.5]}},
            "vehicle": vehicle | {"motion": {"profile": [{"time_s": 0, "speed_mps": 160 / 3.6}]}}}))
        sent = bench.stream(file, seconds)
        print(f"{name}, 160 km/h, {seconds:g} s: {sent['frames']} frames, {sent['late']} late; compute "
              f"p50 {sent['compute'][0]:.1f}, p99 {sent['compute'][2]:.1f}, "
              f"max {sent['compute'][3]:.1f} ms", flush=True)


def certified(bench, seconds):
    for rung in ("plausibility", "footprint_16"):
        scenario = bench.published(10, RUNGS[rung][1])
        for certify in ("off", "1%") * 3:
            summary = bench.folder / "summary.json"
            sent, received = bench.stream_and_receive(
                scenario, seconds, "--fidelity", RUNGS[rung][0], "--pacing", "spread", "--clock", "utc",
                "--certify", certify, "--summary", summary)
            latency = re.search("latency since the last firing: (.*)", received).group(1)
            sensor = json.loads(summary.read_text(encoding="utf-8"))["sensors"][0]
            print(f"{rung}, --certify {certify}, {seconds:g} s: {sent['frames']} frames, {sent['late']} late; "
                  f"latency {latency}; certificates {sensor.get('certify_ms')}, "
                  f"{sensor.get('uncertified_frames', 0)} frames without", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("what", nargs="*", choices=["steady", "clients", "limits", "late", "fast", "certified", []])
    parser.add_argument("--seconds", type=float, help="of each run (default: 60, of limits 10, of fast 30)")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(options.build, pathlib.Path(folder))
        for name, measure, seconds in (("steady", steady, 60.0), ("clients", clients, 60.0),
                                       ("limits", limits, 10.0), ("fast", fast, 30.0)):
            if not options.what or name in options.what:
                measure(bench, options.seconds or seconds)
        if not options.what or "late" in options.what:
            late(bench, options.seconds or 60.0)
        if "certified" in options.what:
            certified(bench, options.seconds or 60.0)


if __name__ == "__main__":
    sys.exit(main())
