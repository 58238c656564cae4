#!/usr/bin/python3
"""Turns runs of `sequence --format kitti` into a data set of KITTI's 3D object detection benchmark.

Usage: export_kitti_objects.py OUT [--train RUN...] [--val RUN...] [--test RUN...]

Writes OUT/training/velodyne/000000.bin (hard links where the file system allows), calib/000000.txt
and label_2/000000.txt with a line for each object that has points, and OUT/ImageSets/train.txt,
val.txt, test.txt. Frames are numbered through, in the order of the runs. The box of an object that
moves is where it was at the mean time of its points, as the clouds have it.

There is no image: boxes in the image are those of a camera like KITTI's own in the place of the
lidar, looking forward. Objects that it does not see have the box 0 0 0 0 and are truncated by 1.

Needs Debian's python3-numpy and python3-yaml. Exit status: 0 success, 1 bad input, 2 usage.
"""

import json
import pathlib
import shutil
import sys

import numpy as np

from join_semantic_kitti import BadInput, common_configuration, link_or_copy, read_arguments
from model_tables import models_of

SPLITS = ("train", "val", "test")
# KITTI's class by railcast's label; the table of an object's model may say more (`kitti`).
LABELS = {"person": "Pedestrian", "wagon": "Tram", "train": "Tram", "road_vehicle": "Car"}
# Shares of an object that is hidden, below which it is fully visible and partly occluded.
PARTLY, LARGELY = 0.1, 0.5
UNKNOWN = 3

WIDTH_PX, HEIGHT_PX = 1242, 375
P2 = np.array([[721.5377, 0, 609.5593, 0], [0, 721.5377, 172.854, 0], [0, 0, 1, 0]])
CAMERA_FROM_LIDAR = np.array([[0, -1, 0, 0], [0, 0, -1, 0], [1, 0, 0, 0]])  # Right, down, forward.
NEAREST_M = 0.1


def calibration_text():
    """A frame's calib file: camera and lidar are in one place."""
    rows = {**{f"P{number}": P2 for number in range(4)}, "R0_rect": np.eye(3),
            "Tr_velo_to_cam": CAMERA_FROM_LIDAR, "Tr_imu_to_velo": np.eye(4)[:3]}
    return "".join(f"{name}: {' '.join(f'{value:.12e}' for value in matrix.ravel())}\n"
                   for name, matrix in rows.items())


def yaw_of(quaternion_xyzw):
    x, y, z, w = quaternion_xyzw
    return np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def corners_of(center, size, yaw):
    """The corners of an upright box in the camera's axes, shape (8, 3)."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    turn = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    return (center + (signs * size / 2) @ turn.T) @ CAMERA_FROM_LIDAR[:, :3].T


def image_box_of(corners):
    """Left, top, right, bottom of the box in the image, and the share of it that is outside."""
    if corners[:, 2].min() < NEAREST_M:
        return np.zeros(4), 1.0
    pixels = corners @ P2[:, :3].T
    pixels = pixels[:, :2] / pixels[:, 2:]
    whole = np.concatenate([pixels.min(axis=0), pixels.max(axis=0)])
    seen = np.clip(whole, 0, np.array([WIDTH_PX, HEIGHT_PX, WIDTH_PX, HEIGHT_PX]) - 1.0)
    area = np.prod(np.maximum(seen[2:] - seen[:2], 0))
    if area <= 0:
        return np.zeros(4), 1.0
    return seen, 1.0 - area / np.prod(whole[2:] - whole[:2])


def class_of(seen, models):
    return models.get(seen["type"], {}).get("kitti", LABELS.get(seen["label"], "Misc"))


def occluded_of(seen):
    if seen["occlusion"] is None:
        return UNKNOWN
    return 0 if seen["occlusion"] < PARTLY else 1 if seen["occlusion"] < LARGELY else 2


def rotation_of(quaternion_xyzw):
    x, y, z, w = quaternion_xyzw
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def center_of(seen):
    """Where the middle of the box was at the mean time of the object's points, in the sensor's axes at the stamp."""
    sensor_from_box, world_from_box = (rotation_of(seen[axes]["quaternion_xyzw"]) for axes in ("sensor", "world"))
    way_m = 1e-9 * seen["points_time_ns"] * np.array(seen["velocity_mps"])
    return np.array(seen["sensor"]["center_m"]) + sensor_from_box @ world_from_box.T @ way_m


def objects_of(line, place):
    """The objects of a line of objects.jsonl."""
    objects = json.loads(line)["objects"]
    for index, seen in enumerate(objects):
        hidden = seen["occlusion"]
        if hidden is not None and not 0 <= hidden <= 1:
            raise BadInput(f"{place}: /objects/{index}/occlusion: must be from 0 to 1 (got {hidden})")
    return objects


def label_line(seen, models):
    """KITTI's line about an object of objects.jsonl: class, truncated, occluded, alpha, box in the image, size as
    height, width and length, middle of the underside in the camera's axes, rotation about its y axis."""
    box = seen["sensor"]
    center, size = center_of(seen), np.array(box["size_m"])
    yaw = yaw_of(box["quaternion_xyzw"])
    x, y, z = CAMERA_FROM_LIDAR[:, :3] @ (center - [0, 0, size[2] / 2])
    rotation_y = (-yaw - np.pi / 2 + np.pi) % (2 * np.pi) - np.pi
    alpha = (rotation_y - np.arctan2(x, z) + np.pi) % (2 * np.pi) - np.pi
    image_box, truncated = image_box_of(corners_of(center, size, yaw))
    numbers = [alpha, *image_box, size[2], size[1], size[0], x, y, z, rotation_y]
    return f"{class_of(seen, models)} {truncated:.2f} {occluded_of(seen)} " + " ".join(f"{value:.4f}" for value in numbers)


