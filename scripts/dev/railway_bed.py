"""Measures the bed between the rails and the heights beside them. A part of railway_frames.py."""

import numpy as np
from scipy.spatial import cKDTree

from railway_track import foot_m, in_track

STRIP_M = 0.04
LAGS_M = (0.014, 0.020, 0.030, 0.040, 0.050, 0.070, 0.100, 0.150, 0.200, 0.250)
BLOCK_M = 0.25  # Along the track, for intervals: stones and sleepers lie in it together.
PERIODS_M = (0.45, 0.90)  # Of sleepers.
DENSITY_RANGES_M = (3, 4, 5, 6, 8, 12, 20, 40)


def interval(draws):
    return tuple(np.percentile(draws, (2.5, 97.5)))


def bed_points(turn, track, reach=None):
    """Points between the heads, from 0.2 m beside the one to 0.2 m beside the other."""
    local = in_track(turn, track)
    low, high = track.heads_m
    reach = reach or 0.6 * np.tan(np.radians(30)) * track.height_m
    inside = (local[:, 1] > low + 0.2) & (local[:, 1] < high - 0.2) & (np.abs(local[:, 2] + 0.2) < 0.2) & \
        (np.abs(local[:, 0] - foot_m(turn, track)) < reach)
    return local[inside]


def strips(bed, track):
    """Median height and number of points of strips of 4 cm, from 0.2 m beside the first head on."""
    strip = ((bed[:, 1] - track.heads_m[0] - 0.2) / STRIP_M).astype(int)
    heights = [bed[strip == k, 2] for k in range(int((track.heads_m[1] - track.heads_m[0] - 0.4) / STRIP_M))]
    return [(np.median(z), len(z)) if len(z) > 5 else (np.nan, len(z)) for z in heights]


def residuals(bed, degree=3):
    """Heights about a smooth surface, and which points are no outliers of 0.1 m."""
    x, y = (bed[:, i] - bed[:, i].mean() for i in (0, 1))
    design = np.stack([x**i * y**j for i in range(degree + 1) for j in range(degree + 1 - i)], axis=1)
    rest = bed[:, 2] - design @ np.linalg.lstsq(design, bed[:, 2], rcond=None)[0]
    return rest, np.abs(rest) < 0.1


def relief(bed):
    """By lag (root of half the mean squared difference, its interval by bootstrap over blocks, number of pairs), and the
    rms about the smooth surface with its interval."""
    rest, kept = residuals(bed)
    rest, plan = rest[kept], bed[kept, :2]
    block = ((plan[:, 0] - plan[:, 0].min()) / BLOCK_M).astype(int) * 8 + ((plan[:, 1] - plan[:, 1].min()) / BLOCK_M).astype(int)
    block = np.unique(block, return_inverse=True)[1]
    num_blocks = block.max() + 1
    pairs = cKDTree(plan).query_pairs(LAGS_M[-1], output_type="ndarray")
    lag = np.linalg.norm(plan[pairs[:, 0]] - plan[pairs[:, 1]], axis=1)
    square = (rest[pairs[:, 0]] - rest[pairs[:, 1]])**2 / 2
    weights = np.random.default_rng(4).multinomial(num_blocks, np.full(num_blocks, 1 / num_blocks), 300)

    def estimate(values, of_block):
        sums, counts = np.bincount(of_block, values, num_blocks), np.bincount(of_block, minlength=num_blocks)
        draws = np.sqrt((weights @ sums) / np.maximum(weights @ counts, 1))
        return (np.sqrt(values.mean()), *interval(draws), len(values)) if len(values) else (np.nan, np.nan, np.nan, 0)

    rows = []
    for low, high in zip(LAGS_M, LAGS_M[1:]):
        chosen = (lag >= low) & (lag < high)
        rows.append(estimate(square[chosen], block[pairs[chosen, 0]]))
    return rows, estimate(rest**2, block)


def sleepers(bed):
    """(period, height of the sleepers above the gaps, its interval, the period's share of the variance, the share that 95 %
    of shuffled profiles stay below, n): the strongest period of the mean heights of 2 cm along the track. Pieces of 6 cm,
    as long as a stone, are shuffled."""
    rest, kept = residuals(bed)
    along, rest = bed[kept, 0], rest[kept]
    cell = np.floor(along / 0.02).astype(int)
    cell -= cell.min()
    count = np.bincount(cell)
    profile = np.where(count > 4, np.bincount(cell, rest) / np.maximum(count, 1), 0)
    place = 0.02 * np.arange(len(profile))
    periods = 1 / np.linspace(1 / PERIODS_M[1], 1 / PERIODS_M[0], 200)
    waves = np.exp(2j * np.pi * place[:, None] / periods[None, :])

    def power(values):
        return 2 * np.abs(values @ waves)**2 / len(values) / max(np.sum(values**2), 1e-12)

    rng = np.random.default_rng(5)
    mine = power(profile)
    best = int(np.argmax(mine))
    pieces = [profile[i: i + 3] for i in range(0, len(profile), 3)]
    chance = [power(np.concatenate([pieces[k] for k in rng.permutation(len(pieces))])).max() for _ in range(200)]
    phase = (along / periods[best] - np.angle(np.exp(2j * np.pi * along / periods[best]) @ rest) / 2 / np.pi) % 1
    top, gap = (phase < 0.15) | (phase > 0.85), np.abs(phase - 0.5) < 0.15
    depth = rest[top].mean() - rest[gap].mean()
    draws = [rng.choice(rest[top], top.sum()).mean() - rng.choice(rest[gap], gap.sum()).mean() for _ in range(200)]
    return periods[best], depth, interval(draws), mine[best], float(np.percentile(chance, 95)), int(kept.sum())


