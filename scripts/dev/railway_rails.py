"""Measures rails as a sensor sees them, and the edge of a platform. A part of railway_frames.py."""

import numpy as np

from railway_bed import BLOCK_M, interval
from railway_track import foot_m, in_track

HEAD_RANGES_M = (4, 5, 6, 8, 12, 20, 40)
HALF_HEAD_M = 0.06
PLATFORM_ACROSS_M = (0.8, 4.0)
PLATFORM_ABOVE_M = (0.15, 1.4)
PLATFORM_ALONG = 0.6  # Least share of the track seen beside which it lies, which things on the track do not reach.


def by_side(track):
    """The heads' places: the one nearer to the sensor, and the other."""
    return sorted(track.heads_m, key=abs)


def over_blocks(points, measure, rng, num_draws=200):
    """A measure of points, and its interval by bootstrap over blocks along the track."""
    block = np.unique((points[:, 0] / BLOCK_M).astype(int), return_inverse=True)[1]
    parts = [points[block == k] for k in range(block.max() + 1)]
    draws = [measure(np.concatenate([parts[k] for k in rng.integers(0, len(parts), len(parts))])) for _ in range(num_draws)]
    return (measure(points), *interval(draws), len(points))


def head_size(turn, track, head_m):
    """Width of the top (95 % of the points within 25 mm of the heads' plane), and height of the top over the lowest
    tenth of the points 0.1 to 0.2 m beside it on the side that the sensor sees; each with interval and n, or None."""
    local = in_track(turn, track)
    near = local[np.abs(local[:, 0] - foot_m(turn, track)) < 0.35 * track.height_m]
    rng = np.random.default_rng(8)
    top = near[(np.abs(near[:, 1] - head_m) < 0.09) & (np.abs(near[:, 2]) < 0.025)]
    width = over_blocks(top, lambda p: np.subtract(*np.percentile(p[:, 1], (97.5, 2.5))), rng) if len(top) > 30 else None
    side = -np.sign(head_m) * (near[:, 1] - head_m)
    foot = near[(side > 0.10) & (side < 0.20) & (near[:, 2] < -0.05) & (near[:, 2] > -0.5)]
    height = over_blocks(foot, lambda p: -np.percentile(p[:, 2], 10), rng) if len(foot) > 30 else None
    return width, height


def shadow(turn, track, head_m):
    """Where behind a head, away from the sensor, the strips of 2 cm hold less than 30 % of the points that the bed has
    0.4 to 0.6 m behind: (begin, end) from the head's middle, the points in it, those of the bed in a strip; or None."""
    local = in_track(turn, track)
    near = local[(np.abs(local[:, 0] - foot_m(turn, track)) < 0.35 * track.height_m) & (np.abs(local[:, 2] + 0.15) < 0.3)]
    behind = np.sign(head_m) * (near[:, 1] - head_m)
    counts = np.bincount((behind[(behind >= 0) & (behind < 0.6)] / 0.02).astype(int), minlength=30)
    usual = np.mean(counts[20:30])
    if usual < 10:
        return None
    few = counts[:20] < 0.3 * usual
    runs = [(i, j) for i in range(20) for j in range(i + 1, 21) if few[i:j].all()]
    if not runs:
        return None
    first, last = max(runs, key=lambda run: run[1] - run[0])
    return 0.02 * first, 0.02 * last, int(counts[first:last].sum()), float(usual)


def expected_shadow_m(track, head_m, depth_m):
    """How far behind the head's middle a straight line from the sensor past its farther upper edge meets the bed."""
    edge = abs(head_m) + 0.036
    return 0.036 + depth_m * edge / track.height_m


def on_head(local, head_m, drift):
    across = np.abs(local[:, 1] - head_m - drift)
    return (across < HALF_HEAD_M) & (np.abs(local[:, 2]) < 0.06)


