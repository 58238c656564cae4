#!/usr/bin/env python3
"""Writes the firing table of scenarios/sensors/aeries2.json, an FMCW sensor like Aeva's Aeries II.

usage: make_aeries_table.py scenarios/sensors/aeries2.csv

Four beams sweep one line each across the view at a time, in 16 sweeps a frame. Elevations and the
points of a sweep are those of Aeva's own simulation (ScanPatterns.yaml of its plug-in for CARLA,
"64-19.2-Uniform"); a sweep there covers 144 degrees, of which the sensor sees 120. The time from
point to point is that of a real sensor. scenarios/sensors/README.md names the sources.
"""

import pathlib
import sys

BEAMS_DEG = (0.5729578, -1.718873, 1.718873, -0.5729578)
STEPS_DEG = (-7.8, -7.5, -7.2, -6.9, -3.0, -2.7, -2.4, -2.1, 1.8, 2.1, 2.4, 2.7, 6.6, 6.9, 7.2, 7.5)
POINT_DEG = 144.0 / 3051
POINT_US = 2.048
VIEW_DEG = 120.0
FRAME_US = 100_000.0


def text(number, digits):
    return f"{number:.{digits}f}".rstrip("0").rstrip(".")


def main():
    elevations_deg = sorted(beam + step for beam in BEAMS_DEG for step in STEPS_DEG)
    to_side = int(VIEW_DEG / 2 / POINT_DEG)  # Points on either side of the middle one.
    lines = ["azimuth_deg,elevation_deg,time_us,ring"]
    for sweep, step_deg in enumerate(STEPS_DEG):
        for point in range(2 * to_side + 1):
            azimuth = text((to_side - point) * POINT_DEG, 3)
            time = text(sweep * FRAME_US / len(STEPS_DEG) + point * POINT_US, 3)
            for beam_deg in sorted(BEAMS_DEG):
                elevation_deg = beam_deg + step_deg
                ring = elevations_deg.index(elevation_deg)
                lines.append(f"{azimuth},{text(elevation_deg, 3)},{time},{ring}")
    pathlib.Path(sys.argv[1]).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
