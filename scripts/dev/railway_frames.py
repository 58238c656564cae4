#!/usr/bin/env python3
"""Writes what scripts/dev/railway_frames.sh measures into docs/results/railway.md, and draws its pictures.

usage: /usr/bin/python3 scripts/dev/railway_frames.py FOLDER BUILD_DIR

FOLDER holds text files of points (.pc, .csv, .xyz, .txt), each one turn of a sensor at the origin. Axes, mirrored sides,
mounts, tracks, platforms, frames of one place and obstacles are found by the same rules in each of them; nothing is set
by its name. A frame that cannot be measured gets a row that says why.
"""

import pathlib
import re
import sys
import tempfile

import railway_cloud
import railway_draw
import railway_obstacle
import railway_obstacle_tables
import railway_places
import railway_rails
import railway_simulate
import railway_tables
import railway_track

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "results" / "railway.md"
SUFFIXES = (".pc", ".csv", ".xyz", ".txt")
LEAST_POINTS = 5000
LEAST_SHARE = 0.5  # Of firings with equal ranges in frames of one place.


class Frames:
    """What is known of the files of a folder, by name: turns, tracks, and remarks on what takes no part."""

    def __init__(self, data):
        self.turns, self.tracks, self.track_of, self.remarks, self.sizes, self.matches = {}, {}, {}, {}, {}, {}
        for path in sorted(each for each in data.iterdir() if each.suffix in SUFFIXES):
            self.read(path)
        self.share_tracks()

    def match(self, name, other):
        """How the turn `other` lies on the firings of the turn `name`."""
        if (name, other) not in self.matches:
            self.matches[name, other] = railway_places.match(self.turns[name], self.turns[other])
        return self.matches[name, other]

    def read(self, path):
        try:
            points = railway_cloud.read_text(path)
            self.sizes[path.name] = len(points)
            turn = railway_cloud.find_turn(path.name, points) if len(points) > LEAST_POINTS else None
        except railway_tables.FAULTS as fault:
            self.remarks[path.name] = f"left out: it cannot be read as a turn ({fault})"
            return
        if turn is None:
            self.remarks[path.name] = "left out: no 64 rings about its origin"
            return
        self.turns[path.name] = turn
        for name in self.turns:
            found = self.match(name, path.name) if name != path.name else None
            if found is not None and found.is_copy:
                self.remarks[path.name] = f"left out: the same turn as {name}, with other axes"
                del self.turns[path.name]
                return
        try:
            self.tracks[path.name] = railway_track.find_track(turn)
        except railway_tables.FAULTS:
            self.tracks[path.name] = None

    def share_tracks(self):
        """A frame without a track, or with one of which much is hidden, takes that of the frame of the same place that
        shows most of its heads."""
        own = {name: min(track.head_points) for name, track in self.tracks.items() if track is not None}
        for name in self.turns:
            self.track_of[name] = name
            places = {}
            for other in own:
                found = self.match(other, name) if other != name else None
                if found is not None and found.share > LEAST_SHARE:
                    places[other] = found
            best = max(places, key=own.get, default=None)
            if best is None or own.get(name, 0) > 0.5 * own[best]:
                continue
            self.turns[name] = railway_places.turn_in_place(self.turns[best], self.turns[name], places[best])
            self.matches = {pair: each for pair, each in self.matches.items() if name not in pair}
            self.tracks[name], self.track_of[name] = self.tracks[best], best
        for name, track in self.tracks.items():
            if track is None:
                self.remarks[name] = "no track was found, in it or in a frame of the same place"
            elif self.track_of[name] == name:
                track.platform = railway_rails.platform(self.turns[name], track)

    def table(self):
        rows = []
        for name in sorted({*self.sizes, *self.remarks}):
            turn = self.turns.get(name)
            rows.append((name, f"{self.sizes.get(name, 0):,}", *("–" for _ in range(3))) if turn is None else
                        (name, f"{self.sizes[name]:,}", f"{turn.num_columns}", "yes" if turn.is_mirrored else "no",
                         f"{turn.width_deg:.5f}"))
            rows[-1] += (self.remarks.get(name, "–"),)
        return railway_tables.table(("frame", "points", "columns", "file is mirrored", "width of rings, °", "remark"), rows)


