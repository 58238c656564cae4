"""Reads a recording, of railcast or of others: `out/demo`, which scripts/demo.sh makes.

Needs the module: PYTHONPATH=build/release/python
"""

import railcast

recording = railcast.open("out/demo")
for frame in recording:               # One after another; also captures, whose length is not known.
    print(frame.index, frame.num_points, [thing.name for thing in frame.objects])
frame = recording[0]                  # By place, where the length is known.
print(recording.labels["rail"], recording.scenario["lidar"]["name"])
