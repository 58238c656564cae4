"""Runs of every command of every program at their smallest size, whose inputs are what the runs above them have made.

tests/scripts/every_command_test.py opens what they write; check_bytes.py says whether a change leaves all of it as it was.
"""

import json
import os
import pathlib
import socket
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "packaging"))
sys.dont_write_bytecode = True
import help_text  # noqa: E402 (found through the line above)

PROGRAMS = {"railcast-generate": "generator", "railcast-import": "generator", "railcast-analyze": "analysis",
            "railcast-view": "viewer"}
# Text that has what is not the same twice is in this folder: arrivals, times of commands, what else depends on a clock.
LIVE = "live"
XVFB_RUN = ("xvfb-run", "-a", "-s", "-noreset")
ON_DISPLAY = "RAILCAST_ON_DISPLAY"  # In the environment of what enter_display() began.

# The command, its arguments, files that it must write or words that it must print, and a program that runs beside it:
# what receives, or a line to be sent to it.
ROWS = (
    ("railcast-generate check", "drive.json --resolved resolved.json", ["resolved.json"], None),
    ("railcast-generate sequence", "drive.json --frames 40 --out drive --summary live/drive.json",
     ["drive/frames/000039.pcd", "live/drive.json"], None),
    ("railcast-generate sequence", "coarse.json --frames 8 --out again --picture again.png",
     ["again/poses.csv", "again.png"], None),
    ("railcast-generate sequence", "two.json --frames 2 --merged --out two", ["two/merged/frames/000001.pcd"], None),
    ("railcast-generate sequence", "rig.json --frames 1 --fields x,y,z,chainage_m,track_lateral_m,in_gauge --out fields",
     ["fields/frames/000000.pcd"], None),
    ("railcast-generate trace", "drive.json --frame 3 --firing 900", "frame 3 firing 900", None),
    ("railcast-generate world", "drive.json --from-s 100 --to-s 110 --out world.glb", ["world.glb"], None),
    ("railcast-generate world", "drive.json --from-s 100 --to-s 110 --out world.obj", ["world.obj"], None),
    ("railcast-generate world", "drive.json --from-s 100 --to-s 110 --out world.ply", ["world.ply"], None),
    ("railcast-generate insert", "drive plan.json --frames 0..2 --certify 10% --out inserted", ["inserted/insert.jsonl"], None),
    ("railcast-generate insert", "drive plan.json --frames 0..2 --check", "box", None),
    ("railcast-generate convert", "drive converted --frames 0..2 --format ply", ["converted/frames/000002.ply"], None),
    ("railcast-generate survey", "drive --frames 5 --out site", ["site/world.json", "site/scene.survey"], None),
    ("railcast-generate dataset", "recipe.json --shard 1/2 --out shards/1", ["shards/1/scenarios.jsonl"], None),
    ("railcast-generate dataset", "recipe.json --shard 2/2 --out shards/2", ["shards/2/scenarios.jsonl"], None),
    ("railcast-generate merge", "shards/1 shards/2 --out set", ["set/report.json"], None),
    ("railcast-generate dataset", "recipe.json --scenarios-only --out drawn", ["drawn/report.json"], None),
    ("railcast-generate dataset", "recipe_two.json --merged --out merged", ["merged/report.json"], None),
    ("railcast-generate stream", "standing.json --protocol vlp16 --duration 0.4 --pcap standing.pcap",
     ["standing.pcap"], None),
    ("railcast-generate stream", "drive.json --duration 0.3 --commands-port PORT --commands-log live/brakes.jsonl "
     "--summary live/stream.json", ["live/brakes.jsonl", "live/stream.json"], ("", '{"command": "brake"}')),
    ("railcast-generate sequence", "drive.json --frames 1 --commands live/brakes.jsonl --out live/brakes",
     ["live/brakes/commands.jsonl"], None),
    ("railcast-generate replay", "drive --rate 20 --to 127.0.0.1:PORT --summary live/replay.json", ["live/replay.json"],
     ("railcast-analyze receive", "127.0.0.1:PORT --frames 5 --out live/arrived")),
    ("railcast-generate import", "map.geojson --out line", ["line/line.world.json"], None),
    ("railcast-import import", "map.geojson --out line_again", ["line_again/line.world.json"], None),
    ("railcast-analyze verify", "drive", "drive: whole", None),
    ("railcast-analyze inspect", "again --for weather --out inspect", ["inspect/report.html", "inspect/inspect.json"], None),
    ("railcast-analyze inspect", "again --sensor-file found.json --format text", ["found.json"], None),
    ("railcast-analyze stats", "again --out stats", ["stats/report.html", "stats/stats.json"], None),
    ("railcast-analyze card", "set --out card", ["card/README.md"], None),
    ("railcast-analyze compare", "again again --out compare", ["compare/report.html", "compare/compare.json"], None),
    ("railcast-analyze compare", "--ablate coarse.json --frames 1 --out ablate", ["ablate/report.html"], None),
    ("railcast-analyze detect", "drive --out detect", ["detect/report.html", "detect/detect.json"], None),
    ("railcast-analyze evaluate", "drive --out evaluate", ["evaluate/report.html", "evaluate/evaluate.json"], None),
    ("railcast-analyze sight", "drive.json --step-m 50 --out sight", ["sight/report.html", "sight/sight.json"], None),
    ("railcast-analyze track", "drive --out track", ["track/mount.json", "track/track.json"], None),
    ("railcast-analyze study", "study.json --out study", ["study/report.html", "study/study.json"], None),
    ("railcast-analyze study", "rare.json --rare --out rare", "Not detected in time", None),
    ("railcast-analyze dossier", "study --out dossier", ["dossier/dossier.pdf", "dossier/report.html"], None),
    ("railcast-analyze fit", "standing.pcap --scenario standing.json --out fit", ["fit/report.html", "fit/fitted.json"],
     None),
    ("railcast-analyze frontier", "coarse.json --frames 1 --rows geometry,surface --out frontier",
     ["frontier/report.html", "frontier/frontier.csv"], None),
    ("railcast-analyze preset", "standing.pcap --scenario standing.json --out preset", ["preset/preset.json"], None),
    ("railcast-analyze preset", "standing.pcap --out receiver", ["receiver/preset.json"], None),
    ("railcast-analyze receive", "127.0.0.1:PORT --frames 2 --out live/arrived_again --summary live/receive.json",
     ["live/arrived_again/frames.csv", "live/receive.json"],
     ("railcast-generate replay", "drive --rate 20 --to 127.0.0.1:PORT")),
    ("railcast-view", "drive --frame 20 --show boxes,track --size 320x200 --screenshot view.png", ["view.png"], None),
    ("railcast-view", "drive --frame 20 --size 320x200 --frames 2 --video film", ["film/000001.png"], None),
)