def simulate(build, folder, frames):
    """The places of all frames with a track; a frame whose simulation fails gets a remark."""
    places = {}
    for name in sorted(frames.turns, key=lambda each: frames.track_of[each] != each):
        track = frames.tracks[name]
        if track is None:
            continue
        clouds = {}
        try:
            if frames.track_of[name] in places:
                clouds = places[frames.track_of[name]].simulated
            else:
                for rung in railway_tables.RUNGS:
                    clouds[rung] = railway_simulate.simulate(build, folder / name, frames.turns[name], track, rung)
                clouds[railway_tables.QUIET] = railway_simulate.simulate(build, folder / name, frames.turns[name], track, "footprint", True)
        except (railway_simulate.ProgramError, *railway_tables.FAULTS) as error:
            frames.remarks[name] = f"not simulated: {error}"
        print(f"{name}: {', '.join(clouds) or 'nothing'} simulated", flush=True)
        places[name] = railway_tables.Place(name, frames.turns[name], track, frames.track_of[name], clouds)
    return [places[name] for name in sorted(places)]


def find_cases(build, folder, frames):
    """Obstacles in frames that are beside a free one of the same place: that with most of its heads to see."""
    cases = []
    for name in frames.turns:
        own = {other: min(track.head_points) for other, track in frames.tracks.items()
               if track is not None and frames.track_of[other] == other}
        found = {other: frames.match(other, name) for other in own if other != name}
        free = max((other for other, each in found.items() if each is not None and each.share > LEAST_SHARE), key=own.get, default=None)
        if free is None or own.get(name, 0) > own[free]:
            continue
        turn = frames.turns[free]
        obstacle = railway_obstacle.find_obstacle(turn, frames.tracks[free], found[free].grid(turn, frames.turns[name]))
        if obstacle is None:
            continue
        case = railway_obstacle_tables.Case(name, free, turn, obstacle)
        case.simulate(build, folder / f"insert_{name}")
        print(f"{name}: {len(case.inserted)} insertions beside {free}", flush=True)
        cases.append(case)
    return cases


def draw_largest(cases, folder):
    """The picture of the obstacle with the most firings."""
    drawn = [case for case in cases if all(not isinstance(case.inserted.get((shape, "footprint"), ""), str)
                                           for shape in railway_obstacle.SHAPES)]
    if drawn:
        case = max(drawn, key=lambda each: each.obstacle.firings.sum())
        views = [("Real", case.obstacle.real), ("A box of its size", case.inserted["box", "footprint"]),
                 ("A heap of its size", case.inserted["heap", "footprint"])]
        railway_draw.draw_obstacle(case.turn, case.obstacle, views, folder)


def fill(page, marks):
    for mark, text in marks.items():
        page, count = re.subn(rf"(<!-- railway: {mark} -->\n).*?(?=<!-- end -->)",
                              lambda match, text=text: match[1] + text + "\n", page, flags=re.DOTALL)
        if count != 1:
            raise SystemExit(f"{PAGE}: must have the marks of {mark}")
    return page


def main(arguments):
    if len(arguments) != 2:
        raise SystemExit(__doc__)
    data, build = (pathlib.Path(each).resolve() for each in arguments)
    frames = Frames(data)
    with tempfile.TemporaryDirectory() as name_of_folder:
        folder = pathlib.Path(name_of_folder)
        places = simulate(build, folder, frames)
        cases = find_cases(build, folder, frames)
        railway_draw.draw_curves(places, folder)
        draw_largest(cases, folder)
    makers = {"track": railway_tables.track_table, "heights": railway_tables.height_table, "platform": railway_tables.platform_table,
              "bed": railway_tables.bed_table, "relief": railway_tables.relief_table, "sleepers": railway_tables.sleeper_table,
              "density": railway_tables.density_table, "rails": railway_tables.rail_table, "firings": railway_tables.firing_table,
              "grazing": railway_tables.grazing_table, "noise": railway_tables.noise_table}
    without = [railway_tables.Place(name, turn, None, name, {}) for name, turn in frames.turns.items() if frames.tracks[name] is None]
    marks = {"frames": frames.table()} | {
        mark: make(places + without if mark == "noise" else places) for mark, make in makers.items()}
    PAGE.write_text(fill(PAGE.read_text(encoding="utf-8"), marks | railway_obstacle_tables.tables(cases)), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
