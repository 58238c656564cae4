"""The tables of docs/results/railway.md about tracks, beds, rails and firings. A part of railway_frames.py."""

import dataclasses

import numpy as np

import railway_bed
import railway_firings
import railway_rails
import railway_track

RUNGS = ("plausibility", "surface", "footprint", "reference")
QUIET = "footprint, no noise"
# A single frame must not end the script: these are what measures raise where there is too little to measure.
FAULTS = (ValueError, IndexError, KeyError, TypeError, StopIteration, np.linalg.LinAlgError)


@dataclasses.dataclass
class Place:
    """A frame with the track in it and what was simulated in its place, by rung."""
    name: str
    turn: object
    track: object
    track_of: str  # The frame in which the track was found.
    simulated: dict

    def rungs(self):
        return [(f"`{rung}`", self.simulated[rung]) for rung in RUNGS if rung in self.simulated]

    def clouds(self):
        """The real turn and the simulated ones, which a frame with another's track shares with it and does not repeat."""
        return [("real", self.turn)] + (self.rungs() if self.track_of == self.name else [])

    def clouds_without_noise(self):
        is_own = self.track_of == self.name and QUIET in self.simulated
        return self.clouds() + ([("`footprint`, no noise", self.simulated[QUIET])] if is_own else [])

    def pair(self):
        """The real turn and that of rung footprint."""
        return [each for each in self.clouds() if each[0] in ("real", "`footprint`")]


def number(found, scale=1e3, digits=0):
    """A value with its interval and n."""
    if found is None or not np.isfinite(found[0]):
        return "–"
    value, low, high, n = found
    return f"{scale * value:.{digits}f} [{scale * low:.{digits}f}, {scale * high:.{digits}f}], {n:,}"


def table(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head)] + ["| " + " | ".join(row) + " |" for row in rows])


def filled(head, places, rows_of):
    """A table with the rows of each frame, or one that says that it could not be measured."""
    rows = []
    for place in places:
        try:
            rows += rows_of(place)
        except FAULTS as fault:
            rows.append([place.name, f"not measured: {fault}"] + ["–"] * (len(head) - 2))
    return table(head, rows)


def track_rows(place):
    track = place.track
    found = railway_track.find_track(place.simulated["footprint"]) if "footprint" in place.simulated else None
    ours = "–" if found is None else f"{1e3 * (found.heads_m[1] - found.heads_m[0]):.0f} " \
        f"[{1e3 * found.interval_m[0]:.0f}, {1e3 * found.interval_m[1]:.0f}]"
    apart = track.heads_m[1] - track.heads_m[0]
    others = ", ".join(f"{abs(each):.2f}" for each in sorted(track.others_m, key=abs)) or "–"
    return [(place.name, "itself" if place.track_of == place.name else place.track_of, f"{track.height_m:.3f}",
             f"{abs(sum(track.heads_m) / 2):.3f}", f"{1e3 * apart:.0f} [{1e3 * track.interval_m[0]:.0f}, "
             f"{1e3 * track.interval_m[1]:.0f}]", "{} and {}".format(*track.head_points), ours, f"{1e3 * (apart - 0.072):.0f}",
             str(1 + len(track.others_m)), others)]


def track_table(places):
    return filled(("frame", "track found in", "sensor above the heads, m", "beside the track's axis, m", "heads' distance, mm",
                   "points on heads", "simulated, mm", "gauge, mm", "tracks", "other axes from this one, m"), places, track_rows)


def height_rows(place):
    rows = []
    for kind, cloud in place.pair():
        found = railway_bed.heights(cloud, place.track)
        rows.append([place.name if kind == "real" else "", kind] + [
            number(found[name]) for name in ("middle", "shoulder_near", "shoulder_far", "ground_near", "ground_far")])
    return rows


def height_table(places):
    return filled(("frame", "", "bed, middle", "0.25 to 0.55 m outside, sensor's side", "the same, far side",
                   "0.9 to 1.4 m outside, sensor's side", "the same, far side"), places, height_rows)


