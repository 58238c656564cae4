"""Finds the tracks in a turn, of any gauge from 0.6 to 1.8 m. A part of railway_frames.py."""

import dataclasses

import numpy as np

HEADS_APART_M = (0.65, 1.88)  # Gauges from 0.6 to 1.8 m, between the middles of the heads.
STEP_M = 0.02
MOST_ACROSS_M = 20.0
RISE_M = (0.07, 0.35)  # Of a head above what is beside it.
BESIDE_M = 0.30  # On both sides of a head something lies lower within this distance and the shadow; walls lack that.


@dataclasses.dataclass
class Track:
    """Rows of `frame` are along, to the left, up in the sensor's axes; heights are above the rail heads."""
    frame: np.ndarray
    height_m: float  # The sensor's above the heads.
    heads_m: tuple  # Distances of the two heads' middles from the sensor, left positive.
    head_points: tuple
    interval_m: tuple  # 95 % of the heads' distance, by bootstrap.
    others_m: list  # Distances of further tracks' middles from its own.
    platform: tuple = None  # As railway_rails.platform() found it.


def find_plane(points, rng):
    best = (0, None, 0)
    for _ in range(300):
        three = points[rng.choice(len(points), 3, False)]
        normal = np.cross(three[1] - three[0], three[2] - three[0])
        if np.linalg.norm(normal) < 1e-6:
            continue
        normal /= np.linalg.norm(normal)
        count = np.sum(np.abs((points - three[0]) @ normal) < 0.04)
        if count > best[0]:
            best = (count, normal, three[0] @ normal)
    _, normal, offset = best
    for _ in range(3):
        near = points[np.abs(points @ normal - offset) < 0.06]
        normal = np.linalg.svd(near - near.mean(axis=0), full_matrices=False)[2][2]
        offset = near.mean(axis=0) @ normal
    return (normal, -offset) if offset < 0 else (-normal, offset)


def best_heading(along, left, height):
    """The direction along which heights differ least within strips."""
    def spread(angle):
        across = left * np.cos(angle) - along * np.sin(angle)
        strip = ((across - across.min()) / 0.03).astype(int)
        count = np.bincount(strip)
        mean = np.bincount(strip, height) / np.maximum(count, 1)
        variance = np.bincount(strip, height**2) / np.maximum(count, 1) - mean**2
        return np.sum((count * variance)[count > 15]) / np.sum(count[count > 15])
    angles = np.radians(np.arange(0, 180, 1.0))
    for step in (0.2, 0.04):
        best = min(angles, key=spread)
        angles = best + np.radians(step) * np.arange(-6, 7)
    return min(angles, key=spread)


def median_heights(across, height, least):
    """The number of the first strip of 2 cm, and the strips' median heights, NaN where there are too few points."""
    strip = np.floor(across / STEP_M).astype(int)
    order = np.argsort(strip, kind="stable")
    first, last = strip.min(), strip.max()
    edges = np.searchsorted(strip[order], np.arange(first, last + 2))
    return first, np.array([np.median(height[order[a:b]]) if b - a >= least else np.nan for a, b in zip(edges, edges[1:])])


def find_heads(across, height, sensor_m, least=8):
    """Ridges above what is beside them on both sides: (middle, height, positions of the points on it)."""
    first, medians = median_heights(across, height, least)
    heads = []
    for i in np.flatnonzero(np.isfinite(medians)):
        around, near = medians[max(0, i - 30): i + 31], medians[max(0, i - 15): i + 16]
        beside = int((BESIDE_M + 0.25 * abs(first + i) * STEP_M / sensor_m) / STEP_M)
        left, right = medians[max(0, i - beside): i], medians[i + 1: i + 1 + beside]
        if not RISE_M[0] < medians[i] - np.nanmedian(around) < RISE_M[1] or medians[i] < np.nanmax(near):
            continue
        if not all(np.isfinite(side).any() and np.nanmin(side) < medians[i] - RISE_M[0] for side in (left, right)):
            continue
        middle = (first + i + 0.5) * STEP_M
        chosen = (np.abs(across - middle) < 0.09) & (np.abs(height - medians[i]) < 0.025)
        heads.append((np.median(across[chosen]), np.median(height[chosen]), across[chosen]))
    return heads


