"""Draws docs/images/railway.png and docs/images/railway_obstacle.png with gnuplot. A part of railway_frames.py."""

import pathlib
import subprocess

import numpy as np

import railway_bed
import railway_firings
import railway_obstacle

IMAGES = pathlib.Path(__file__).resolve().parents[2] / "docs" / "images"
MOST_PLACES = 5


def blocks(rows):
    return "\n\n\n".join("\n".join(block) for block in rows) + "\n"


def draw_curves(places, folder):
    """Relief and noise, real and simulated, of the first frames that have a track of their own."""
    places = [place for place in places if place.track_of == place.name and "footprint" in place.simulated][:MOST_PLACES]
    if not places:
        return
    for kind in ("real", "footprint"):
        lines, noises = [], []
        for place in places:
            cloud = place.turn if kind == "real" else place.simulated[kind]
            lags, _ = railway_bed.relief(railway_bed.bed_points(cloud, place.track))
            lines.append([f"{1e3 * np.sqrt(a * b):.1f} {1e3 * value[0]:.2f}" for a, b, value in
                          zip(railway_bed.LAGS_M, railway_bed.LAGS_M[1:], lags)])
            noises.append([f"{np.sqrt(a * b):.2f} {1e3 * each[0]:.2f}" for a, b, each in
                           zip(railway_firings.RANGES_M, railway_firings.RANGES_M[1:], railway_firings.noise(cloud)) if each])
        (folder / f"{kind}_relief.dat").write_text(blocks(lines))
        (folder / f"{kind}_noise.dat").write_text(blocks(noises))
    plots = {what: ", ".join(
        f"'{folder}/{kind}_{what}.dat' index {i} using 1:2 with linespoints pointtype {7 if kind == 'real' else 6} linecolor "
        f"{i + 1} dashtype {1 if kind == 'real' else 2} title '{place.name.split('.')[0]}, {'real' if kind == 'real' else 'simulated'}'"
        for i, place in enumerate(places) for kind in ("real", "footprint")) for what in ("relief", "noise")}
    subprocess.run(["gnuplot"], check=True, text=True, input=f"""
set terminal pngcairo noenhanced rounded size 1280,560 fontscale 1.2 linewidth 2 font 'sans-serif,10'
set output '{IMAGES / "railway.png"}'
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
set xrange [14:260]
set yrange [0:32]
plot {plots['relief']}
set title 'Second differences of range, an upper bound of noise'
set xlabel 'Range, m'
set xtics (4, 6, 10, 16, 28)
set xrange [3:40]
set logscale y
set yrange [1:1000]
plot {plots['noise']}
""")


def draw_obstacle(turn, obstacle, views, folder):
    """The obstacle from the sensor and from above: real, and each of the simulated ones, views being (title, ranges)."""
    middle = sum(obstacle.track.heads_m) / 2
    ring, column = np.nonzero(obstacle.firings)
    rows, columns = ((ring.min() - 4, ring.max() + 6), (column.min() - 40, column.max() + 40))
    inside = np.zeros_like(obstacle.firings)
    inside[max(0, rows[0]): rows[1], max(0, columns[0]): columns[1]] = True
    azimuth = np.degrees(np.arctan2(turn.directions()[..., 1], turn.directions()[..., 0]))
    elevation = np.broadcast_to(np.degrees(turn.elevation_rad)[:, None], azimuth.shape)
    for k, (_, range_m) in enumerate(views):
        points = railway_obstacle.positions(turn, obstacle.track, range_m) - [0, middle, 0]
        some = inside & np.isfinite(range_m)
        np.savetxt(folder / f"view_{k}.dat", np.column_stack([azimuth[some], elevation[some], points[some]]), fmt="%.4f")
    x, y = obstacle.centre_m
    half = max(obstacle.size_m[:2]) / 2 + 0.7
    rails = "; ".join(f"set arrow {i + 1} from {x - half},{head - middle} to {x + half},{head - middle} nohead linecolor rgb '#888888'"
                      for i, head in enumerate(obstacle.track.heads_m))
    data = np.loadtxt(folder / "view_0.dat", ndmin=2)
    sensor_view = "".join(f"set title '{title}'\nplot '{folder}/view_{k}.dat' using 1:2:5 with points pointtype 7 pointsize 0.45 "
                          "palette notitle\n" for k, (title, _) in enumerate(views))
    from_above = "".join(f"set title '{title}'\nplot '{folder}/view_{k}.dat' using 3:4:5 with points pointtype 7 pointsize 0.35 "
                         "palette notitle\n" for k, (title, _) in enumerate(views))
    subprocess.run(["gnuplot"], check=True, text=True, input=f"""
set terminal pngcairo noenhanced rounded size 1280,860 fontscale 1.1 linewidth 1.5 font 'sans-serif,10'
set output '{IMAGES / "railway_obstacle.png"}'
set multiplot layout 2,{len(views)}
set tics nomirror
set border 3
set palette defined (0 '#30306c', 0.4 '#2f9e8f', 0.75 '#f2c84b', 1 '#d1402f')
set cbrange [-0.3:0.35]
set cblabel 'Above the heads, m'
set xlabel 'Azimuth, degrees'
set ylabel 'Elevation, degrees'
set xrange [{data[:, 0].min()}:{data[:, 0].max()}]
set yrange [{data[:, 1].min() - 0.3}:{data[:, 1].max() + 0.3}]
{sensor_view}
set xlabel 'Along the track, m'
set ylabel 'From the axis, m'
set xrange [{x - half}:{x + half}]
set yrange [{y - half}:{y + half}]
set size ratio -1
{rails}
{from_above}
""")
