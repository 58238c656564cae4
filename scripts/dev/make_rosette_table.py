#!/usr/bin/env python3
"""Writes the firing table of scenarios/sensors/rosette.json, a scan without rows.

usage: make_rosette_table.py scenarios/sensors/rosette.csv

Two equal wedge prisms turn against each other, and each deflects the beam by DEFLECTION_DEG in the
direction that it points to. In the approximation for thin prisms the deflections add up, so that
the beam draws a rosette through the axis. Brazeal et al. 2021 (doi 10.3390/s21144722) derive the
exact model for such a sensor. scenarios/sensors/README.md names the source of each figure.
"""

import math
import pathlib
import sys

DEFLECTION_DEG = 9.6
# Turns per second. 10 turns of one are no multiple of those of the other, so that the curve does
# not close within a frame of 0.1 s.
TURNS_HZ = (121.3, -77.9)
NUM_FIRINGS = 10_000
STEP_US = 10


def main():
    lines = ["azimuth_deg,elevation_deg,time_us"]
    for i in range(NUM_FIRINGS):
        phases = [2.0 * math.pi * turns_hz * 1e-6 * STEP_US * i for turns_hz in TURNS_HZ]
        azimuth_deg = DEFLECTION_DEG * sum(math.cos(phase) for phase in phases)
        elevation_deg = DEFLECTION_DEG * sum(math.sin(phase) for phase in phases)
        lines.append(f"{azimuth_deg:.3f},{elevation_deg:.3f},{STEP_US * i}")
    pathlib.Path(sys.argv[1]).write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
