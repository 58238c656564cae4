"""Clouds of one turn of an Ouster OS1-64: reads them, and finds axis, rings, columns and sense by the points alone.

A part of railway_frames.py. Whatever a file's axes are, the spin axis is the direction about which the points lie on
cones. Which of two mirror images it is, is shown by the rings: they come in fours whose azimuths fall with the
elevation, seen with the axis upwards, and no rotation turns that into its mirror image.
"""

import dataclasses
import pathlib

import numpy as np

ARM_M = 0.012163  # How far off the axis the beams of Ouster's first generation originate (docs/ouster.md).
NUM_RINGS = 64
STEP_RAD = 2 * np.pi / 2048
MOST_WIDTH_DEG = 0.02  # Of the rings, robust sigma: what is wider has not its origin at the sensor.


@dataclasses.dataclass
class Turn:
    """A cloud in the sensor's axes: z is the spin axis, x the middle of the window."""
    name: str
    points: np.ndarray  # N x 3.
    ring: np.ndarray  # From the lowest elevation to the highest.
    column: np.ndarray  # Counter-clockwise, from 0 on.
    range_m: np.ndarray  # As the sensor measures it: along the beam, plus ARM_M.
    elevation_rad: np.ndarray  # By ring.
    azimuth_rad: np.ndarray  # By ring, to be added to the column's.
    first_rad: float  # Azimuth of column 0.
    num_columns: int
    is_mirrored: bool
    width_deg: float  # Of the rings, robust sigma.

    def grid(self, values):
        """Values by ring and column, NaN where there is no point."""
        table = np.full((NUM_RINGS, self.num_columns), np.nan)
        table[self.ring, self.column] = values
        return table

    def directions(self):
        """Unit vectors of all firings, by ring and column."""
        azimuth = self.first_rad + STEP_RAD * np.arange(self.num_columns)[None, :] + self.azimuth_rad[:, None]
        level = np.cos(self.elevation_rad)[:, None]
        up = np.broadcast_to(np.sin(self.elevation_rad)[:, None], azimuth.shape)
        return np.stack([level * np.cos(azimuth), level * np.sin(azimuth), up], axis=-1)

    def origins(self):
        """Where the beams originate, by column."""
        azimuth = self.first_rad + STEP_RAD * np.arange(self.num_columns)
        return ARM_M * np.stack([np.cos(azimuth), np.sin(azimuth), 0 * azimuth], axis=-1)


def read_text(path):
    """The points of a text file, whose first line may be their number."""
    rows = [line.replace(",", " ").split() for line in pathlib.Path(path).read_text().splitlines()]
    return np.array([row[:3] for row in rows if len(row) >= 3], dtype=float)


def entropy(values, width):
    counts = np.bincount(((values + 1) / width).astype(int))
    counts = counts[counts > 0]
    return -np.sum(counts * np.log(counts))


def basis(axis):
    """Rows x, y, z with z along the axis."""
    helper = np.eye(3)[np.argmin(np.abs(axis))]
    x = np.cross(helper, axis)
    x /= np.linalg.norm(x)
    return np.array([x, np.cross(axis, x), axis])


