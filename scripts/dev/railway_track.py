"""Finds the track in a turn, and measures bed, relief and noise. A part of railway_frames.py."""

import dataclasses

import numpy as np
from scipy.spatial import cKDTree

STRIP_M = 0.04
LAGS_M = (0.014, 0.020, 0.030, 0.040, 0.050, 0.070, 0.100, 0.150, 0.200, 0.250)
RANGES_M = (3, 4, 5, 6, 8, 12, 20, 40)


@dataclasses.dataclass
class Track:
    """Rows of `frame` are along, to the left, up in the sensor's axes; heights are above the rail heads."""
    frame: np.ndarray
    height_m: float  # The sensor's above the heads.
    heads_m: tuple  # Distances of the two heads' middles from the sensor, left positive.
    head_points: tuple
    interval_m: tuple  # 95 % of the heads' distance, by bootstrap.
    other_heads_m: list


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


def find_heads(across, height):
    """[(middle, height, points)] of ridges 0.07 to 0.35 m above what is beside them."""
    strip = np.floor(across / 0.02).astype(int)
    order = np.arange(strip.min(), strip.max() + 1)
    medians = np.array([np.median(height[strip == k]) if np.sum(strip == k) > 7 else np.nan for k in order])
    heads = []
    for i in range(len(order)):
        around = medians[max(0, i - 30): i + 31]
        near = medians[max(0, i - 15): i + 16]
        rise = medians[i] - np.nanmedian(around) if np.isfinite(medians[i]) else 0
        if 0.07 < rise < 0.35 and medians[i] >= np.nanmax(near):
            middle = (order[i] + 0.5) * 0.02
            chosen = (np.abs(across - middle) < 0.09) & (np.abs(height - medians[i]) < 0.025)
            heads.append((np.median(across[chosen]), np.median(height[chosen]), across[chosen]))
    return heads


def find_track(turn):
    rng = np.random.default_rng(1)
    distance = np.linalg.norm(turn.points, axis=1)
    least = np.percentile(distance, 1)
    normal, offset = find_plane(turn.points[distance < 1.8 * least], rng)
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
        heads = find_heads(near[low] @ left, height[low])
        pairs = [(a, b) for i, a in enumerate(heads) for b in heads[i + 1:]
                 if 0.85 < b[0] - a[0] < 1.8 and abs(a[1] - b[1]) < 0.2]
        if not pairs:
            return None
        a, b = max(pairs, key=lambda pair: min(len(pair[0][2]), len(pair[1][2])))
        lean = (b[1] - a[1]) / (b[0] - a[0])
        normal = normal - lean * left
        normal /= np.linalg.norm(normal)
        left = np.cross(normal, along)
        offset = -np.median((near[low] @ normal)[(np.abs(near[low] @ left - a[0]) < 0.03) & (np.abs(height[low] - a[1]) < 0.02)])
    left = np.cross(normal, along)
    draws = [np.median(rng.choice(b[2], len(b[2]))) - np.median(rng.choice(a[2], len(a[2]))) for _ in range(200)]
    others = [head[0] for head in heads if head is not a and head is not b]
    return Track(np.array([along, left, normal]), offset, (a[0], b[0]), (len(a[2]), len(b[2])),
                 tuple(np.percentile(draws, (2.5, 97.5))), others)


def in_track(turn, track):
    return turn.points @ track.frame.T + [0, 0, track.height_m]


def bed_points(turn, track, reach=None):
    local = in_track(turn, track)
    low, high = track.heads_m
    reach = reach or 0.6 * np.tan(np.radians(30)) * track.height_m
    inside = (local[:, 1] > low + 0.2) & (local[:, 1] < high - 0.2) & (np.abs(local[:, 2] + 0.2) < 0.2) & \
        (np.abs(local[:, 0] - np.median(local[:, 0][np.abs(local[:, 1] - (low + high) / 2) < 0.5])) < reach)
    return local[inside]


def strips(bed, track):
    """Median height, points and standard error of strips of 4 cm, from 0.2 m beside the first head on."""
    strip = ((bed[:, 1] - track.heads_m[0] - 0.2) / STRIP_M).astype(int)
    heights = [bed[strip == k, 2] for k in range(int((track.heads_m[1] - track.heads_m[0] - 0.4) / STRIP_M))]
    return [(np.median(z), len(z), 1.2533 * np.std(z) / np.sqrt(len(z))) if len(z) > 5 else (np.nan, len(z), np.nan) for z in heights]


def relief(bed):
    """By lag the root of half the mean squared difference, with the number of pairs, and the rms about the smooth surface."""
    x, y = (bed[:, i] - bed[:, i].mean() for i in (0, 1))
    design = np.stack([x**i * y**j for i in range(4) for j in range(4 - i)], axis=1)
    rest = bed[:, 2] - design @ np.linalg.lstsq(design, bed[:, 2], rcond=None)[0]
    kept = np.abs(rest) < 0.1
    rest, plan = rest[kept], bed[kept, :2]
    pairs = cKDTree(plan).query_pairs(LAGS_M[-1], output_type="ndarray")
    lag = np.linalg.norm(plan[pairs[:, 0]] - plan[pairs[:, 1]], axis=1)
    square = (rest[pairs[:, 0]] - rest[pairs[:, 1]])**2 / 2
    rows = []
    for low, high in zip(LAGS_M, LAGS_M[1:]):
        chosen = (lag >= low) & (lag < high)
        rows.append((np.sqrt(square[chosen].mean()) if chosen.any() else np.nan, int(chosen.sum())))
    return rows, np.std(rest)


def noise(turn):
    """By range: robust sigma of second differences along rings over root 6, n, and 95 % by bootstrap over rings."""
    grid = turn.grid(turn.range_m)
    second = grid[:, 2:] - 2 * grid[:, 1:-1] + grid[:, :-2]
    middle = grid[:, 1:-1]
    rng = np.random.default_rng(2)
    rows = []
    for low, high in zip(RANGES_M, RANGES_M[1:]):
        chosen = np.isfinite(second) & (middle >= low) & (middle < high)
        if chosen.sum() < 200:
            rows.append(None)
            continue
        rings = [np.abs(second[k][chosen[k]]) for k in range(len(second)) if chosen[k].any()]
        draws = [np.median(np.concatenate([rings[i] for i in rng.integers(0, len(rings), len(rings))])) for _ in range(60)]
        scale = 1.4826 / np.sqrt(6)
        rows.append((scale * np.median(np.concatenate(rings)), int(chosen.sum()), *(scale * np.percentile(draws, (2.5, 97.5)))))
    return rows


def grazing(turn, track):
    """By angle from the plumb line, below the horizon: firings and those without a return. The farthest third of the
    window's firings may end in the sky or in walls, which the frames do not tell apart."""
    has = np.isfinite(turn.grid(turn.range_m))
    angle = np.degrees(np.arccos(np.clip(-turn.directions() @ track.frame[2], -1, 1)))
    edges = (0, 60, 70, 75, 80, 85)
    return [(int(np.sum((angle >= a) & (angle < b))), int(np.sum((angle >= a) & (angle < b) & ~has))) for a, b in zip(edges, edges[1:])]