def platform_rows(place):
    rows = []
    for kind, cloud in place.pair():
        found = railway_rails.platform(cloud, place.track)
        if found is None:
            continue
        sign, edge, height, deviation = found
        over_bed = railway_bed.heights(cloud, place.track)["middle"]
        rows.append([place.name if kind == "real" else "", kind, number(edge), number(height),
                     "–" if over_bed is None else f"{1e3 * (height[0] + over_bed[0]):.0f}", f"{1e3 * deviation:.0f}"])
    return rows


def platform_table(places):
    return filled(("frame", "", "edge from the axis, mm", "above the heads, mm", "above the bed, mm", "sd of heights, mm"),
                  places, platform_rows)


def bed_rows(place):
    track = place.track
    real = railway_bed.strips(railway_bed.bed_points(place.turn, track), track)
    rows = []
    for kind, cloud in place.rungs():
        ours = railway_bed.strips(railway_bed.bed_points(cloud, track), track)
        pairs = [(a, b) for a, b in zip(real, ours) if np.isfinite(a[0]) and np.isfinite(b[0])]
        depth, count = (np.array([[a[i], b[i]] for a, b in pairs]) for i in (0, 1))
        apart = depth[:, 1] - depth[:, 0]
        rng = np.random.default_rng(3)
        low, high = np.percentile([np.mean(rng.choice(apart, len(apart))) for _ in range(500)], (2.5, 97.5))
        ratio = count[:, 1] / count[:, 0]
        rows.append((place.name if not rows else "", kind, str(len(pairs)), f"{-1e3 * np.median(depth[:, 0]):.0f}",
                     f"{-1e3 * np.median(depth[:, 1]):.0f}", f"{1e3 * apart.mean():.1f} [{1e3 * low:.1f}, {1e3 * high:.1f}]",
                     f"{1e3 * np.std(apart):.1f}", f"{count[:, 0].sum():,}",
                     f"{100 * (count[:, 1].sum() / count[:, 0].sum() - 1):+.1f} %", f"{100 * np.std(ratio):.1f} %"))
    return rows


def bed_table(places):
    return filled(("frame", "rung", "strips", "real bed below the heads, mm", "simulated, mm", "simulated − real, mm",
                   "sd of strips, mm", "real points", "simulated points", "sd of strips"), places, bed_rows)


def relief_rows(place):
    rows = []
    for kind, cloud in place.clouds_without_noise():
        lags, rms = railway_bed.relief(railway_bed.bed_points(cloud, place.track))
        rows.append([place.name if kind == "real" else "", kind] + [
            f"{1e3 * value:.1f} [{1e3 * low:.1f}, {1e3 * high:.1f}]" if n > 30 else "–" for value, low, high, n in lags]
            + [number(rms, digits=1)])
    return rows


def relief_table(places):
    lags = [f"{1e3 * a:.0f}–{1e3 * b:.0f}" for a, b in zip(railway_bed.LAGS_M, railway_bed.LAGS_M[1:])]
    return filled(["frame", "", *lags, "rms, points"], places, relief_rows)


def sleeper_rows(place):
    rows = []
    for kind, cloud in place.clouds_without_noise():
        if kind not in ("real", "`footprint`", "`footprint`, no noise"):
            continue
        period, depth, (low, high), mine, chance, n = railway_bed.sleepers(railway_bed.bed_points(cloud, place.track))
        rows.append([place.name if kind == "real" else "", kind, f"{1e3 * period:.0f}",
                     f"{1e3 * depth:.1f} [{1e3 * low:.1f}, {1e3 * high:.1f}]", f"{100 * mine:.0f} %", f"{100 * chance:.0f} %", f"{n:,}"])
    return rows


def sleeper_table(places):
    return filled(("frame", "", "strongest period, mm", "crest above trough, mm", "share of the profile's variance",
                   "95 % of shuffled profiles have less than", "points"), places, sleeper_rows)


def density_rows(place):
    rows = []
    for kind, cloud in place.pair():
        rows.append([place.name if kind == "real" else "", kind] +
                    [number(each, 1) for each in railway_bed.density(cloud, place.track)])
    return rows


def density_table(places):
    edges = railway_bed.DENSITY_RANGES_M
    return filled(["frame", ""] + [f"{a} to {b} m" for a, b in zip(edges, edges[1:])], places, density_rows)