def spin_axis(points):
    """The axis about which the points lie on the sharpest rings."""
    directions = points / np.linalg.norm(points, axis=1)[:, None]
    axis = np.linalg.eigh(directions.T @ directions)[1][:, 0]
    reach = np.radians(6)
    while reach > np.radians(0.01):
        some = directions[:: max(1, len(directions) // 4000)]
        x, y, _ = basis(axis)
        steps = np.linspace(-reach, reach, 11)
        candidates = [axis + a * x + b * y for a in steps for b in steps]
        candidates = [each / np.linalg.norm(each) for each in candidates]
        width = max(reach / 5, np.radians(0.02))
        axis = min(candidates, key=lambda each: entropy(some @ each, width))
        reach /= 2
    return axis


def split_rings(elevation):
    """The ring of each elevation: the nearest of the NUM_RINGS highest peaks of their histogram."""
    bin_rad = np.radians(0.02)
    first = elevation.min() - 20 * bin_rad
    counts = np.bincount(((elevation - first) / bin_rad).astype(int), minlength=1) * 1.0
    counts = np.convolve(np.append(counts, np.zeros(20)), np.ones(3), "same")
    peaks = []
    for _ in range(NUM_RINGS):
        peak = int(np.argmax(counts))
        peaks.append(peak)
        counts[max(0, peak - 12): peak + 13] = -1
    middles = np.sort(first + (np.array(peaks) + 0.5) * bin_rad)
    return np.searchsorted((middles[1:] + middles[:-1]) / 2, elevation)


def refine_axis(points, axis):
    """Axis, origin, rings and their width by least squares, with beams that originate ARM_M off the axis."""
    origin = np.zeros(3)
    for _ in range(5):
        frame = basis(axis)
        x, y, z = ((points - origin) @ frame.T).T
        level = np.hypot(x, y) - ARM_M
        elevation, azimuth, distance = np.arctan2(z, level), np.arctan2(y, x), np.hypot(level, z)
        ring = split_rings(elevation)
        mean = np.array([np.median(elevation[ring == k]) if (ring == k).any() else np.nan for k in range(NUM_RINGS)])
        slopes = np.stack([-np.cos(azimuth), -np.sin(azimuth), -np.sin(elevation) * np.cos(azimuth) / distance,
                           -np.sin(elevation) * np.sin(azimuth) / distance, np.cos(elevation) / distance], axis=1)
        rest = elevation - mean[ring]
        for k in range(NUM_RINGS):
            slopes[ring == k] -= slopes[ring == k].mean(axis=0) if (ring == k).any() else 0
        near = np.abs(rest) < np.radians(0.2)
        step = np.linalg.lstsq(slopes[near], rest[near], rcond=None)[0]
        origin = origin + step[2:] @ frame
        axis = frame[2] + step[0] * frame[0] + step[1] * frame[1]
        axis /= np.linalg.norm(axis)
    return axis, origin, ring, mean, np.degrees(1.4826 * np.median(np.abs(rest)))


def circular_mean(angle, period):
    return np.angle(np.mean(np.exp(2j * np.pi * angle / period))) * period / (2 * np.pi)


def ring_azimuths(azimuth, ring):
    """By ring what is to be added to a column's azimuth, and the number of columns: rings that have both ends of the
    window say it, the others have what most rings at their place among four have."""
    ends = np.array([[azimuth[ring == k].min(), azimuth[ring == k].max()] for k in range(NUM_RINGS)])
    spans = np.rint((ends[:, 1] - ends[:, 0]) / STEP_RAD).astype(int) + 1
    values, counts = np.unique(spans, return_counts=True)
    num_columns = int(values[counts > 1].max())
    whole = spans == num_columns
    middle = ends.mean(axis=1)
    level = np.median(middle[whole])
    by_place = [np.median(middle[whole & (np.arange(NUM_RINGS) % 4 == place)] - level) for place in range(4)]
    offset = np.where(whole, middle - level, 0)
    for k in np.flatnonzero(~whole):
        phase = circular_mean(azimuth[ring == k] - level - by_place[k % 4] - (num_columns - 1) / 2 * STEP_RAD, STEP_RAD)
        offset[k] = by_place[k % 4] + phase
    return offset, level - (num_columns - 1) / 2 * STEP_RAD, num_columns


def find_turn(name, points):
    """The turn, or None if the cloud has no rings about its origin."""
    axis, origin, ring, elevation, width_deg = refine_axis(points, spin_axis(points))
    if width_deg > MOST_WIDTH_DEG:
        return None
    frame = basis(axis)
    local = (points - origin) @ frame.T
    level = local[:, :2] / np.linalg.norm(local[:, :2], axis=1)[:, None]
    middle = np.arctan2(*level.mean(axis=0)[::-1])
    turn_back = np.array([[np.cos(middle), np.sin(middle), 0], [-np.sin(middle), np.cos(middle), 0], [0, 0, 1]])
    local = local @ turn_back.T
    azimuth = np.arctan2(local[:, 1], local[:, 0])
    offset, _, _ = ring_azimuths(azimuth, ring)
    falls = np.mean([offset[k + 3] - offset[k] for k in range(0, NUM_RINGS, 4)]) < 0
    if not falls:
        local[:, 1] *= -1
        azimuth = np.arctan2(local[:, 1], local[:, 0])
    return grid_turn(name, local, ring, elevation, width_deg, not falls)


def grid_turn(name, local, ring, elevation, width_deg, is_mirrored):
    azimuth = np.arctan2(local[:, 1], local[:, 0])
    offset, first_rad, num_columns = ring_azimuths(azimuth, ring)
    column = np.rint((azimuth - first_rad - offset[ring]) / STEP_RAD).astype(int)
    kept = (column >= 0) & (column < num_columns)
    local, ring, column = local[kept], ring[kept], column[kept]
    turn = Turn(name, local, ring, column, np.zeros(len(local)), elevation, offset, first_rad, num_columns, is_mirrored, width_deg)
    turn.range_m = np.linalg.norm(local - turn.origins()[column], axis=1) + ARM_M
    return turn
