"""Simulates a turn where a real one was made: sensor, mount and tracks as they were found. A part of railway_frames.py."""

import json
import pathlib
import subprocess

import numpy as np

from railway_cloud import ARM_M, STEP_RAD, Turn

SCENARIOS = pathlib.Path(__file__).resolve().parents[2] / "scenarios"
STANDARD_GAUGE_MM = 1435
MOST_GAUGE_ERROR_MM = 40  # Of the heads' distance; what differs by more has another gauge.
HEAD_WIDTH_M = 0.072
START_M = 400.0  # The vehicle's chainage.
NOISES = ("range_noise", "channel_bias", "pointing_jitter", "range_walk")
NUMPY_TYPES = {("F", "4"): "<f4", ("F", "8"): "<f8", ("U", "1"): "u1", ("U", "2"): "<u2", ("U", "4"): "<u4", ("I", "1"): "i1",
               ("I", "2"): "<i2", ("I", "4"): "<i4", ("U", "8"): "<u8", ("I", "8"): "<i8"}


class ProgramError(Exception):
    """A program of railcast refused what it was given."""


def metadata(turn):
    """Ouster's description of a sensor with the turn's rings and window."""
    order = np.argsort(-turn.elevation_rad)
    last = turn.num_columns - 1
    return {"prod_line": "OS-1-64", "lidar_mode": "2048x10", "lidar_origin_to_beam_origin_mm": 1e3 * ARM_M,
            "beam_altitude_angles": [round(float(x), 4) for x in np.degrees(turn.elevation_rad[order])],
            "beam_azimuth_angles": [round(float(-x), 4) for x in np.degrees(turn.azimuth_rad[order])],
            "lidar_to_sensor_transform": [float(i % 5 == 0) for i in range(16)],
            "data_format": {"pixels_per_column": 64, "columns_per_frame": 2048, "columns_per_packet": 16,
                            "column_window": [0, last]}}


def turned(angle):
    return np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])


def to_ouster(turn):
    """The rotation into axes in which the last column is at the connector."""
    return turned(-turn.first_rad - (turn.num_columns - 1) * STEP_RAD)


def mount(turn, track):
    rotation = track.frame @ to_ouster(turn).T
    yaw, pitch = np.arctan2(rotation[1, 0], rotation[0, 0]), -np.arcsin(np.clip(rotation[2, 0], -1, 1))
    roll = np.arctan2(rotation[2, 1], rotation[2, 2])
    return {"position_m": [0, float(-sum(track.heads_m) / 2), float(track.height_m)], "yaw_deg": float(np.degrees(yaw)),
            "pitch_deg": float(np.degrees(pitch)), "roll_deg": float(np.degrees(roll))}


def lidar(turn, track):
    """The sensor with the published model's noise along the beam, so that its firings are known again."""
    return {"ouster_metadata": "sensor.json", "mount": mount(turn, track), "plausibility": {"noise_shape": "beam"}}


def world(track):
    """A straight line with the gauge, further tracks and platform that were found."""
    tracks = [{"name": "main"}] + [{"name": f"track_{i}", "offset_m": round(each, 3)} for i, each in enumerate(track.others_m)]
    section = {"alignment": {"course": {"type": "elements", "elements": [{"type": "straight", "length_m": 1000}]}},
               "tracks": tracks}
    gauge_mm = 1e3 * (track.heads_m[1] - track.heads_m[0] - HEAD_WIDTH_M)
    if abs(gauge_mm - STANDARD_GAUGE_MM) > MOST_GAUGE_ERROR_MM:
        section["alignment"]["gauge_mm"] = round(gauge_mm)
    if track.platform is not None:
        sign, edge, height, _ = track.platform
        section["structures"] = [{"name": "platform", "type": "platform", "side": "left" if sign > 0 else "right",
                                  "begin_s_m": START_M - 60, "end_s_m": START_M + 60, "edge_distance_m": round(edge[0], 3),
                                  "height_m": round(min(max(height[0], 0.2), 1.3), 3)}]
    return section


def write_scenario(folder, turn, track, without_noise):
    (folder / "sensor.json").write_text(json.dumps(metadata(turn)))
    scenario = {"version": 1, "lidar": lidar(turn, track), "world": world(track), "vehicle": {"start_s_m": START_M},
                "materials": "@/materials/railway.json", "labels": "@/labels.json"}
    if without_noise:
        scenario["effects"] = {name: False for name in NOISES}
    (folder / "scenario.json").write_text(json.dumps(scenario, indent=1).replace("@", str(SCENARIOS)))


def read_pcd(path):
    data = path.read_bytes()
    head, _, body = data.partition(b"DATA binary\n")
    lines = {line.split()[0]: line.split()[1:] for line in head.decode().splitlines() if line and line[0] != "#"}
    types = [(name, NUMPY_TYPES[kind, size]) if count == "1" else (name, NUMPY_TYPES[kind, size], int(count))
             for name, kind, size, count in zip(lines["FIELDS"], lines["TYPE"], lines["SIZE"], lines["COUNT"])]
    cloud = np.frombuffer(body, dtype=np.dtype(types), count=int(lines["POINTS"][0]))
    return np.stack([cloud[axis] for axis in "xyz"], axis=1).astype(float)


def run(command):
    """Runs a program, whose message is the error if it fails."""
    done = subprocess.run([str(part) for part in command], text=True, capture_output=True)
    if done.returncode:
        lines = done.stderr.strip().splitlines()
        raise ProgramError(lines[-1] if lines else f"{command[0]} failed with status {done.returncode}")
    return done.stdout


def simulate(build, folder, turn, track, rung, without_noise=False):
    """The simulated turn, in the axes and with the rings and columns of the real one."""
    folder.mkdir(parents=True, exist_ok=True)
    write_scenario(folder, turn, track, without_noise)
    out = folder / (rung + "_without_noise" * without_noise)
    run([build / "generator/railcast-generate", "sequence", folder / "scenario.json", "--out", out, "--frames", "1",
                    "--fidelity", rung, "--fields", "x,y,z"])
    points = read_pcd(next(out.rglob("*.pcd")))
    points = points[np.isfinite(points).all(axis=1)] @ to_ouster(turn)
    return assign(turn, points)


def assign(real, points):
    level = np.hypot(points[:, 0], points[:, 1]) - ARM_M
    elevation, azimuth = np.arctan2(points[:, 2], level), np.arctan2(points[:, 1], points[:, 0])
    ring = np.searchsorted((real.elevation_rad[1:] + real.elevation_rad[:-1]) / 2, elevation)
    column = np.rint((azimuth - real.first_rad - real.azimuth_rad[ring]) / STEP_RAD).astype(int)
    kept = (column >= 0) & (column < real.num_columns)
    turn = Turn(real.name, points[kept], ring[kept], column[kept], None, real.elevation_rad, real.azimuth_rad, real.first_rad,
                real.num_columns, False, 0.0)
    turn.range_m = np.linalg.norm(turn.points - turn.origins()[turn.column], axis=1) + ARM_M
    return turn
