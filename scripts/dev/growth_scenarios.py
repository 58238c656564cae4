"""The scenarios of scripts/dev/growth.py: the demo, with one thing of it varied."""

import copy
import json
import math
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = ROOT / "scenarios"
MOST_TREES_PER_HECTARE = 5000


def demo():
    """scenarios/st_gallen_approach.json, its files by absolute names so that it can lie anywhere."""
    scenario = json.loads((SCENARIOS / "st_gallen_approach.json").read_text())
    del scenario["$schema"]
    scenario["lidar"]["file"] = str(SCENARIOS / scenario["lidar"]["file"])
    scenario["world"]["alignment"] = str(SCENARIOS / scenario["world"]["alignment"])
    for key in ("weather", "materials", "labels"):
        scenario[key] = str(SCENARIOS / scenario[key])
    return scenario


def beams(count):
    """A raster over 60 x 30 degrees of about so many beams."""
    scenario = demo()
    step_deg = 30.0 / round(math.sqrt(count / 2.0))
    scenario["lidar"]["scan"] = {
        "rate_hz": 10,
        "pattern": {"type": "raster", "horizontal_fov_deg": 60, "vertical_fov_deg": 30,
                    "angular_resolution_deg": step_deg},
    }
    return scenario


def trees(per_hectare):
    """A wide strip with so many trees; without any (0), also a lean strip (None)."""
    scenario = demo()
    world = scenario["world"]
    world["objects"] = []
    world["vegetation"] = {"trees_per_hectare": per_hectare or 0, "grass": False}
    world["terrain"] = {"half_width_m": 120}
    if per_hectare is None:
        world["terrain"] = {"half_width_m": 6}
        world["catenary"] = {"enabled": False}
        world["tracks"] = [{"name": "main", "start_s_m": 2170, "end_s_m": 2195}]
    return scenario


def persons(count, moving):
    """So many persons ahead, up to 200 m away, in place of the demo's objects."""
    across, behind_m = (20, 3.9) if count <= 1000 else (40, 0.8)
    scenario = demo()
    scenario["world"]["objects"] = [
        {"name": f"person_{i}", "type": "person", "s_m": 2200 + behind_m * (i // across),
         "d_m": 40.0 / across * (i % across + 0.5) - 20.0,
         **({"motion": {"profile": [{"time_s": 0, "speed_mps": 1}]}} if moving else {})}
        for i in range(count)
    ]
    return scenario


def sensors(count):
    """So many of the demo's sensors side by side on the roof."""
    scenario = demo()
    lidar = scenario.pop("lidar")
    scenario["lidars"] = []
    for i in range(count):
        one = copy.deepcopy(lidar)
        one["name"] = f"sensor_{i}"
        one["mount"]["position_m"][1] = 0.2 * (i - 0.5 * (count - 1))
        scenario["lidars"].append(one)
    return scenario


def line(length_km):
    """The demo's sensor in alternating curves, one left and one right a kilometre."""
    curves = []
    for radius_m in (600, -600):
        curves += [
            {"type": "straight", "length_m": 200},
            {"type": "clothoid", "length_m": 80},
            {"type": "arc", "length_m": 140, "radius_m": radius_m},
            {"type": "clothoid", "length_m": 80},
        ]
    scenario = demo()
    scenario["world"] = {"alignment": {"course": {"type": "elements",
                                                  "elements": curves * length_km}}}
    scenario["vehicle"] = {"start_s_m": 500}
    return scenario
