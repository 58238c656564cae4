"""Finds an obstacle by two turns of one place, and puts a thing of its size into the free one with `insert`.

A part of railway_frames.py.
"""

import dataclasses
import json
import shutil

import numpy as np
from scipy import ndimage
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

import railway_simulate
from railway_cloud import ARM_M, NUM_RINGS
from railway_firings import SIGMA_OF_MEDIAN

NEARER_M = 0.1  # A firing whose range is shorter by more met something new.
LINK_M = 0.25  # Between points of one thing.
LEAST_FIRINGS = 100
MOST_ACROSS_M = 3.0  # From the track's axis, for a thing on the track.
SHAPES = ("box", "heap")
FAR_M = 300.0  # Where a thing is put that must not be seen.


@dataclasses.dataclass
class Obstacle:
    track: object  # The free turn's, seen so that the obstacle is ahead.
    free: np.ndarray  # Ranges by ring and column.
    real: np.ndarray
    firings: np.ndarray  # Those on it, as a mask by ring and column.
    centre_m: tuple  # Along from the sensor, and left of the track's axis.
    size_m: tuple
    heading_deg: float
    base_m: float  # Above the heads.


def positions(turn, track, range_m):
    """By ring and column, along, left of the sensor, above the heads."""
    return (turn.origins()[None] + turn.directions() * (range_m - ARM_M)[..., None]) @ track.frame.T + [0, 0, track.height_m]


def largest_cluster(points):
    pairs = cKDTree(points).query_pairs(LINK_M, output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(len(points),) * 2)
    label = connected_components(graph, directed=False)[1]
    return label == np.argmax(np.bincount(label))


def rectangle(plan):
    """The smallest rectangle around 98 % of the points in each of its directions: (centre, sizes, heading)."""
    best = None
    for angle in np.radians(np.arange(0, 90)):
        turned = plan @ np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        low, high = np.percentile(turned, (1, 99), axis=0)
        if best is None or np.prod(high - low) < np.prod(best[1]):
            middle = (low + high) / 2 @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
            best = middle, high - low, np.degrees(angle)
    return best


def reversed_track(track):
    """The same track, looked at in the other direction."""
    return dataclasses.replace(track, frame=np.diag([-1, -1, 1]) @ track.frame, heads_m=tuple(-x for x in track.heads_m[::-1]),
                               others_m=[-x for x in track.others_m], platform=None)


def find_obstacle(turn, track, real):
    """What stands on the track in `real`, ranges on the free turn's firings, or None."""
    free = turn.grid(turn.range_m)
    points = positions(turn, track, real)
    middle = sum(track.heads_m) / 2
    nearer = (real < free - NEARER_M) & (np.abs(points[..., 1] - middle) < MOST_ACROSS_M) & (points[..., 2] > -0.6)
    if nearer.sum() < LEAST_FIRINGS:
        return None
    firings = np.zeros_like(nearer)
    firings[nearer] = largest_cluster(points[nearer])
    if firings.sum() < LEAST_FIRINGS:
        return None
    if np.median(points[firings][:, 0]) < 0:
        track = reversed_track(track)
        points = positions(turn, track, real)
    thing = points[firings] - [0, sum(track.heads_m) / 2, 0]
    centre, size, heading = rectangle(thing[:, :2])
    below = positions(turn, track, free)[firings][:, 2]
    base = np.median(below[below < -0.1]) if np.any(below < -0.1) else np.percentile(thing[:, 2], 1)
    height = np.percentile(thing[:, 2], 99) - base
    return Obstacle(track, free, real, firings, tuple(centre), (*size, height), heading, base)


