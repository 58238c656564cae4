"""Counts the points of each object that lie in its box, in a run in the folder `out` that was made with objects.

Needs numpy and read_pcd.py.
"""

import json

import numpy as np

from read_pcd import read_pcd


def lines(name):
    return [json.loads(line) for line in open(f"out/{name}.jsonl")]


def rotate(q, v):  # v, (..., 3), turned by the quaternions q, (..., 4): x, y, z, w
    t = 2 * np.cross(q[..., :3], v)
    return v + q[..., 3:] * t + np.cross(q[..., :3], t)


def in_world(points, pose, scan_poses):
    """Places of points in the world, (n, 3) in m.

    points: in sensor axes, each at the time of its firing.
    pose: position and quaternion at the stamp, a line of poses.csv without its stamp.
    scan_poses: the later poses, from the frame's line of frames.jsonl.
    """
    times_ns = [0] + [later["time_ns"] for later in scan_poses]
    poses = np.array([pose] + [later["position_m"] + later["quaternion_xyzw"] for later in scan_poses])
    at = np.stack([np.interp(points["time_ns"], times_ns, column) for column in poses.T], axis=1)
    turn = at[:, 3:] / np.linalg.norm(at[:, 3:], axis=1, keepdims=True)
    return at[:, :3] + rotate(turn, np.stack([points[axis] for axis in "xyz"], axis=1))


def in_box(world, time_ns, thing, margin_m=0.05):
    """Whether each point, moved back to the stamp with its object, lies in the object's box: bool, (n,)."""
    box = thing["world"]
    at_stamp = world - 1e-9 * time_ns[:, None] * np.array(thing["velocity_mps"])
    local = rotate(np.array(box["quaternion_xyzw"]) * [-1, -1, -1, 1], at_stamp - box["center_m"])
    return (abs(local) <= np.array(box["size_m"]) / 2 + margin_m).all(axis=1)

frame = read_pcd("out/frames/000000.pcd")
points = frame[~np.isnan(frame["x"])]
k = 0  # Index of the frame's lines: frame - start_frame.
poses = np.loadtxt("out/poses.csv", delimiter=",", skiprows=1, ndmin=2)[:, 1:]
world = in_world(points, poses[k], lines("frames")[k]["scan_poses"])
for thing in lines("objects")[k]["objects"]:
    mine = (points["instance"] == thing["instance"]) & (points["outcome"] != 5)  # 5: clutter
    inside = in_box(world[mine], points["time_ns"][mine], thing)
    print(thing["name"], mine.sum(), inside.sum())
