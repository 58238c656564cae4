"""Which turns were made in the same place, told by their directions and ranges. A part of railway_frames.py."""

import dataclasses

import numpy as np

from railway_cloud import NUM_RINGS, STEP_RAD, Turn

MOST_ELEVATION_RAD = np.radians(0.01)  # Between the rings of two turns of one sensor, median.
MOST_SHIFT = 40  # Columns.
NEAR_M = 0.05  # Ranges of the same firing that count as equal.


def turned_over(turn):
    """The same turn with the spin axis the other way up: half a turn about x."""
    last = turn.num_columns - 1
    return Turn(turn.name, turn.points * [1, -1, -1], NUM_RINGS - 1 - turn.ring, last - turn.column, turn.range_m,
                -turn.elevation_rad[::-1], -turn.azimuth_rad[::-1], -(turn.first_rad + last * STEP_RAD), turn.num_columns,
                turn.is_mirrored, turn.width_deg)


def shifted_grid(turn, num_columns, shift):
    grid = np.full((NUM_RINGS, num_columns), np.nan)
    column = turn.column + shift
    kept = (column >= 0) & (column < num_columns)
    grid[turn.ring[kept], column[kept]] = turn.range_m[kept]
    return grid


@dataclasses.dataclass
class Match:
    """How `other` lies on a turn's firings: whether it is turned over, by how many columns it is shifted, the share of
    their common firings with equal ranges, and whether all are equal to a millimetre."""
    is_turned_over: bool
    shift: int
    share: float
    is_copy: bool

    def grid(self, turn, other):
        """Ranges of `other` by ring and column of `turn`."""
        return shifted_grid(turned_over(other) if self.is_turned_over else other, turn.num_columns, self.shift)


def match(turn, other):
    """The best match of two turns, or None if their rings differ. The shift is sought on every fourth ring."""
    mine = turn.grid(turn.range_m)
    found = []
    for is_turned_over in (False, True):
        candidate = turned_over(other) if is_turned_over else other
        if np.median(np.abs(candidate.elevation_rad - turn.elevation_rad)) > MOST_ELEVATION_RAD:
            continue
        theirs = shifted_grid(candidate, turn.num_columns + 2 * MOST_SHIFT, MOST_SHIFT)[::4]
        for shift in range(-MOST_SHIFT, MOST_SHIFT + 1):
            first = MOST_SHIFT - shift
            equal = np.abs(theirs[:, first: first + turn.num_columns] - mine[::4]) < NEAR_M
            found.append((int(equal.sum()), is_turned_over, shift))
    if not found:
        return None
    _, is_turned_over, shift = max(found)
    best = Match(is_turned_over, shift, 0.0, False)
    apart = np.abs(best.grid(turn, other) - mine)
    apart = apart[np.isfinite(apart)]
    if len(apart):
        best.share = np.sum(apart < NEAR_M) / np.sum(np.isfinite(mine))
        best.is_copy = np.mean(apart < 1.5e-3) > 0.99
    return best


def turn_in_place(turn, other, found):
    """`other` with the axes, rings and columns of `turn`."""
    grid = found.grid(turn, other)
    ring, column = np.nonzero(np.isfinite(grid))
    range_m = grid[ring, column]
    points = turn.origins()[column] + turn.directions()[ring, column] * (range_m - np.linalg.norm(turn.origins()[0]))[:, None]
    return dataclasses.replace(turn, name=other.name, points=points, ring=ring, column=column, range_m=range_m)
