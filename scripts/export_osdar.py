#!/usr/bin/python3
"""Turns recorded sequences into a scene of the OSDaR layout: OpenLABEL, PCD files and an INS's CSV.

Usage: export_osdar.py RUN... --out DIR [--ontology osdar26|osdar23] [--merged] [--ascii]

RUN is a directory that railcast-generate sequence wrote. Several runs are one scene with several
sensors, those of one vehicle: each frame of the first is taken with the frames of the others that
begin during its period, if there is one of each. Their clouds are merged in the vehicle's axes,
with the number of the run as `sensor_index`; --merged asks for that layout with one run, too. Writes

    DIR/NAME_labels.json            cuboids, both rails of each track, segmentation by point indices
    DIR/LIDAR/000_12.300000000.pcd  x y z intensity timestamp [sensor_index]: points only
    DIR/gps_imu/ins.csv             pose and motion of the vehicle at each stamp
    DIR/gps_imu/NAME.csv            the samples of each motion sensor of the first run

Needs the Python module railcast (docs/python.md), Debian's python3-numpy and python3-yaml, and the ontologies of
https://github.com/dbinfrago/raillabel-providerkit (--definitions).
"""

import argparse
import pathlib
import shutil
import sys

try:
    import numpy as np
    import osdar_definitions
    import osdar_scene
    import railcast
except ImportError as error:
    sys.exit(f"{error}: install Debian's python3-numpy and python3-yaml, and build the Python module (docs/python.md)")
from join_semantic_kitti import run_in
from model_tables import models_of
from osdar_truth import Ontology

LIDARS = {"osdar23": "lidar", "osdar26": "lidar_merged"}


class BadInput(Exception):
    """What is wrong, a line for each fault."""


def matrix_of_mount(mount):
    """vehicle_from_sensor of a scenario's `mount`: roll, then pitch, then yaw."""
    yaw, pitch, roll = (np.radians(mount[key]) for key in ("yaw_deg", "pitch_deg", "roll_deg"))
    about_z = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    about_y = np.array([[np.cos(pitch), 0, np.sin(pitch)], [0, 1, 0], [-np.sin(pitch), 0, np.cos(pitch)]])
    about_x = np.array([[1, 0, 0], [0, np.cos(roll), -np.sin(roll)], [0, np.sin(roll), np.cos(roll)]])
    matrix = np.eye(4)
    matrix[:3, :3] = about_z @ about_y @ about_x
    matrix[:3, 3] = mount["position_m"]
    return matrix


def stamps_of(path):
    """The stamps of a sequence's frames, in ns."""
    file = path / "poses.csv"
    try:
        return [int(line.split(",", 1)[0]) for line in file.read_text("ascii").splitlines()[1:]]
    except ValueError as error:
        raise BadInput(f"{file}: {error}") from error


def places_together(stamps, period_ns):
    """For each frame of the first run, its place and those of the others' frames that begin during its period.

    Frames are left out during which one of the others begins none.
    """
    places = []
    for place, begin in enumerate(stamps[0]):
        firsts = [int(np.searchsorted(own, begin)) for own in stamps[1:]]
        if all(first < len(own) and own[first] < begin + period_ns for first, own in zip(firsts, stamps[1:])):
            places.append((place, *firsts))
    return places


def open_runs(paths):
    """The recordings, and the places in them of the frames that belong together."""
    faults, runs, places = [], [], []
    for path in paths:
        try:
            run = railcast.open(path)
        except railcast.InputError as error:
            faults.append(str(error))
            continue
        if run.kind != "sequence":
            faults.append(f"{path}: must be a sequence of railcast (got {run.kind})")
        elif (path / "commands.jsonl").exists():
            faults.append(f"{path}: must be a run without commands, which change where the rails are seen from")
        elif (path / "motion" / "ins.csv").exists():
            faults.append(f"{path}: must have no motion sensor that is called as the INS that is written (got ins)")
        else:
            runs.append(run)
    if not faults:
        # Of a run that is not finished, the last pose may belong to no frame yet.
        stamps = [stamps_of(path)[:len(run)] for path, run in zip(paths, runs)]
        places = places_together(stamps, 1e9 / runs[0].scenario["lidar"]["scan"]["rate_hz"])
        if not places:
            faults.append(f"{paths[0]}: must have a frame during which one of each other run begins")
    if faults:
        raise BadInput("\n".join(faults))
    return runs, places