def head_firings(turn, track, head_m):
    """By range: points on a metre of the head, their Poisson interval, n, and the middle angles from the normal and from
    the rail; None where the window shows less than a metre."""
    local = in_track(turn, track)
    chosen = local[on_head(local, head_m, 0.0)]
    distance = np.hypot(np.hypot(chosen[:, 0], head_m), track.height_m)
    places = np.arange(-45, 45, 0.05)
    sight = np.stack([places, np.full_like(places, head_m), np.full_like(places, -track.height_m)], axis=1) @ track.frame
    azimuth = np.arctan2(sight[:, 1], sight[:, 0]) - turn.first_rad
    elevation = np.arctan2(sight[:, 2], np.hypot(sight[:, 0], sight[:, 1]))
    seen = (azimuth > 0) & (azimuth < 2 * np.pi / 2048 * turn.num_columns) & \
        (elevation > turn.elevation_rad[0]) & (elevation < turn.elevation_rad[-1])
    range_m = np.linalg.norm(sight, axis=1)
    rows = []
    for low, high in zip(HEAD_RANGES_M, HEAD_RANGES_M[1:]):
        length = 0.05 * np.sum(seen & (range_m >= low) & (range_m < high))
        if length < 0.5:
            rows.append(None)
            continue
        n = int(np.sum((distance >= low) & (distance < high)))
        middle = max((low + high) / 2, np.hypot(head_m, track.height_m))
        angle = np.degrees(np.arccos(min(1, track.height_m / middle)))
        to_rail = np.degrees(np.arcsin(min(1, np.hypot(head_m, track.height_m) / middle)))
        half = 1.96 * np.sqrt(n + 1)
        rows.append((n / length, max(0, n - half) / length, (n + half) / length, n, angle, to_rail))
    return rows


def farthest_m(turn, track, head_m):
    """To what range the head is seen without a gap: metres of track that have at least three points on the head, 60 mm
    above the median of those 0.15 to 0.45 m beside it; the head is followed from metre to metre. (range, metres)."""
    local = in_track(turn, track)
    local = local[(np.abs(local[:, 1] - head_m) < 1.5) & (np.abs(local[:, 2]) < 0.8)]
    foot = foot_m(turn, track)
    farthest, metres = 0.0, 0
    for sign in (-1, 1):
        drift, level, gaps = 0.0, 0.0, 0
        for k in range(60):
            here = local[np.floor(sign * (local[:, 0] - foot)).astype(int) == k]
            across = here[:, 1] - head_m - drift
            beside = here[(np.abs(across) > 0.15) & (np.abs(across) < 0.45), 2]
            head = here[(np.abs(across) < 0.08) & (np.abs(here[:, 2] - level) < 0.06)]
            if len(head) >= 3 and len(beside) >= 3 and np.median(head[:, 2]) - np.median(beside) > 0.06:
                drift += 0.5 * (np.median(head[:, 1]) - head_m - drift)
                level += 0.5 * (np.median(head[:, 2]) - level)
                farthest = max(farthest, np.hypot(np.hypot(foot + sign * (k + 0.5), head_m), track.height_m))
                metres, gaps = metres + 1, 0
            else:
                gaps += 1
                if gaps > 2:
                    break
    return farthest, metres


def platform(turn, track):
    """The nearest edge of a level surface above the heads: (signed distance from the axis, interval, height, interval,
    standard deviation of heights, n), or None."""
    local = in_track(turn, track)
    near = local[np.abs(local[:, 0] - foot_m(turn, track)) < 0.6 * track.height_m]
    across = near[:, 1] - sum(track.heads_m) / 2
    found = []
    for sign in (-1, 1):
        above = near[(sign * across > PLATFORM_ACROSS_M[0]) & (sign * across < PLATFORM_ACROSS_M[1]) &
                     (near[:, 2] > PLATFORM_ABOVE_M[0]) & (near[:, 2] < PLATFORM_ABOVE_M[1])]
        if len(above) < 200:
            continue
        counts, edges = np.histogram(above[:, 2], np.arange(*PLATFORM_ABOVE_M, 0.02))
        peak = edges[np.argmax(counts)] + 0.01
        top = above[np.abs(above[:, 2] - peak) < 0.06]
        blocks = [len(np.unique((each[:, 0] / BLOCK_M).astype(int))) for each in (top, near)]
        if len(top) < 200 or len(top) < 0.3 * len(above) or blocks[0] < PLATFORM_ALONG * blocks[1]:
            continue
        middle = sum(track.heads_m) / 2
        rng = np.random.default_rng(9)
        edge = over_blocks(top, lambda p: np.percentile(sign * (p[:, 1] - middle), 1), rng)
        height = over_blocks(top, lambda p: np.median(p[:, 2]), rng)
        found.append((sign, edge, height, np.std(top[:, 2])))
    return min(found, key=lambda each: each[1][0], default=None)