def best_pair(heads):
    """The two heads at a track's distance that have the most points, counted on the one that has fewer."""
    pairs = [(a, b) for i, a in enumerate(heads) for b in heads[i + 1:]
             if HEADS_APART_M[0] < b[0] - a[0] < HEADS_APART_M[1] and abs(a[1] - b[1]) < 0.2]
    return max(pairs, key=lambda pair: min(len(pair[0][2]), len(pair[1][2])), default=None)


def find_track(turn):
    """The track that shows most of its heads, or None."""
    distance = np.linalg.norm(turn.points, axis=1)
    least = np.percentile(distance, 1)
    normal, offset = find_plane(turn.points[distance < 1.8 * least], np.random.default_rng(1))
    guess = np.eye(3)[np.argmin(np.abs(normal))]
    along = guess - normal * (guess @ normal)
    along /= np.linalg.norm(along)
    near = turn.points[distance < 2.2 * least]
    for _ in range(2):
        left = np.cross(normal, along)
        height = near @ normal + offset
        low = np.abs(height) < 0.5
        if low.sum() < 1000:
            return None
        angle = best_heading(near[low] @ along, near[low] @ left, height[low])
        along = along * np.cos(angle) + left * np.sin(angle)
        left = np.cross(normal, along)
        pair = best_pair(find_heads(near[low] @ left, height[low], offset))
        if pair is None:
            return None
        a, b = pair
        normal = normal - (b[1] - a[1]) / (b[0] - a[0]) * left
        normal /= np.linalg.norm(normal)
        left = np.cross(normal, along)
        on_head = (np.abs(near[low] @ left - a[0]) < 0.03) & (np.abs(height[low] - a[1]) < 0.02)
        if not on_head.any():
            return None
        offset = -np.median((near[low] @ normal)[on_head])
    return finish_track(np.array([along, np.cross(normal, along), normal]), offset, a, b, turn)


def finish_track(frame, height_m, a, b, turn):
    rng = np.random.default_rng(1)
    draws = [np.median(rng.choice(b[2], len(b[2]))) - np.median(rng.choice(a[2], len(a[2]))) for _ in range(200)]
    track = Track(frame, height_m, (a[0], b[0]), (len(a[2]), len(b[2])), tuple(np.percentile(draws, (2.5, 97.5))), [])
    track.others_m = other_tracks(turn, track)
    return track


def other_tracks(turn, track):
    """Distances of further tracks' middles from the found one's, left positive: pairs of ridges at its own distance."""
    local = in_track(turn, track)
    along_m = np.abs(local[:, 0] - foot_m(turn, track))
    chosen = (along_m < 1.5 * track.height_m) & (np.abs(local[:, 2]) < 0.5) & (np.abs(local[:, 1]) < MOST_ACROSS_M)
    heads = find_heads(local[chosen, 1], local[chosen, 2], track.height_m, 5)
    apart = track.heads_m[1] - track.heads_m[0]
    middles = [(a[0] + b[0]) / 2 - sum(track.heads_m) / 2 for i, a in enumerate(heads) for b in heads[i + 1:]
               if abs(b[0] - a[0] - apart) < 0.08]
    return [float(each) for each in middles if abs(each) > apart]


def in_track(turn, track):
    """Points along, to the left and above the heads, from the sensor."""
    return turn.points @ track.frame.T + [0, 0, track.height_m]


def foot_m(turn, track):
    """The place along the track at the middle of the window."""
    local = in_track(turn, track)
    return np.median(local[np.abs(local[:, 1] - sum(track.heads_m) / 2) < 0.5, 0])