def density(turn, track):
    """By range: points on a square metre of the bed between the heads, their interval over blocks along the track, and n."""
    low, high = track.heads_m[0] + 0.2, track.heads_m[1] - 0.2
    step = 0.05
    xs, ys = np.arange(-45, 45, step) + step / 2, np.arange(low, high, step) + step / 2
    cells = np.stack([*np.meshgrid(xs, ys, indexing="ij"), np.full((len(xs), len(ys)), -0.22 - track.height_m)], axis=-1)
    toward = cells @ track.frame
    azimuth = np.arctan2(toward[..., 1], toward[..., 0]) - turn.first_rad
    elevation = np.arctan2(toward[..., 2], np.hypot(toward[..., 0], toward[..., 1]))
    margin = np.radians(3.5)  # Rings are offset by so much: beyond it every ring has the azimuth.
    width = 2 * np.pi / 2048 * turn.num_columns
    seen = (azimuth > margin) & (azimuth < width - margin) & \
        (elevation > turn.elevation_rad[0]) & (elevation < turn.elevation_rad[-1])
    cell_range = np.linalg.norm(toward, axis=-1)
    local = in_track(turn, track)
    inside = (local[:, 1] > low) & (local[:, 1] < low + len(ys) * step) & (np.abs(local[:, 2] + 0.2) < 0.35) & (np.abs(local[:, 0]) < 45)
    index = np.floor((local[inside, :2] - [-45, low]) / step).astype(int)
    count = np.zeros(seen.shape)
    np.add.at(count, (index[:, 0], index[:, 1]), 1)
    rows = []
    rng = np.random.default_rng(6)
    for near, far in zip(DENSITY_RANGES_M, DENSITY_RANGES_M[1:]):
        chosen = seen & (cell_range >= near) & (cell_range < far)
        area = chosen.sum(axis=1) * step**2
        points = (count * chosen).sum(axis=1)
        blocks = np.arange(len(xs)) // 10
        areas, numbers = np.bincount(blocks, area), np.bincount(blocks, points)
        areas, numbers = areas[areas > 0], numbers[areas > 0]
        if areas.sum() < 0.3:
            rows.append(None)
            continue
        draws = rng.multinomial(len(areas), np.full(len(areas), 1 / len(areas)), 300)
        rows.append((numbers.sum() / areas.sum(), *interval((draws @ numbers) / np.maximum(draws @ areas, 1e-9)), int(numbers.sum())))
    return rows


def heights(turn, track):
    """Height of the heads over the bed in the middle, inside and outside the rails and farther out on either side:
    (median, interval over blocks, n), by name; a side is that of the track, away from the sensor or towards it."""
    local = in_track(turn, track)
    near = local[np.abs(local[:, 0] - foot_m(turn, track)) < 0.5 * track.height_m]
    low, high = track.heads_m
    middle = (low + high) / 2
    toward = 1 if middle < 0 else -1  # The sensor's side.
    half = (high - low) / 2
    beyond = (near[:, 1] - middle) * toward
    bands = {"middle": (-0.25, 0.25), "shoulder_near": (half + 0.25, half + 0.55), "shoulder_far": (-half - 0.55, -half - 0.25),
             "ground_near": (half + 0.9, half + 1.4), "ground_far": (-half - 1.4, -half - 0.9)}
    found = {}
    rng = np.random.default_rng(7)
    for name, (a, b) in bands.items():
        chosen = near[(beyond > a) & (beyond < b) & (near[:, 2] > -0.9) & (near[:, 2] < 0.15)]
        if len(chosen) < 30:
            found[name] = None
            continue
        block = np.unique((chosen[:, 0] / BLOCK_M).astype(int), return_inverse=True)[1]
        parts = [chosen[block == k, 2] for k in range(block.max() + 1)]
        draws = [-np.median(np.concatenate([parts[k] for k in rng.integers(0, len(parts), len(parts))])) for _ in range(200)]
        found[name] = (-np.median(chosen[:, 2]), *interval(draws), len(chosen))
    return found