LAYOUTS = ("railcast", "velodyne", "ouster", "hesai", "livox", "autoware")
# Of a protocol whose preset is not called as it is.
PRESETS = {"railcast": "vlp16", "vlp16-dual": "vlp16", "pandar128e4x-standard": "pandar128e4x_standard"}
# What is inserted into: one recording of each kind, of those that the rows make.
INSERTED = (("formats/pcd", "plan.json"), ("formats/pcd-ascii", "plan.json"), ("formats/pcd-compressed", "plan.json"),
            ("formats/ply", "plan.json"), ("formats/kitti", "plan_rig.json"), ("formats/mcap/frames.mcap", "plan_rig.json"),
            ("formats/rosbag2/rosbag2", "plan_rig.json"), ("captures/vlp16.pcap", "plan_standing.json"),
            ("captures/pandar64.pcap", "plan_standing.json"), ("captures/ouster.pcap", "plan_standing.json"))

LINE = {"alignment": {"course": {"type": "elements", "elements": [{"type": "straight", "length_m": 400}]}},
        "vegetation": {"trees_per_hectare": 0, "grass": False}, "catenary": {"enabled": False},
        "terrain": {"half_width_m": 20}}
SHARED = {"materials": "scenarios/materials/railway.json", "labels": "scenarios/labels.json"}
PERSON = {"name": "person", "type": "person", "s_m": 160}
MOUNT = {"position_m": [2.2, 0, 2.5]}


def raster(resolution_deg):
    return {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 60, "vertical_fov_deg": 30,
                                       "angular_resolution_deg": resolution_deg}}


# A raster of 7,200 beams drives towards a person on the track.
DRIVE = {"version": 1, "fidelity": "surface", **SHARED,
         "lidar": {"name": "raster", "range_max_m": 100, "mount": MOUNT, "scan": raster(0.5)},
         "world": {**LINE, "objects": [PERSON]},
         "vehicle": {"start_s_m": 100, "may_overlap": True, "motion": {"profile": [{"time_s": 0, "speed_mps": 10}]}}}
COARSE = {**DRIVE, "lidar": {**DRIVE["lidar"], "scan": raster(2)}}
# With all that a sequence writes beside clouds.
RIG = {**COARSE, "lidar": {**COARSE["lidar"], "receiver": {"return_mode": "dual"}, "plausibility": {"noise_shape": "beam"}},
       "weather": {"rain_rate_mmph": 20}, "motion_sensors": "scenarios/motion_sensors/mems.json",
       "camera": {"width_px": 64, "height_px": 48, "horizontal_fov_deg": 60, "rate_hz": 10, "mount": MOUNT}}
