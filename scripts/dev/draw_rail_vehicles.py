#!/usr/bin/python3
"""Draws every type of rail vehicle as a sensor of 0.05 degrees sees it from 10 m.

    scripts/dev/draw_rail_vehicles.py GENERATE PICTURE

GENERATE is railcast-generate. Each vehicle stands 10 m beside the sensor, which looks across the
tracks at it on the rung `geometry`. A point is a dot of its material's colour, darker at a slant.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import open3d as o3d

ROOT = Path(__file__).resolve().parents[2]
TYPES = [["electric_locomotive", "multiple_unit"], ["coach", "metro_car", "shunting_locomotive"],
         ["open_wagon", "flat_wagon", "tank_wagon"], ["container_wagon", "covered_wagon", "hopper_wagon"]]
COLORS = {"red_paint": (190, 40, 40), "white_paint": (235, 235, 230), "grey_paint": (150, 155, 160),
          "black_paint": (50, 50, 55), "glass": (110, 190, 205), "galvanised_steel": (150, 160, 170),
          "ceramic": (150, 90, 60), "wagon_paint": (150, 75, 50), "tank_paint": (225, 225, 220),
          "rusty_steel": (130, 85, 60), "wheel_steel": (95, 95, 105), "rail_head": (190, 190, 195), "rail_side": (120, 80, 55),
          "ballast": (105, 100, 95), "concrete": (165, 165, 160), "soil": (105, 90, 70)}
OTHER = (200, 0, 200)
PIXELS_PER_METRE = 24
HEIGHT_M = (-0.8, 5.8)


def scan(generate, folder, name):
    """The points of one vehicle in the vehicle's frame: positions, materials, angles of incidence."""
    scenario = {
        "version": 1,
        "file": str(ROOT / "scenarios" / "minimal.json"),
        "fidelity": "geometry",
        "lidar": {"file": str(ROOT / "scenarios" / "sensors" / "vir2rail.json"),
                  "mount": {"position_m": [0, 0, 2.6], "yaw_deg": 62},
                  "scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 116,
                                                      "vertical_fov_deg": 42,
                                                      "angular_resolution_deg": 0.05}}},
        "world": {"alignment": {"course": {"type": "elements", "elements": [{"type": "straight",
                                                                            "length_m": 1000}]}},
                  "tracks": [{"name": "main"}, {"name": "second", "offset_m": 10.0}],
                  "catenary": {"enabled": False},
                  "vegetation": {"trees_per_hectare": 0, "grass": False},
                  "objects": [{"name": name, "type": name, "track": "second", "s_m": 408}]}}
    file = folder / f"{name}.json"
    file.write_text(json.dumps(scenario))
    out = folder / name
    subprocess.run([generate, "sequence", file, "--out", out, "--frames", "1"], check=True,
                   stdout=subprocess.DEVNULL)
    cloud = o3d.t.io.read_point_cloud(str(out / "frames" / "000000.pcd"))
    table = json.loads((out / "materials.json").read_text())
    names = {entry["id"]: entry["name"] for entry in table["materials"]}
    points = cloud.point.positions.numpy().astype(float)
    seen = np.isfinite(points).all(axis=1)
    material = cloud.point["material"].numpy().ravel()[seen]
    incidence = cloud.point["incidence_rad"].numpy().ravel()[seen]
    return points[seen], [names.get(int(m), "") for m in material], incidence


def picture(points, materials, incidence):
    """An image of the points as the sensor's place shows them, on a plane 10 m away."""
    yaw = np.radians(62)
    turn = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    points = points @ turn.T
    near = points[:, 1] > 5.0
    points, incidence = points[near], incidence[near]
    materials = [m for m, keep in zip(materials, near) if keep]
    scale = 8.6 / points[:, 1]
    along = points[:, 0] * scale
    up = points[:, 2] * scale + 2.6
    color = np.array([COLORS.get(m, OTHER) for m in materials]) * (0.35 + 0.65 * np.cos(incidence))[:, None]
    left, right = -5.6, 22.4
    width = round((right - left) * PIXELS_PER_METRE)
    height = round((HEIGHT_M[1] - HEIGHT_M[0]) * PIXELS_PER_METRE)
    image = np.full((height, width, 3), 255.0)
    order = np.argsort(-points[:, 1])
    u = ((along - left) * PIXELS_PER_METRE)[order]
    v = ((HEIGHT_M[1] - up) * PIXELS_PER_METRE)[order]
    for du in (0, 1):
        for dv in (0, 1):
            x, y = (u + 0.5 * du).astype(int), (v + 0.5 * dv).astype(int)
            inside = (x >= 0) & (x < width) & (y >= 0) & (y < height)
            image[y[inside], x[inside]] = color[order][inside]
    return image


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for types in TYPES:
            row = [picture(*scan(sys.argv[1], Path(folder), name)) for name in types]
            while len(row) < 3:
                row.append(np.full_like(row[0], 255.0))
            rows.append(np.concatenate(row, axis=1))
    image = np.concatenate(rows, axis=0).round().clip(0, 255).astype(np.uint8)
    o3d.io.write_image(sys.argv[2], o3d.geometry.Image(np.ascontiguousarray(image)), quality=85)


if __name__ == "__main__":
    main()
