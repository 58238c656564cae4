#!/usr/bin/env python3
"""Writes what scripts/dev/railway_frames.sh measures into docs/results/railway.md, and draws docs/images/railway.png.

usage: /usr/bin/python3 scripts/dev/railway_frames.py FOLDER BUILD_DIR

Mounts, tracks, axes and mirrored sides are found in each frame by the same rules; nothing is set by its name.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

import railway_cloud
import railway_simulate
import railway_track

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "results" / "railway.md"
PICTURE = ROOT / "docs" / "images" / "railway.png"
NAMES = ("Vizmarje.pc", "Vizmarje2.pc", "Vizmarje3.pc", "Vizmarje4.pc", "Jesenice1.pc", "JesenicePartialObstacle.pc",
         "JeseniceLowObstacle.pc", "JeseniceFullObstacle.pc", "Vienna.csv", "Zagreb.pc")
RUNGS = ("plausibility", "surface", "footprint", "reference")
# The published model's noise moves points off their beams, so that its firings are not known again.
RUNGS_BY_FIRING = RUNGS[1:]


def mm(value):
    return "–" if value is None or not np.isfinite(value) else f"{1e3 * value:.1f}"


def table(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head)] + ["| " + " | ".join(row) + " |" for row in rows])


def place_table(places):
    rows = []
    for name, turn, track, simulated in places:
        found = railway_track.find_track(simulated["footprint"])
        low, high = track.interval_m
        ours = "–" if found is None else f"{1e3 * (found.heads_m[1] - found.heads_m[0]):.0f} " \
            f"[{1e3 * found.interval_m[0]:.0f}, {1e3 * found.interval_m[1]:.0f}]"
        rows.append((name, f"{len(turn.ring):,}", "yes" if turn.is_mirrored else "no", f"{track.height_m:.3f}",
                     f"{abs(sum(track.heads_m) / 2):.3f}", f"{1e3 * (track.heads_m[1] - track.heads_m[0]):.0f} "
                     f"[{1e3 * low:.0f}, {1e3 * high:.0f}]", "{} and {}".format(*track.head_points), ours))
    return table(("frame", "points", "file is mirrored", "sensor above the heads, m", "beside the track's axis, m",
                  "heads' distance, mm", "points on heads", "simulated, mm"), rows)


def bed_table(places):
    rows = []
    for name, turn, track, simulated in places:
        real = railway_track.strips(railway_track.bed_points(turn, track), track)
        for rung in RUNGS:
            ours = railway_track.strips(railway_track.bed_points(simulated[rung], track), track)
            pairs = [(a, b) for a, b in zip(real, ours) if np.isfinite(a[0]) and np.isfinite(b[0])]
            depth = np.array([[a[0], b[0]] for a, b in pairs])
            apart = depth[:, 1] - depth[:, 0]
            rng = np.random.default_rng(3)
            low, high = np.percentile([np.mean(rng.choice(apart, len(apart))) for _ in range(500)], (2.5, 97.5))
            count = np.array([[a[1], b[1]] for a, b in pairs])
            rows.append((name if rung == RUNGS[0] else "", f"`{rung}`", str(len(pairs)), f"{-1e3 * np.median(depth[:, 0]):.0f}",
                         f"{-1e3 * np.median(depth[:, 1]):.0f}", f"{1e3 * apart.mean():.1f} [{1e3 * low:.1f}, {1e3 * high:.1f}]",
                         f"{1e3 * np.std(apart):.1f}", f"{count[:, 0].sum():,}",
                         f"{100 * (count[:, 1].sum() / count[:, 0].sum() - 1):+.1f} %"))
    return table(("frame", "rung", "strips", "real bed below the heads, mm", "simulated, mm", "simulated − real, mm",
                  "sd of strips, mm", "real points", "simulated points"), rows)


def relief_table(places):
    lags = [f"{1e3 * a:.0f}–{1e3 * b:.0f}" for a, b in zip(railway_track.LAGS_M, railway_track.LAGS_M[1:])]
    head = ["frame", "", *lags, "rms", "points"]
    rows = []
    for name, turn, track, simulated in places:
        for kind, cloud in [("real", turn)] + [(f"`{rung}`", simulated[rung]) for rung in RUNGS]:
            bed = railway_track.bed_points(cloud, track)
            lags, rms = railway_track.relief(bed)
            rows.append([name if kind == "real" else "", kind] + [mm(value) if count > 30 else "–" for value, count in lags]
                        + [mm(rms), f"{len(bed):,}"])
    return table(head, rows)


def noise_table(turns, places):
    simulated = {name: {rung: clouds[rung] for rung in RUNGS_BY_FIRING} for name, _, _, clouds in places}
    head = ["frame", ""] + [f"{a} to {b} m" for a, b in zip(railway_track.RANGES_M, railway_track.RANGES_M[1:])]
    rows = []
    for name, turn in turns.items():
        for kind, cloud in [("real", turn)] + [(f"`{rung}`", cloud) for rung, cloud in simulated.get(name, {}).items()]:
            rows.append([name if kind == "real" else "", kind] + [
                "–" if each is None else f"{1e3 * each[0]:.1f} [{1e3 * each[2]:.1f}, {1e3 * each[3]:.1f}], {each[1]:,}"
                for each in railway_track.noise(cloud)])
    return table(head, rows)


def share(part, whole):
    """A percentage with Wilson's interval."""
    if whole == 0:
        return "–"
    p, z = part / whole, 1.96
    middle, half = (p + z * z / 2 / whole), z * np.sqrt(p * (1 - p) / whole + z * z / 4 / whole**2)
    low, high = ((middle + sign * half) / (1 + z * z / whole) for sign in (-1, 1))
    return f"{100 * p:.2f} [{100 * max(0, low):.2f}, {100 * high:.2f}]"