def heads(place):
    return list(zip(("near", "far"), railway_rails.by_side(place.track)))


def rail_rows(place):
    rows = []
    depth = railway_bed.heights(place.turn, place.track)["middle"]
    for which, head_m in heads(place):
        for kind, cloud in place.pair():
            width, height = railway_rails.head_size(cloud, place.track, head_m)
            dark = railway_rails.shadow(cloud, place.track, head_m)
            farthest, metres = railway_rails.farthest_m(cloud, place.track, head_m)
            line = railway_rails.expected_shadow_m(place.track, head_m, depth[0] if depth else 0.22)
            rows.append([place.name if not rows else "", which if kind == "real" else "", kind, number(width), number(height),
                         "none" if dark is None else f"{1e3 * dark[0]:.0f} to {1e3 * dark[1]:.0f}, {dark[2]} for {dark[3]:.0f}",
                         f"{1e3 * line:.0f}", f"{farthest:.1f}, {metres}"])
    return rows


def rail_table(places):
    return filled(("frame", "head", "", "width, mm", "height over its foot, mm",
                   "shadow behind the head's middle, mm; points in it, for each 2 cm of bed", "straight line ends at, mm",
                   "seen to, m; metres of rail"), places, rail_rows)


def firing_rows(place):
    rows = []
    for which, head_m in heads(place):
        for kind, cloud in place.pair():
            found = railway_rails.head_firings(cloud, place.track, head_m)
            rows.append([place.name if not rows else "", which if kind == "real" else "", kind] + [
                "–" if each is None else f"{number(each[:4], 1, 1)}; {each[4]:.0f}°, {each[5]:.0f}°" for each in found])
    return rows


def firing_table(places):
    edges = railway_rails.HEAD_RANGES_M
    return filled(["frame", "head", ""] + [f"{a} to {b} m" for a, b in zip(edges, edges[1:])], places, firing_rows)


def share(part, whole):
    """A percentage with Wilson's interval."""
    if whole == 0:
        return "–"
    p, z = part / whole, 1.96
    middle, half = (p + z * z / 2 / whole), z * np.sqrt(p * (1 - p) / whole + z * z / 4 / whole**2)
    low, high = ((middle + sign * half) / (1 + z * z / whole) for sign in (-1, 1))
    return f"{100 * p:.2f} [{100 * max(0, low):.2f}, {100 * high:.2f}]"


def grazing_rows(place):
    rows = []
    for kind, cloud in place.clouds():
        bins = railway_firings.grazing(cloud, place.track)
        first = [railway_firings.first_lost(cloud, place.track, part) for part in (0.05, 0.5)]
        rows.append([place.name if kind == "real" else "", kind] + [share(lost, fired) for fired, lost in bins]
                    + ["–" if each is None else f"{each}°, {place.track.height_m / np.cos(np.radians(each)):.0f} m" for each in first])
    edges = railway_firings.ANGLES_DEG
    rows.append(["", "range, m"] + [f"{place.track.height_m / np.cos(np.radians(a)):.0f} to "
                                    f"{place.track.height_m / np.cos(np.radians(b)):.0f}" for a, b in zip(edges, edges[1:])] + ["", ""])
    rows.append(["", "firings"] + [f"{fired:,}" for fired, _ in bins] + ["", ""])
    return rows


def grazing_table(places):
    edges = railway_firings.ANGLES_DEG
    return filled(["frame", ""] + [f"{a} to {b}°" for a, b in zip(edges, edges[1:])] + ["5 % lost from", "50 % lost from"],
                  places, grazing_rows)


def noise_rows(place):
    return [[place.name if kind == "real" else "", kind] + [
        "–" if each is None else f"{1e3 * each[0]:.1f} [{1e3 * each[2]:.1f}, {1e3 * each[3]:.1f}], {each[1]:,}"
        for each in railway_firings.noise(cloud)] for kind, cloud in place.clouds()]


def noise_table(places):
    edges = railway_firings.RANGES_M
    return filled(["frame", ""] + [f"{a} to {b} m" for a, b in zip(edges, edges[1:])], places, noise_rows)