def export_run(run, training, first):
    """Adds a run's frames from number `first` on. Returns how many frames and objects these are."""
    num_objects = 0
    models = models_of(json.loads((run / "scenario.resolved.json").read_text("utf-8")))
    lines = (run / "objects.jsonl").read_text("utf-8").splitlines()
    for place, line in enumerate(lines):
        name = f"{first + place:06}"
        link_or_copy(run / "sequences" / "00" / "velodyne" / f"{place:06}.bin", training / "velodyne" / f"{name}.bin")
        with_points = [each for each in objects_of(line, f"{run / 'objects.jsonl'}:{place + 1}") if each["points"] > 0]
        if any("points_time_ns" not in each for each in with_points):
            raise BadInput(f"{run / 'objects.jsonl'}:{place + 1}: must have the key points_time_ns, "
                           "which older programs did not write")
        seen = [label_line(each, models) for each in with_points]
        (training / "label_2" / f"{name}.txt").write_text("".join(f"{text}\n" for text in seen), "ascii")
        (training / "calib" / f"{name}.txt").write_text(calibration_text(), "ascii")
        num_objects += len(seen)
    return len(lines), num_objects


def write_set(begun, splits):
    """Writes the files. Returns the numbers of frames and objects."""
    for name in ("velodyne", "label_2", "calib"):
        (begun / "training" / name).mkdir(parents=True)
    (begun / "ImageSets").mkdir()
    num_frames = num_objects = 0
    for name in SPLITS:
        first = num_frames
        for run in splits[name]:
            frames, objects = export_run(run, begun / "training", num_frames)
            num_frames += frames
            num_objects += objects
        numbers = "".join(f"{number:06}\n" for number in range(first, num_frames))
        (begun / "ImageSets" / f"{name}.txt").write_text(numbers, "ascii")
    return num_frames, num_objects


def export(out, splits):
    """Makes the data set at `out`, which appears only when it is whole. Returns its numbers of frames and objects."""
    common_configuration([run for name in SPLITS for run in splits[name]])
    if out.exists():
        raise BadInput(f"{out}: must not exist")
    begun = out.with_name(out.name + ".partial")
    shutil.rmtree(begun, ignore_errors=True)
    try:
        numbers = write_set(begun, splits)
    except BadInput:
        shutil.rmtree(begun)
        raise
    begun.rename(out)
    return numbers


def main():
    out, splits = read_arguments(__doc__.split("\n", maxsplit=1)[0], SPLITS)
    try:
        num_frames, num_objects = export(out, splits)
    except BadInput as error:
        print(error, file=sys.stderr)
        return 1
    print(f"{out}: {num_frames} frames, {num_objects} objects")
    return 0


if __name__ == "__main__":
    sys.exit(main())