# Walls all around, so that there are planes to fit and to compare.
WALLS = [{"name": f"wall {number}", "type": "box", "size_m": size, "s_m": s_m, "d_m": d_m}
         for number, (size, s_m, d_m) in enumerate((([0.5, 30, 10], 120, 0), ([0.5, 30, 10], 85, 0), ([40, 0.5, 10], 100, 12),
                                                    ([40, 0.5, 10], 100, -12)))]
STANDING = {**DRIVE, "lidar": {"file": "scenarios/sensors/vlp16.json", "mount": MOUNT},
            "world": {**LINE, "objects": WALLS}, "vehicle": {"start_s_m": 100, "may_overlap": True}}
PLAN = {"version": 1, "fidelity": "surface", **SHARED,
        "world": {"recording": {}, "objects": [{"name": "box", "type": "box", "size_m": [1, 1, 1], "s_m": 15, "d_m": 2}]}}
OUSTER = {
    "sensor_info": {"prod_line": "OS-1-4", "prod_sn": "122201000998", "initialization_id": 7109750, "status": "RUNNING",
                    "image_rev": "ousteros-image-prod-bootes-v3.1.0+20240425131508"},
    "beam_intrinsics": {"beam_altitude_angles": [12.5, 4.25, -3.75, -11.0], "beam_azimuth_angles": [3.5, -3.5, 1.25, -1.25],
                        "lidar_origin_to_beam_origin_mm": 15.806},
    "imu_intrinsics": {"imu_to_sensor_transform": [1, 0, 0, 6.253, 0, 1, 0, -11.775, 0, 0, 1, 7.645, 0, 0, 0, 1]},
    "lidar_intrinsics": {"lidar_to_sensor_transform": [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1]},
    "config_params": {"lidar_mode": "512x10", "udp_dest": "169.254.29.215", "udp_port_lidar": 7502},
    "lidar_data_format": {"columns_per_frame": 512, "columns_per_packet": 16, "pixels_per_column": 4,
                          "column_window": [0, 511], "pixel_shift_by_row": [5, -5, 2, -2],
                          "udp_profile_lidar": "RNG19_RFL8_SIG16_NIR16", "udp_profile_imu": "LEGACY"},
    "calibration_status": {}}
INPUTS = {
    "drive.json": DRIVE, "coarse.json": COARSE, "rig.json": RIG, "standing.json": STANDING, "plan.json": PLAN,
    "two.json": {**{key: value for key, value in COARSE.items() if key != "lidar"},
                 "lidars": [{**COARSE["lidar"], "name": "front"},
                            {**COARSE["lidar"], "name": "roof", "mount": {"position_m": [1.5, 0, 4.1]}}]},
    "plan_rig.json": {**PLAN, "lidar": RIG["lidar"]},
    "plan_standing.json": {**PLAN, "world": {**PLAN["world"], "recording": {"poses": "standing"}}},
    "os1.json": OUSTER,
    "recipe.json": {"version": 1, "seed": 5, "num_scenarios": 4, "num_frames": 30, "bases": [{"file": "coarse.json"}],
                    "set": {"/world/objects": []},
                    "groups": [{"name": "weather", "options": [{"name": "clear", "set": {"/weather": {}}},
                                                               {"name": "fog", "set": {"/weather": {"visibility_m": 60}}}]}],
                    "objects": [{"name": "person", "count": {"type": "choice", "values": [1]},
                                 "object": {"type": "person"}, "draws": {"/d_m": {"type": "uniform", "min": -1, "max": 1}},
                                 "ahead_m": {"type": "uniform", "min": 40, "max": 60}, "gauge": "foul"}]},
    "recipe_two.json": {"version": 1, "seed": 5, "num_scenarios": 1, "num_frames": 2, "bases": [{"file": "two.json"}],
                        "set": {"/weather": {"visibility_m": 60}}},
    "study.json": {"version": 1, "question": "Seen?", "recipe": "recipe.json"},
    "rare.json": {"version": 1, "recipe": "recipe.json", "rare": {"per_stage": 100},
                  "braking": {"reaction_s": 1, "deceleration_mps2": 2, "margin_m": 2}},
    "map.geojson": {"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"railway": "rail", "maxspeed": "80"},
         "geometry": {"type": "LineString", "coordinates": [[15.6 + 0.0005 * i, 48.2] for i in range(60)]}}]},
}