def write_pcd(path, points, is_ascii):
    """Writes a structured array of points as PCD."""
    letters = {"f": "F", "u": "U", "i": "I"}
    types = [points.dtype[name] for name in points.dtype.names]
    head = ["# .PCD v0.7 - Point Cloud Data file format", "VERSION 0.7", f"FIELDS {' '.join(points.dtype.names)}",
            f"SIZE {' '.join(str(kind.itemsize) for kind in types)}",
            f"TYPE {' '.join(letters[kind.kind] for kind in types)}", f"COUNT {' '.join('1' for _ in types)}",
            f"WIDTH {len(points)}", "HEIGHT 1", "VIEWPOINT 0 0 0 1 0 0 0", f"POINTS {len(points)}",
            f"DATA {'ascii' if is_ascii else 'binary'}"]
    with open(path, "wb") as file:
        file.write(("\n".join(head) + "\n").encode())
        if is_ascii:
            # 9 digits hold any float32; the time is a float64 of nanoseconds.
            formats = ["%.9f" if kind == np.float64 else "%.9g" if kind.kind == "f" else "%d" for kind in types]
            np.savetxt(file, points, fmt=formats)
        else:
            file.write(points.tobytes())


def write_ins(path, samples):
    """Writes the INS's file: a line for each frame."""
    columns = ("timestamp_s", "x_m", "y_m", "z_m", "qx", "qy", "qz", "qw", "vx_mps", "vy_mps", "vz_mps", "wx_radps",
               "wy_radps", "wz_radps")
    lines = [",".join(columns)]
    lines += [",".join([osdar_scene.seconds(stamp_ns), *(f"{value:.9g}" for value in values)])
              for stamp_ns, values in samples]
    path.write_text("\n".join(lines) + "\n", "ascii")


def export(arguments):
    paths = [run_in(pathlib.Path(path)) for path in arguments.runs]
    runs, places = open_runs(paths)
    out = arguments.out
    if out.exists():
        raise BadInput(f"{out}: must not exist")
    definitions = osdar_definitions.read_definition(arguments.definitions, f"{arguments.ontology}.yaml")
    lidar = LIDARS[arguments.ontology]
    is_merged = arguments.merged or len(runs) > 1
    mounts = [matrix_of_mount(run.scenario["lidar"]["mount"]) for run in runs]
    ontology = Ontology(arguments.ontology, definitions, models_of(runs[0].scenario))
    scene = osdar_scene.Scene(out.name, ontology, lidar,
                              np.eye(4) if is_merged else mounts[0])
    simulator = railcast.Simulator(paths[0] / "scenario.resolved.json")
    begun = out.with_name(out.name + ".partial")
    shutil.rmtree(begun, ignore_errors=True)
    (begun / lidar).mkdir(parents=True)
    (begun / "gps_imu").mkdir()
    samples = []
    for of_runs in places:
        frames = [run[place] for run, place in zip(runs, of_runs)]
        view = osdar_scene.View(frames, mounts, is_merged)
        view.add_rails(simulator.rails(frames[0].index, ahead_m=arguments.ahead_m))
        try:
            name = scene.add_frame(view, runs[0])
        except ValueError as error:
            raise BadInput(f"{paths[0]}: frame {frames[0].index}: {error}") from error
        write_pcd(begun / lidar / name, view.points(), arguments.ascii)
        samples.append((frames[0].stamp_ns, osdar_scene.ins_sample(frames[0], mounts[0])))
    write_ins(begun / "gps_imu" / "ins.csv", samples)
    for file in sorted((paths[0] / "motion").glob("*.csv")):
        shutil.copyfile(file, begun / "gps_imu" / file.name)
    (begun / f"{out.name}_labels.json").write_text(scene.json_text(), "utf-8")
    begun.rename(out)
    print(f"{out}: {len(samples)} frames, {scene.num_objects} objects, {scene.num_annotations} annotations")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("runs", nargs="+", metavar="RUN")
    parser.add_argument("--out", type=pathlib.Path, required=True, metavar="DIR")
    parser.add_argument("--ontology", choices=sorted(LIDARS), default="osdar26")
    parser.add_argument("--merged", action="store_true")
    parser.add_argument("--ascii", action="store_true")
    parser.add_argument("--ahead-m", type=float, default=200.0, help="how far ahead rails are annotated")
    parser.add_argument("--definitions", type=pathlib.Path, default=osdar_definitions.FOLDER,
                        help="folder above osdar23.yaml and osdar26.yaml")
    try:
        export(parser.parse_args())
    except (BadInput, ValueError, OSError) as error:  # InputError is a ValueError.
        print(error, file=sys.stderr)
        return 1
    except KeyError as error:  # A field that the clouds do not have.
        print(f"{error.args[0]}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
