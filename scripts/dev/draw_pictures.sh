#!/usr/bin/env bash
# Draws the pictures of README and docs into docs/images, except for the charts of draw_frontiers.sh and
# draw_insertion.sh, the pictures of reproduce_paper.sh, those of the tutorials, which make their own, and the hand-made
# data_flow.svg; on one machine the files are reproducible byte by byte. Needs a release build, Xvfb,
# graphviz and, for the picture of a report, chromium; takes some minutes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

generate=$PWD/build/release/generator/railcast-generate
analyze=$PWD/build/release/analysis/railcast-analyze
view=$PWD/build/release/viewer/railcast-view
images=$PWD/docs/images
runs=$(mktemp -d)
trap 'rm -rf "$runs"' EXIT

# simulate NAME SCENARIO FRAMES
simulate() {
  "$generate" sequence "$2" --out "$runs/$1" --frames "$3" > "$runs/$1.txt" 2>&1
}
simulate demo scenarios/st_gallen_approach.json 50
simulate snow scenarios/snow.json 21
simulate wet scenarios/wet_yard.json 1
# The demo scenario in thin fog.
printf '{"version": 1, "file": "%s", "weather": {"fog_density_per_m": 0.02}}' \
  "$PWD/scenarios/st_gallen_approach.json" > "$runs/fog.json"
simulate fog "$runs/fog.json" 33

dot -T svg "$images/architecture.dot" -o "$images/architecture.svg"

# draw NAME OPTION...: runs in the folder of the runs, so that no picture shows a temporary path.
draw() {
  local name=$1
  shift
  (cd "$runs" && xvfb-run --auto-servernum --server-args="-noreset -screen 0 1920x1080x24" \
    "$view" --screenshot "$images/$name.png" "$@" > "$name.txt")
}
draw view_label demo --frame 20 --camera driver
draw view_overlays demo --frame 36 --camera driver --color-by range \
  --show surfaces,boxes,track,gauge
draw view_compare demo --compare fog --frame 32 --show boxes,empty-beams --color-by power \
  --color-range 1,20
"$generate" insert "$runs/demo" scenarios/insert/obstacles.json --out "$runs/inserted" > "$runs/inserted.txt"
draw insert demo --compare inserted/recording --frame 18 --eye 2,0,1 --target 30,0.5,-1.5 \
  --size 1280x460 --point-size 3
draw view_changes demo --compare inserted/recording --frame 18 --layout changes \
  --eye 9,0,0.6 --target 30,0.5,-1.5 --size 960x540 --point-size 3
draw view_noise demo --frame 40 --camera top --accumulate 32 --color-by noise
draw view_trace demo --frame 20 --camera driver --select person,wagon \
  --pick 618,342 --pick 770,410 --trace
draw intensity demo --frame 20 --camera driver --color-by intensity
draw snow snow --frame 20 --camera driver
simulate throat scenarios/osm_sankt_poelten/station_throat.json 61
draw sankt_poelten throat --frame 60 --eye -15,0,12 --target 60,0,-3 --show surfaces
/usr/bin/python3 - "$images/sankt_poelten" << 'PYTHON'
import sys
import open3d as o3d

o3d.io.write_image(f"{sys.argv[1]}.jpg", o3d.io.read_image(f"{sys.argv[1]}.png"), quality=80)
PYTHON
rm "$images/sankt_poelten.png"
draw mirror_image wet --frame 0 --eye 6,-4,5 --target 28,8,-2
draw plan "$PWD/scenarios/yard.json" --size 1280x400

# A turnout, seen by a fine sensor above it.
printf '{"version": 1, "file": "%s", "fidelity": "surface",
  "world": {"alignment": {"course": {"type": "elements", "elements": [{"type": "straight", "length_m": 600}]}},
    "tracks": [{"name": "main"}, {"name": "siding", "offset_m": 4.5, "end_s_m": 200,
      "begin": {"track": "main", "s_m": 62, "turnout": "1:9-190"}}],
    "vegetation": {"trees_per_hectare": 0, "grass": false}},
  "vehicle": {"start_s_m": 64},
  "lidar": {"file": "%s", "mount": {"position_m": [0, 0.5, 7], "pitch_deg": 24},
    "scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 44,
      "vertical_fov_deg": 30, "angular_resolution_deg": 0.04}}}}' \
  "$PWD/scenarios/minimal.json" "$PWD/scenarios/sensors/vir2rail.json" > "$runs/turnout.json"
