"""Measures noise by range, and firings without a return by angle and range. A part of railway_frames.py."""

import numpy as np

RANGES_M = (3, 4, 5, 6, 8, 12, 20, 40)
ANGLES_DEG = (0, 60, 70, 75, 78, 80, 82, 84, 86, 88)
SIGMA_OF_MEDIAN = 1.4826  # Of a normal distribution, by the median of the magnitudes.


def noise(turn):
    """By range: robust sigma of second differences along rings over root 6, n, and 95 % by bootstrap over rings."""
    grid = turn.grid(turn.range_m)
    second = grid[:, 2:] - 2 * grid[:, 1:-1] + grid[:, :-2]
    middle = grid[:, 1:-1]
    rng = np.random.default_rng(2)
    scale = SIGMA_OF_MEDIAN / np.sqrt(6)
    rows = []
    for low, high in zip(RANGES_M, RANGES_M[1:]):
        chosen = np.isfinite(second) & (middle >= low) & (middle < high)
        if chosen.sum() < 200:
            rows.append(None)
            continue
        rings = [np.abs(second[k][chosen[k]]) for k in range(len(second)) if chosen[k].any()]
        draws = [np.median(np.concatenate([rings[i] for i in rng.integers(0, len(rings), len(rings))])) for _ in range(60)]
        rows.append((scale * np.median(np.concatenate(rings)), int(chosen.sum()), *(scale * np.percentile(draws, (2.5, 97.5)))))
    return rows


def grazing(turn, track):
    """By angle from the track's normal: firings, and those without a return. On the plane of the heads an angle has one
    range, so that the two cannot be told apart with a single sensor's height."""
    has = np.isfinite(turn.grid(turn.range_m))
    angle = np.degrees(np.arccos(np.clip(-turn.directions() @ track.frame[2], -1, 1)))
    return [(int(np.sum((angle >= a) & (angle < b))), int(np.sum((angle >= a) & (angle < b) & ~has)))
            for a, b in zip(ANGLES_DEG, ANGLES_DEG[1:])]


def first_lost(turn, track, share):
    """The first degree from which on at least this share of the firings is lost in each degree up to 90, or None."""
    has = np.isfinite(turn.grid(turn.range_m))
    angle = np.degrees(np.arccos(np.clip(-turn.directions() @ track.frame[2], -1, 1)))
    first = None
    for low in range(60, 90):
        chosen = (angle >= low) & (angle < low + 1)
        if chosen.sum() < 20:
            continue
        if np.mean(~has[chosen]) < share:
            first = None
        elif first is None:
            first = low
    return first
