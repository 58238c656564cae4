"""Shows what a simulator knows of a frame besides its points, and changes weather, objects and speed.

Run in railcast's folder: PYTHONPATH=build/release/python python3 examples/drive_simulator.py
"""

import numpy as np
import railcast

sim = railcast.Simulator("scenarios/st_gallen_approach.json")
frame = sim.scan(30, objects=True)
rail = frame["label"] == sim.labels["rail"]
lost = frame["outcome"] == railcast.OUTCOMES["below_threshold"]
print((rail & lost).sum(), np.nanmedian(frame["range_m"][rail]))
for thing in frame.objects:
    print(thing.name, thing.points, thing.occlusion, thing.sensor_from_box[:3, 3], thing.size_m)

for stretch in sim.rails(30, ahead_m=100):
    print(stretch.track, stretch.is_ego, stretch.left.shape)

in_clear_air = sim.scan(60)
sim.apply({"command": "set_weather", "weather": {"visibility_m": 80}}, frame=40)
sim.apply({"command": "place_object", "object": {"name": "bob", "type": "person", "s_m": 2240}}, frame=40)
sim.apply({"command": "brake"}, frame=50)
in_fog = sim.scan(60)
print(in_clear_air.num_points, in_fog.num_points)