simulate turnout "$runs/turnout.json" 1
draw turnout turnout --eye 11,-1.5,3.2 --target 22.5,0.3,1.6 --point-size 4 --color-by label

# A diamond crossing, likewise.
printf '{"version": 1, "file": "%s", "fidelity": "surface",
  "world": {"alignment": {"course": {"type": "elements", "elements": [{"type": "straight", "length_m": 600}]}},
    "tracks": [{"name": "main"}, {"name": "across", "offset_m": 9, "heading_deg": -6.34019, "sleeper": "wood",
      "elements": [{"type": "straight", "length_m": 300}]}],
    "diamond_crossings": [{"tracks": ["main", "across"], "s_m": 81}],
    "catenary": {"enabled": false}, "vegetation": {"trees_per_hectare": 0, "grass": false}},
  "vehicle": {"start_s_m": 54},
  "lidar": {"file": "%s", "mount": {"position_m": [0, 0.5, 7], "pitch_deg": 22},
    "scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 44,
      "vertical_fov_deg": 30, "angular_resolution_deg": 0.04}}}}' \
  "$PWD/scenarios/minimal.json" "$PWD/scenarios/sensors/vir2rail.json" > "$runs/diamond.json"
simulate diamond "$runs/diamond.json" 1
draw diamond diamond --eye 4,0.6,4.6 --target 18,0.3,0.5 --point-size 3 --color-by label

# The yard, with a finer scan than its own.
printf '{"version": 1, "file": "%s",
  "lidar": {"file": "%s", "mount": {"position_m": [2, 0, 4], "pitch_deg": 8},
    "scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 60,
      "vertical_fov_deg": 30, "angular_resolution_deg": 0.06}}}}' \
  "$PWD/scenarios/yard.json" "$PWD/scenarios/sensors/vir2rail.json" > "$runs/yard.json"
simulate yard "$runs/yard.json" 1
draw yard yard --camera driver --color-by label --point-size 2

# The camera's images of frame 20, in sun and in fog, at half their size side by side.
for weather in '"sun": {"illuminance_klx": 100, "azimuth_deg": 200}' '"visibility_m": 150'; do
  name=camera_$([[ $weather == *sun* ]] && echo sun || echo fog)
  printf '{"version": 1, "file": "%s", "weather": {%s}, "camera": {"width_px": 1280,
    "height_px": 800, "horizontal_fov_deg": 60, "mount": {"position_m": [2.2, 0, 2.6], "pitch_deg": 2}}}' \
    "$PWD/scenarios/st_gallen_approach.json" "$weather" > "$runs/$name.json"
  "$generate" sequence "$runs/$name.json" --out "$runs/$name" --start-frame 20 --frames 1 > "$runs/$name.txt"
done
draw view_camera camera_sun --frame 20 --camera driver
/usr/bin/python3 - "$runs" "$images/camera.jpg" << 'PYTHON'
import sys
import numpy as np
import open3d as o3d

runs, picture = sys.argv[1:]
images = [np.asarray(o3d.io.read_image(f"{runs}/camera_{name}/camera/camera/color/000020.png"))
          for name in ("sun", "fog")]
halves = [image.reshape(400, 2, 640, 2, 3).mean(axis=(1, 3)) for image in images]
both = np.concatenate(halves, axis=1).round().astype(np.uint8)
o3d.io.write_image(picture, o3d.geometry.Image(np.ascontiguousarray(both)), quality=85)
PYTHON

scripts/dev/draw_rail_vehicles.py "$generate" "$images/rail_vehicles.jpg"

