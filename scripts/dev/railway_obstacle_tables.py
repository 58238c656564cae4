"""The tables of docs/results/railway.md about an obstacle on the track. A part of railway_frames.py."""

import numpy as np

import railway_obstacle
from railway_simulate import ProgramError
from railway_tables import FAULTS, RUNGS, number, table

# Half widths of the clear space by height above top of rail, docs/results/world_dimensions.md.
CLEAR_HEIGHTS_M = (0.08, 0.08, 0.12, 0.39, 0.39, 1.16, 1.16, 3.58, 3.885, 4.73)
CLEAR_HALF_WIDTHS_M = (0.8735, 1.248, 1.286, 1.556, 1.656, 1.665, 1.690, 1.754, 1.589, 0.93)


def in_clear_space(thing):
    height = thing[:, 2]
    half = np.interp(height, CLEAR_HEIGHTS_M, CLEAR_HALF_WIDTHS_M, left=CLEAR_HALF_WIDTHS_M[0], right=0.0)
    return (height > 0) & (np.abs(thing[:, 1]) < half)


def place_rows(case):
    turn, obstacle = case.turn, case.obstacle
    thing = railway_obstacle.positions(turn, obstacle.track, obstacle.real)[obstacle.firings]
    thing = thing - [0, sum(obstacle.track.heads_m) / 2, 0]
    rng = np.random.default_rng(12)
    rings = np.nonzero(obstacle.firings)[0]
    parts = [thing[rings == k] for k in np.unique(rings)]
    draws = []
    for _ in range(100):
        some = np.concatenate([parts[k] for k in rng.integers(0, len(parts), len(parts))])
        draws.append((*railway_obstacle.rectangle(some[:, :2])[1], np.percentile(some[:, 2], 99) - obstacle.base_m))
    low, high = np.percentile(draws, (2.5, 97.5), axis=0)
    size = " × ".join(f"{a:.2f} [{b:.2f}, {c:.2f}]" for a, b, c in zip(obstacle.size_m, low, high))
    # A point that is not on the thing's own top is at its side: both heads are as high as zero.
    reach = np.percentile(thing, (1, 99), axis=0)
    inside = in_clear_space(thing)
    rows = [[case.name, case.free_name, f"{len(thing):,}", size, f"{obstacle.heading_deg:.0f}",
             f"{obstacle.centre_m[0]:+.2f}, {obstacle.centre_m[1]:+.2f}", *reaches(reach, inside),
             "{:.1f} to {:.1f}".format(*np.percentile(obstacle.real[obstacle.firings], (1, 99)))]]
    if isinstance(case.places, str):
        return rows + [["", f"by `track`: {case.places}"] + ["–"] * (len(PLACE_HEAD) - 2)]
    places = case.places[np.isfinite(case.places["ahead_m"])]
    found = np.stack([places[field] for field in ("ahead_m", "track_lateral_m", "track_height_m")], axis=1)
    middle = railway_obstacle.rectangle(found[:, :2])[0]
    return rows + [["", "by `track`", f"{len(found):,}", "–", "–", f"{middle[0]:+.2f}, {middle[1]:+.2f}",
                    *reaches(np.percentile(found, (1, 99), axis=0), places["in_clear_space"]), "–"]]


def reaches(reach, inside):
    return [f"{reach[0, 1]:+.2f} to {reach[1, 1]:+.2f}", f"{reach[0, 2]:+.2f} to {reach[1, 2]:+.2f}", f"{100 * np.mean(inside):.0f} %"]


PLACE_HEAD = ("frame", "beside the free", "firings on it", "length × width × height over the bed, m", "heading, °",
              "middle along and across, m", "across, m", "above the heads, m", "firings in the clear space", "ranges, m")
CHANGE_HEAD = ("frame", "", "firings nearer by 0.1 m", "intersection over union", "range on common firings, simulated − real, mm",
               "5 to 95 % of it, mm", "noise on it, mm", "between thing and bed, of those at the rim", "shadow behind it, m",
               "lost", "other firings changed")
DETECT_HEAD = ("frame", "cloud", "boxes", "in the vehicle's outline", "counted as the obstacle's", "`detect`")


