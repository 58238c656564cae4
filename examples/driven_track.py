"""Makes the track that a recording's sensor was driven along, as a scenario for `railcast-analyze stats --track`:

    examples/driven_track.py RECORDING SENSOR_HEIGHT_M > driven.json

The sensor is taken to be above the axis of the track, at this height over top of rail. The track runs through its
poses, at least 10 m apart, and ends with them. Needs the module: PYTHONPATH=build/release/python
"""

import json
import pathlib
import sys

import numpy as np

import railcast

MINIMAL = pathlib.Path(__file__).resolve().parents[1] / "scenarios" / "minimal.json"
SPACING_M = 10.0

recording, height_m = railcast.open(sys.argv[1]), float(sys.argv[2])
axis_m = []
for frame in recording:
    pose = np.asarray(frame.world_from_sensor)
    place_m = pose[:3, 3] - height_m * pose[:3, 2]
    if not axis_m or np.hypot(*(place_m - axis_m[-1])[:2]) >= SPACING_M:
        axis_m.append(place_m)
if len(axis_m) < 3:
    sys.exit(f"{sys.argv[1]}: the sensor must have moved by {2 * SPACING_M:g} m or more")
axis_m = np.array(axis_m)
rises_m, runs_m = np.diff(axis_m[:, 2]), np.hypot(*np.diff(axis_m[:, :2], axis=0).T)
chainages_m = np.concatenate([[0.0], np.cumsum(runs_m)[:-1]])
json.dump({
    "version": 1,
    "file": str(MINIMAL),  # All but vehicle and track is taken from it.
    "vehicle": {"start_s_m": 0},
    "world": {"alignment": {"course": {"type": "spline", "points_m": axis_m[:, :2].round(4).tolist()},
                            "origin_m": [0, 0, round(float(axis_m[0, 2]), 4)],
                            "gradients_permil": [{"s_m": round(s_m, 3), "value": round(1000 * rise_m / run_m, 3)}
                                                 for s_m, rise_m, run_m in zip(chainages_m, rises_m, runs_m)]}},
}, sys.stdout, indent=1)