# Workers in every posture 6 m away and others behind them.
/usr/bin/python3 - "$PWD/scenarios" > "$runs/persons.json" << 'PYTHON'
import json
import sys

folder = sys.argv[1]


def person(name, ahead_m, left_m, heading_deg, **looks):
    return {"name": name, "type": "person", "person": looks, "s_m": 400 + ahead_m, "d_m": left_m,
            "heading_deg": heading_deg}


def worker(posture, left_m, heading_deg):
    return person(posture, 6, left_m, heading_deg, posture=posture, clothing="hi_vis")


objects = [worker("standing", 2.6, 170), worker("walking", 1.3, 190), worker("crouching", 0, 160),
           worker("sitting", -1.1, 145), worker("lying", -2.6, 100),
           person("traveller", 10, 2.6, 250, posture="walking", luggage="suitcase"),
           person("child", 10, 1.5, 180, physique="child", posture="standing"),
           person("mother", 10, 0, 270, physique="woman", posture="walking", luggage="pram"),
           person("boy", 10, -1.8, 200, physique="child", posture="walking"),
           person("cyclist", 10, -3.6, 100, posture="walking", luggage="bicycle")]
json.dump({"version": 1, "file": f"{folder}/minimal.json", "fidelity": "surface",
           "lidar": {"file": f"{folder}/sensors/vir2rail.json",
                     "mount": {"position_m": [0, 0, 2.2], "pitch_deg": 8},
                     "scan": {"rate_hz": 10, "pattern": {
                         "type": "raster", "horizontal_fov_deg": 64, "vertical_fov_deg": 32,
                         "angular_resolution_deg": 0.05}}},
           "world": {"alignment": {"course": {"type": "elements", "elements": [
                         {"type": "straight", "length_m": 1000}]}},
                     "structures": [{"type": "level_crossing", "name": "floor", "s_m": 408,
                                     "road_width_m": 12}],
                     "catenary": {"enabled": False},
                     "vegetation": {"trees_per_hectare": 0, "grass": False}, "objects": objects}},
          sys.stdout)
PYTHON
simulate persons "$runs/persons.json" 1
draw persons persons --eye 0,0,0 --target 10,0,-1.6 --color-by intensity --color-range 0,1 --size 1400x640

# The level crossing, as a camera high above the left track sees it.
printf '{"version": 1, "file": "%s", "vehicle": {"start_s_m": 240, "ego_boxes_m": []},
  "weather": {"sun": {"illuminance_klx": 100, "azimuth_deg": 200}},
  "camera": {"width_px": 1280, "height_px": 720, "horizontal_fov_deg": 70,
    "mount": {"position_m": [0, 8, 9], "yaw_deg": -20, "pitch_deg": 18}}}' \
  "$PWD/scenarios/level_crossing.json" > "$runs/crossing.json"
simulate crossing "$runs/crossing.json" 1
/usr/bin/python3 - "$runs/crossing/camera/camera/color/000000.png" "$images/level_crossing.jpg" << 'PYTHON'
import sys
import open3d as o3d

o3d.io.write_image(sys.argv[2], o3d.io.read_image(sys.argv[1]), quality=85)
PYTHON

# What detect shows of the person whom a train approaches.
simulate brake scenarios/brake_person.json 285
(cd "$runs" && "$analyze" detect brake --out detect > detect.txt)
cp "$runs/detect/charts/seen_person.png" "$images/first_sight.png"

# The report states its date: use that of the commit, so that the picture is reproducible.
(cd "$runs" && SOURCE_DATE_EPOCH=$(git -C "$images" log -1 --format=%ct) "$analyze" stats demo --out stats > stats.txt)
chromium --headless --no-sandbox --disable-gpu --no-first-run --user-data-dir="$runs/profile" \
  --hide-scrollbars --window-size=1300,1010 --screenshot="$images/report_demo.png" \
  "file://$runs/stats/report.html" > "$runs/chromium.txt" 2>&1
ls -l "$images"/*.png