def change_rows(case):
    turn, obstacle = case.turn, case.obstacle
    mixed, rim = railway_obstacle.between(obstacle.real, obstacle, obstacle.firings)
    lost = np.sum(railway_obstacle.ndimage.binary_dilation(obstacle.firings, structure=np.ones((3, 3)))
                  & np.isfinite(obstacle.free) & ~np.isfinite(obstacle.real))
    rows = [[case.name, "real", f"{obstacle.firings.sum():,}", "–", "–", "–",
             number(railway_obstacle.second_differences(obstacle.real, obstacle.firings), digits=1), f"{mixed} of {rim}",
             f"{railway_obstacle.shadow_m(turn, obstacle, obstacle.firings):.2f}", str(int(lost)), "–"]]
    for (shape, rung), range_m in case.inserted.items():
        if isinstance(range_m, str):
            rows.append(["", f"{shape}, `{rung}`", f"not inserted: {range_m}"] + ["–"] * 8)
            continue
        found = railway_obstacle.compare(turn, obstacle, range_m)
        rows.append(["", f"{shape}, `{rung}`", f"{found['changed']:,}", f"{found['common'] / found['either']:.3f}, {found['either']:,}",
                     number(found["apart"], digits=0), "{:.0f} to {:.0f}".format(*(1e3 * found["spread"])),
                     number(found["noise"], digits=1), "{} of {}".format(*found["between"]), f"{found['shadow']:.2f}",
                     str(found["lost"]), str(found["others"])])
    return rows


def box_row(report):
    section = next(each for each in report["sections"] if each["key"] == "boxes")
    row = section["tables"][0]["rows"][0]
    return row["read"], row["in_gauge"], row["matched"]


def verdict(report):
    tables = [each for section in report["sections"] for each in section["tables"] if each["key"] == "verdicts"]
    return tables[0]["rows"][0]["verdict"]


def detect_rows(case):
    rows = []
    for title, report in case.reports.items():
        if isinstance(report, str):
            rows.append(["" if rows else case.name, title, report, "–", "–", "–"])
            continue
        read, inside, matched = box_row(report[0])
        is_inserted = title not in ("real", "free")
        rows.append(["" if rows else case.name, title, str(read), str(inside), str(matched) if is_inserted else "–",
                     verdict(report[1]) if is_inserted else "–"])
    return rows


class Case:
    """An obstacle, what was inserted in its place by shape and rung, and what `evaluate` reports of each cloud."""

    def __init__(self, name, free_name, turn, obstacle):
        self.name, self.free_name, self.turn, self.obstacle = name, free_name, turn, obstacle
        self.inserted, self.reports, self.places = {}, {}, "not run"

    def simulate(self, build, folder):
        railway_obstacle.prepare(folder, self.turn, self.obstacle)
        try:
            self.places = railway_obstacle.places_by_track(build, folder, self.obstacle)
        except ProgramError as error:
            self.places = str(error)
        for cloud in ("free", "real"):
            try:
                run, _ = railway_obstacle.insert(build, folder, self.turn, self.obstacle, "footprint", "box", cloud, is_far=True)
                self.reports[cloud] = railway_obstacle.evaluate(build, run)
            except ProgramError as error:
                self.reports[cloud] = f"not evaluated: {error}"
        for shape in railway_obstacle.SHAPES:
            for rung in RUNGS:
                title = f"{shape}, `{rung}`"
                try:
                    run, self.inserted[shape, rung] = railway_obstacle.insert(build, folder, self.turn, self.obstacle, rung, shape)
                    self.reports[title] = railway_obstacle.evaluate(build, run)
                except ProgramError as error:
                    self.inserted.setdefault((shape, rung), str(error))
                    self.reports[title] = f"not evaluated: {error}"


def tables(cases):
    """The three tables by the marks of the page."""
    made = {}
    for mark, head, rows_of in (("obstacle", PLACE_HEAD, place_rows), ("insert", CHANGE_HEAD, change_rows),
                                ("evaluate", DETECT_HEAD, detect_rows)):
        rows = []
        for case in cases:
            try:
                rows += rows_of(case)
            except FAULTS as fault:
                rows.append([case.name, f"not measured: {fault}"] + ["–"] * (len(head) - 2))
        made[mark] = table(head, rows) if rows else "No two frames of one place differ by an obstacle."
    return made