def choices_of(build, option):
    """The values that the help of `PROGRAM COMMAND --OPTION` lists."""
    *words, name = option.split()
    shown = subprocess.run([build / PROGRAMS[words[0]] / words[0], *words[1:], "--help"], check=True, text=True,
                           stdout=subprocess.PIPE).stdout
    return next(each.choices() for each in help_text.read_help(words, shown)[0].options() if name in each.names)


def capture_rows(build):
    for protocol in choices_of(build, "railcast-generate stream --protocol"):
        if protocol != "ros2":  # Has no captures.
            calibration = " --calibration captures/hdl64e.xml" if protocol == "hdl64e" else ""
            yield ("railcast-generate stream", f"sensor_{protocol}.json --protocol {protocol} --duration 0.2{calibration} "
                   f"--pcap captures/{protocol}.pcap", [f"captures/{protocol}.pcap"], None)


def all_rows(build):
    """ROWS, and one each for every rung, format, layout of points and protocol, and kind of recording to insert into."""
    yield from ROWS
    for rung in choices_of(build, "railcast-generate sequence --fidelity"):
        yield ("railcast-generate sequence", f"rig.json --frames 1 --fidelity {rung} --out rungs/{rung}",
               [f"rungs/{rung}/frames/000000.pcd"], None)
    for kind in choices_of(build, "railcast-generate sequence --format"):
        yield ("railcast-generate sequence", f"rig.json --frames 2 --format {kind} --out formats/{kind}",
               [f"formats/{kind}/poses.csv"], None)
    for layout in LAYOUTS:
        yield ("railcast-generate sequence", f"rig.json --frames 1 --format mcap --fields {layout} --out layouts/{layout}",
               [f"layouts/{layout}/frames.mcap"], None)
    yield from capture_rows(build)
    for recording, plan in INSERTED:
        out = f"insertions/{recording.replace('/', '_')}"
        yield "railcast-generate insert", f"{recording} {plan} --out {out}", [f"{out}/insert.jsonl"], None


def sensor_of(protocol):
    if protocol == "ouster":
        return {"ouster_metadata": "os1.json", "mount": MOUNT}
    dual = {"receiver": {"return_mode": "dual"}} if protocol == "vlp16-dual" else {}
    return {"file": f"scenarios/sensors/{PRESETS.get(protocol, protocol)}.json", "mount": MOUNT, **dual}


def make_inputs(build, folder):
    """Writes what the rows begin with."""
    protocols = choices_of(build, "railcast-generate stream --protocol")
    sensors = {f"sensor_{name}.json": {**STANDING, "lidar": sensor_of(name)} for name in protocols if name != "ros2"}
    for file, content in {**INPUTS, **sensors}.items():
        (folder / file).write_text(json.dumps(content), "utf-8")
    for name in ("shards", "captures", LIVE):
        (folder / name).mkdir()
    (folder / "scenarios").symlink_to(ROOT / "scenarios")


def enter_display():
    """Begins the program anew on a display that all its runs of railcast-view share."""
    if ON_DISPLAY not in os.environ:
        os.environ[ON_DISPLAY] = "1"
        os.execvp(XVFB_RUN[0], [*XVFB_RUN, sys.executable, "-B", *sys.argv])


def words_of(command, arguments, build, port):
    program, _, subcommand = command.partition(" ")
    words = [build / PROGRAMS[program] / program, *subcommand.split(), *arguments.replace("PORT", str(port)).split()]
    return [*XVFB_RUN, *words] if program == "railcast-view" and ON_DISPLAY not in os.environ else words


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        return taken.getsockname()[1]


def wait_for_receiver(port, receiver):
    """Until a program listens at this UDP port."""
    while f":{port:04X} " not in pathlib.Path("/proc/net/udp").read_text() and receiver.poll() is None:
        time.sleep(0.02)


def is_receiving(command):
    return command == "railcast-analyze receive"


def run_words(words, folder):
    ended = subprocess.run(words, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    return ended.stdout, ended.returncode


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
            said, status = run_words(words_of(*both[1], build, port), folder)
            if status != 0:
                return f"{both[1][0]}: {said}", status
        else:
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
                sender.sendto(text.encode(), ("127.0.0.1", port))
        return running.communicate(timeout=60)[0], running.returncode
    finally:
        running.kill()


def run_row(row, build, folder):
    """(what is printed, exit status) of a row."""
    command, arguments, _, beside = row
    if beside:
        return run_beside(command, arguments, beside, build, folder)
    return run_words(words_of(command, arguments, build, 0), folder)