def write_heap(path):
    """Half an ellipsoid of length, width and height 1 as a mesh."""
    lines, rows, columns = [], 12, 48
    for i in range(rows + 1):
        up = np.pi / 2 * i / rows
        for j in range(columns):
            round_about = 2 * np.pi * j / columns
            lines.append("v {:.6f} {:.6f} {:.6f}".format(0.5 * np.cos(up) * np.cos(round_about),
                                                         0.5 * np.cos(up) * np.sin(round_about), np.sin(up)))
    for i in range(rows):
        for j in range(columns):
            corners = (i * columns + j, i * columns + (j + 1) % columns, (i + 1) * columns + (j + 1) % columns, (i + 1) * columns + j)
            lines.append("f " + " ".join(str(corner + 1) for corner in corners))
    path.write_text("\n".join(lines) + "\n")


def write_cloud(path, turn, range_m):
    """A PCD in the axes of Ouster's sensors, in the order in which they fire."""
    points = (turn.origins()[None] + turn.directions() * (range_m - ARM_M)[..., None]) @ railway_simulate.to_ouster(turn).T
    points = points[:, ::-1]
    column, ring = np.nonzero(np.isfinite(points[..., 0]).T)
    cloud = np.zeros(len(ring), dtype=[("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("t", "<u4"), ("ring", "<u2")])
    for k, axis in enumerate("xyz"):
        cloud[axis] = points[ring, column, k]
    cloud["ring"], cloud["t"] = NUM_RINGS - 1 - ring, column * (100_000_000 // 2048)
    head = ("VERSION 0.7\nFIELDS x y z t ring\nSIZE 4 4 4 4 2\nTYPE F F F U U\nCOUNT 1 1 1 1 1\n"
            f"WIDTH {len(cloud)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(cloud)}\nDATA binary\n")
    path.write_bytes(head.encode() + cloud.tobytes())


def write_plan(folder, turn, obstacle, rung, shape, is_far=False):
    thing = {"name": "obstacle", "type": "box", "size_m": [round(float(each), 3) for each in obstacle.size_m],
             "x_m": round(float(obstacle.centre_m[0]) + FAR_M * is_far, 3), "y_m": round(float(obstacle.centre_m[1]), 3),
             "h_m": round(float(obstacle.base_m), 3), "heading_deg": round(float(obstacle.heading_deg), 1)}
    if shape == "heap":
        thing |= {"type": "mesh", "file": "heap.obj", "up": "z"}
    scenarios = railway_simulate.SCENARIOS
    plan = {"version": 1, "fidelity": rung, "lidar": railway_simulate.lidar(turn, obstacle.track),
            "world": {"recording": {"poses": "standing"}, "objects": [thing]},
            "materials": str(scenarios / "materials/railway.json"), "labels": str(scenarios / "labels.json")}
    path = folder / f"{shape}_{rung}{'_far' * is_far}.json"
    path.write_text(json.dumps(plan))
    return path


def insert(build, folder, turn, obstacle, rung, shape, cloud="free", is_far=False):
    """The run's folder, and its ranges by ring and column."""
    plan = write_plan(folder, turn, obstacle, rung, shape, is_far)
    out = folder / f"{cloud}_{plan.stem}"
    shutil.rmtree(out, ignore_errors=True)
    railway_simulate.run([build / "generator/railcast-generate", "insert", folder / f"{cloud}.pcd", plan, "--out", out])
    points = railway_simulate.read_pcd(next((out / "recording").rglob("*.pcd")))
    points = points[np.isfinite(points).all(axis=1)] @ railway_simulate.to_ouster(turn)
    edited = railway_simulate.assign(turn, points)
    return out, edited.grid(edited.range_m)


def prepare(folder, turn, obstacle):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "sensor.json").write_text(json.dumps(railway_simulate.metadata(turn)))
    write_heap(folder / "heap.obj")
    write_cloud(folder / "free.pcd", turn, obstacle.free)
    write_cloud(folder / "real.pcd", turn, obstacle.real)


def evaluate(build, run):
    """What the reference detector finds in a run of one frame, and what `detect` says of it, as the reports' JSON."""
    reports = []
    for command, options in (("evaluate", ["--min-distance-m", "0"]), ("detect", [])):
        text = railway_simulate.run([build / "analysis/railcast-analyze", command, run, "--format", "json", "--frames", "1/1",
                                     "--speed-kmph", "10", *options])
        reports.append(json.loads(text))
    return reports


def places_by_track(build, folder, obstacle):
    """The obstacle's points as `railcast-analyze track --points` places them in the frame that it is in."""
    out = folder / "track"
    railway_simulate.run([build / "analysis/railcast-analyze", "track", folder / "real.pcd", "--points", "--out", out])
    seen = np.isfinite(obstacle.real)
    # As write_cloud() orders them.
    on_thing = obstacle.firings[:, ::-1].T[seen[:, ::-1].T]
    return np.load(out / "points/000000.npy")[on_thing]


def median_over_rings(values, ring, rng):
    rings = [values[ring == k] for k in np.unique(ring)]
    draws = [np.median(np.concatenate([rings[i] for i in rng.integers(0, len(rings), len(rings))])) for _ in range(200)]
    return (np.median(values), *np.percentile(draws, (2.5, 97.5)), len(values))


def second_differences(range_m, firings):
    """Robust sigma of second differences along rings over root 6, where three firings in a row are on the thing."""
    second = range_m[:, 2:] - 2 * range_m[:, 1:-1] + range_m[:, :-2]
    chosen = firings[:, 2:] & firings[:, 1:-1] & firings[:, :-2] & np.isfinite(second)
    if chosen.sum() < 30:
        return None
    scale = SIGMA_OF_MEDIAN / np.sqrt(6)
    return median_over_rings(scale * np.abs(second[chosen]), np.nonzero(chosen)[0], np.random.default_rng(10))


def between(range_m, obstacle, firings):
    """Firings at the rim whose range is neither the thing's nor that of what is behind: (number, firings at the rim)."""
    inner = ndimage.binary_erosion(firings, structure=np.ones((1, 3)))
    rim = ndimage.binary_dilation(firings, structure=np.ones((1, 3))) & ~inner & np.isfinite(range_m) & np.isfinite(obstacle.free)
    nearest = ndimage.distance_transform_edt(~inner, return_distances=False, return_indices=True)
    on_thing = range_m[tuple(nearest)]
    mixed = rim & (range_m < obstacle.free - NEARER_M) & (range_m > on_thing + NEARER_M)
    return int(mixed.sum()), int(rim.sum())


def shadow_m(turn, obstacle, firings):
    """How far behind the thing's farther side, seen from the sensor, the track that it hides reaches: 98 % of the points
    that the hidden firings had in the free turn."""
    hidden = positions(turn, obstacle.track, obstacle.free)[firings & np.isfinite(obstacle.free)]
    away = np.array([obstacle.centre_m[0], obstacle.centre_m[1] + sum(obstacle.track.heads_m) / 2])
    away /= np.linalg.norm(away)
    thing = positions(turn, obstacle.track, obstacle.real)[obstacle.firings]
    return np.percentile(hidden[:, :2] @ away, 98) - np.percentile(thing[:, :2] @ away, 98)


def compare(turn, obstacle, range_m):
    """What a simulated insertion changed, beside the real one."""
    changed = (range_m < obstacle.free - NEARER_M) | (np.isfinite(range_m) & ~np.isfinite(obstacle.free))
    common = changed & obstacle.firings
    apart = range_m[common] - obstacle.real[common]
    around = ndimage.binary_dilation(changed | obstacle.firings, structure=np.ones((3, 3)))
    others = ~around & np.isfinite(range_m) & np.isfinite(obstacle.free) & (np.abs(range_m - obstacle.free) > 1.5e-3)
    return {"changed": int(changed.sum()), "common": int(common.sum()), "either": int((changed | obstacle.firings).sum()),
            "apart": median_over_rings(apart, np.nonzero(common)[0], np.random.default_rng(11)),
            "spread": np.percentile(apart, (5, 95)), "noise": second_differences(range_m, changed),
            "between": between(range_m, obstacle, changed), "shadow": shadow_m(turn, obstacle, changed),
            "lost": int(np.sum(around & np.isfinite(obstacle.free) & ~np.isfinite(range_m))), "others": int(others.sum())}
