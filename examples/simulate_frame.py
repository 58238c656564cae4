"""Simulates a frame in memory and counts its points by label.

Run in railcast's folder: PYTHONPATH=build/release/python python3 examples/simulate_frame.py
"""

import railcast
frame = railcast.Simulator("scenarios/st_gallen_approach.json").scan(30)
xyz, label = frame.points(), frame["label"][frame.has_point]

for number in sorted(set(label)):
    print(number, (label == number).sum(), xyz[label == number].mean(axis=0))