def grazing_table(places):
    rows = []
    for name, turn, track, simulated in places:
        for kind, cloud in [("real", turn)] + [(f"`{rung}`", simulated[rung]) for rung in RUNGS_BY_FIRING]:
            bins = railway_track.grazing(cloud, track)
            rows.append([name if kind == "real" else "", kind] + [share(lost, fired) for fired, lost in bins])
        rows.append(["", "firings"] + [f"{fired:,}" for fired, _ in bins])
    return table(("frame", "", "0 to 60°", "60 to 70°", "70 to 75°", "75 to 80°", "80 to 85°"), rows)


def draw(places, folder):
    for kind in ("real", "footprint"):
        lines, noises = [], []
        for i, (name, turn, track, simulated) in enumerate(places):
            cloud = turn if kind == "real" else simulated[kind]
            lags, _ = railway_track.relief(railway_track.bed_points(cloud, track))
            lines += [f"{1e3 * np.sqrt(a * b):.1f} {1e3 * value[0]:.2f}" for a, b, value in
                      zip(railway_track.LAGS_M, railway_track.LAGS_M[1:], lags)] + ["", ""]
            noises += [f"{np.sqrt(a * b):.2f} {1e3 * each[0]:.2f}" for a, b, each in
                       zip(railway_track.RANGES_M, railway_track.RANGES_M[1:], railway_track.noise(cloud)) if each] + ["", ""]
        (folder / f"{kind}_relief.dat").write_text("\n".join(lines))
        (folder / f"{kind}_noise.dat").write_text("\n".join(noises))
    plots = {what: ", ".join(
        f"'{folder}/{kind}_{what}.dat' index {i} using 1:2 with linespoints pointtype {7 if kind == 'real' else 6} linecolor "
        f"{i + 1} dashtype {1 if kind == 'real' else 2} title '{place[0].split('.')[0]}, {'real' if kind == 'real' else 'simulated'}'"
        for i, place in enumerate(places) for kind in ("real", "footprint")) for what in ("relief", "noise")}
    subprocess.run(["gnuplot"], check=True, text=True, input=f"""
set terminal pngcairo noenhanced rounded size 1280,560 fontscale 1.2 linewidth 2 font 'sans-serif,10'
set output '{PICTURE}'
set multiplot layout 1,2
set border 3
set tics nomirror
set grid linetype 1 linewidth 0.8 linecolor rgb '#dddddd'
set logscale x
set key top left reverse Left samplen 2 font ',8'
set title 'Relief of the bed between the rails'
set xlabel 'Distance of two points, mm'
set ylabel 'mm'
set xtics (15, 25, 50, 100, 200)
set yrange [0:30]
plot {plots['relief']}
set title 'Second differences of range, an upper bound of noise'
set xlabel 'Range, m'
set xtics (4, 6, 10, 16, 28)
set logscale y
set yrange [1:300]
plot {plots['noise']}
""")


def main(arguments):
    if len(arguments) != 2:
        raise SystemExit(__doc__)
    data, build = (pathlib.Path(each).resolve() for each in arguments)
    turns, places = {}, []
    with tempfile.TemporaryDirectory() as name_of_folder:
        folder = pathlib.Path(name_of_folder)
        for name in (each for each in NAMES if (data / each).exists()):
            turn = railway_cloud.find_turn(name, railway_cloud.read_text(data / name))
            if turn is None:
                print(f"{name}: left out, because its origin is not at the sensor")
                continue
            turns[name] = turn
            track = railway_track.find_track(turn)
            if track is None:
                print(f"{name}: no track was found")
                continue
            simulated = {rung: railway_simulate.simulate(build, folder / name, turn, track, rung) for rung in RUNGS}
            places.append((name, turn, track, simulated))
        draw(places, folder)
    page = PAGE.read_text(encoding="utf-8")
    for mark, text in (("track", place_table(places)), ("bed", bed_table(places)), ("relief", relief_table(places)),
                       ("grazing", grazing_table(places)), ("noise", noise_table(turns, places))):
        page, count = re.subn(rf"(<!-- railway: {mark} -->\n).*?(?=<!-- end -->)",
                              lambda match, text=text: match[1] + text + "\n", page, flags=re.DOTALL)
        if count != 1:
            raise SystemExit(f"{PAGE}: must have the marks of {mark}")
    PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
