#!/usr/bin/env python3
"""Writes scenarios/sensors/*.json from published calibration files.

usage: make_sensor_tables.py DATA_DIR OUT_DIR

DATA_DIR holds velodyne_calibration/ (of ros-drivers/velodyne), lidar_packets_nebula/calibration/ (of
tier4/nebula) and lidar_hesai/calibration/ (of tier4/nebula and HesaiLidar_SDK_2.0).
scenarios/sensors/README.md names the source of every other figure.
"""

import csv
import json
import math
import pathlib
import re
import sys

# Pandar64: microseconds from the firing of channels 1 to 64 to the end of their block (Hesai,
# Pandar64 user manual, appendix "Absolute time of point cloud data").
PANDAR64_BEFORE_END_US = [
    23.180, 21.876, 20.572, 19.268, 17.964, 16.660, 11.444, 46.796, 7.532, 36.956, 50.732,
    54.668, 40.892, 44.828, 31.052, 34.988, 48.764, 52.700, 38.924, 42.860, 29.084, 33.020,
    46.796, 25.148, 36.956, 50.732, 27.116, 40.892, 44.828, 31.052, 34.988, 48.764, 25.148,
    38.924, 42.860, 29.084, 33.020, 52.700, 6.228, 54.668, 15.356, 27.116, 10.140, 23.180,
    4.924, 21.876, 14.052, 17.964, 8.836, 19.268, 3.620, 20.572, 12.748, 16.660, 7.532,
    11.444, 6.228, 15.356, 10.140, 4.924, 3.620, 14.052, 8.836, 12.748,
]

# QT128: the first firing of a loop, and from one loop to the next: 900 loops in 0.1 s.
QT128_EARLIEST_US = 0.6
QT128_LOOP_US = 111.111


def velodyne_lasers(path):
    """(elevation, azimuth) in degrees of each laser, in laser order.

    The true azimuth is the block's minus rot_correction. Laser numbers and angles are found by
    pattern, which spares a YAML library.
    """
    lasers = {}
    for entry in re.findall(r"\{(.*?)\}", path.read_text(), re.DOTALL):
        fields = {name: float(value) for name, value in re.findall(r"(\w+):\s*([-+.\deE]+)", entry)}
        # Adding 0.0 turns -0.0 into 0.0.
        elevation_deg = round(math.degrees(fields["vert_correction"]), 3) + 0.0
        azimuth_deg = round(-math.degrees(fields["rot_correction"]), 3) + 0.0
        lasers[int(fields["laser_id"])] = (elevation_deg, azimuth_deg)
    return [lasers[i] for i in range(len(lasers))]


def hesai_lasers(path):
    rows = csv.DictReader(path.open())
    return [(float(row["Elevation"]), float(row["Azimuth"])) for row in rows]


def qt128_firings(angles_path, times_path):
    """(elevation, azimuth) in degrees and the time in us of each firing of a cycle of two loops:
    those of loop 1, then those of loop 2, by rising laser.
    """
    angles = hesai_lasers(angles_path)
    # Three lines of header, then laser and time in loop 1, laser and time in loop 2; 0 = none.
    rows = list(csv.reader(times_path.open(encoding="utf-8-sig")))[3:]
    lasers, times_us = [], []
    for loop in range(2):
        fired = sorted((int(row[2 * loop]), float(row[2 * loop + 1])) for row in rows if row)
        for laser, time_us in fired:
            if laser == 0:
                continue
            lasers.append(angles[laser - 1])
            times_us.append(time_us - QT128_EARLIEST_US + loop * QT128_LOOP_US)
    return lasers, times_us


def hdl64e_lasers(path):
    """(elevation, azimuth) in degrees of each laser, in laser order.

    The file has a laser's figures in alphabetical order: laser_id, rot_correction, vert_correction.
    """
    lasers = {}
    for entry in path.read_text().split("\n- ")[1:]:
        fields = {name: float(value)
                  for name, value in re.findall(r"(\w+): ([-+.\deE]+)\n", entry + "\n")}
        lasers[int(fields["laser_id"])] = (round(math.degrees(fields["vert_correction"]), 3),
                                           round(-math.degrees(fields["rot_correction"]), 3))
    return [lasers[i] for i in range(len(lasers))]


def write_sensor(path, name, lasers, times_us, cycle_us, columns, detection, rate_hz=10):
    section = {
        "version": 1,
        "name": name,
        "scan": {
            "rate_hz": rate_hz,
            "pattern": {
                "type": "spinning",
                "cycle_us": cycle_us,
                "columns": columns,
                "rotation": "clockwise",
                "start_azimuth_deg": 0.0,
                "channels": "CHANNELS",
            },
        },
    }
    section.update(detection)
    channels = [
        json.dumps({"elevation_deg": elevation, "azimuth_deg": azimuth, "time_us": round(time, 3)})
        for (elevation, azimuth), time in zip(lasers, times_us, strict=True)
    ]
    one_a_line = "[\n        " + ",\n        ".join(channels) + "\n      ]"
    text = json.dumps(section, indent=2).replace('"CHANNELS"', one_a_line)
    path.write_text(text + "\n")


def detection(range_min_m, range_max_m, range_at_10_percent_m, noise_sigma0_m, divergence_mrad,
              plausibility=None, receiver=None):
    """The sections of a sensor; the last two replace the sheet's figures by measured ones."""
    return {
        "range_min_m": range_min_m,
        "range_max_m": range_max_m,
        "plausibility": {
            "reference_threshold": 0.1,
            "reference_range_m": range_at_10_percent_m,
            "noise_sigma0_m": noise_sigma0_m,
            "noise_sigma1": 0.0001,
            **(plausibility or {}),
        },
        "beam": {"wavelength_nm": 905, "divergence_mrad": divergence_mrad},
        "receiver": {
            "range_at_10_percent_m": range_at_10_percent_m,
            "range_noise_floor_m": noise_sigma0_m,
            **(receiver or {}),
        },
    }


# Measured on a recording of each sensor (docs/validation.md). The pointing jitter of all is that of
# VLS-128, the only one that was outdoors.
VLP16 = [
    {"noise_sigma0_m": 0.008, "noise_sigma1": 0.0, "dropout_probability": 0.0002,
     "dark_dropout_probability": 0.037, "dark_dropout_intensity": 0.021},
    {"range_noise_floor_m": 0.0075, "channel_bias_sigma_m": 0.003, "pointing_jitter_deg": 0.0015,
     "dead_time_ns": 7.9},
]
VLP32C = [
    {"noise_sigma0_m": 0.015, "noise_sigma1": 0.0, "dark_dropout_probability": 0.0046,
     "dark_dropout_intensity": 0.11},
    {"range_noise_floor_m": 0.0045, "channel_bias_sigma_m": 0.014, "pointing_jitter_deg": 0.0015},
]
PANDAR64 = [
    {"noise_sigma0_m": 0.013, "noise_sigma1": 0.0, "dropout_probability": 0.00005,
     "dark_dropout_probability": 0.004, "dark_dropout_intensity": 0.024},
    {"range_noise_floor_m": 0.009, "channel_bias_sigma_m": 0.009, "pointing_jitter_deg": 0.0015,
     "dead_time_ns": 5.6},
]
VLS128 = [
    {"noise_sigma0_m": 0.014, "noise_sigma1": 0.0, "dropout_probability": 0.00035,
     "dark_dropout_probability": 0.014, "dark_dropout_intensity": 0.007},
    {"signal": "energy", "range_noise_floor_m": 0.0075, "range_noise_scale_m": 0.13,
     "channel_bias_sigma_m": 0.01, "pointing_jitter_deg": 0.0015},
]
XT32 = [
    {"noise_sigma0_m": 0.004, "noise_sigma1": 0.0, "dropout_probability": 0.00005,
     "dark_dropout_probability": 0.008, "dark_dropout_intensity": 0.001},
    {"range_noise_floor_m": 0.0037, "channel_bias_sigma_m": 0.0, "pointing_jitter_deg": 0.0015,
     "dead_time_ns": 2.6},
]
QT128 = [
    {"noise_sigma0_m": 0.011, "noise_sigma1": 0.0, "dark_dropout_probability": 0.003,
     "dark_dropout_intensity": 0.04},
    {"range_noise_floor_m": 0.0077, "channel_bias_sigma_m": 0.0075, "pointing_jitter_deg": 0.0015,
     "dead_time_ns": 2.6},
]


def main():
    data = pathlib.Path(sys.argv[1])
    out = pathlib.Path(sys.argv[2])
    velodyne = data / "velodyne_calibration" / "ros-drivers"
    hesai = data / "lidar_packets_nebula" / "calibration"

    write_sensor(out / "vlp16.json", "VLP-16", velodyne_lasers(velodyne / "VLP16db.yaml"),
                 [2.304 * i for i in range(16)], 55.296, 1808,
                 detection(0.5, 100.0, 50.0, 0.01, [3.0, 1.5], *VLP16))
    write_sensor(out / "vlp16_20hz.json", "VLP-16 at 20 Hz",
                 velodyne_lasers(velodyne / "VLP16db.yaml"), [2.304 * i for i in range(16)], 55.296,
                 904, {"file": "vlp16.json"}, rate_hz=20)
    write_sensor(out / "hdl32e.json", "HDL-32E", velodyne_lasers(velodyne / "32db.yaml"),
                 [1.152 * i for i in range(32)], 46.08, 2170,
                 detection(0.5, 100.0, 50.0, 0.007, [2.8, 2.8]))
    write_sensor(out / "vlp32c.json", "VLP-32C", velodyne_lasers(velodyne / "VeloView-VLP-32C.yaml"),
                 [2.304 * (i // 2) for i in range(32)], 55.296, 1808,
                 detection(0.5, 200.0, 90.0, 0.01, [3.0, 1.5], *VLP32C))
    # The two halves fire simultaneously, each in groups of four.
    write_sensor(out / "hdl64e.json", "HDL-64E S2",
                 hdl64e_lasers(velodyne / "64e_s2.1-sztaki.yaml"),
                 [6.0 * (i % 32 // 4) + (0.0, 1.26, 2.46, 3.66)[i % 4] for i in range(64)], 48.0,
                 2083, detection(0.5, 120.0, 50.0, 0.02, [2.0, 2.0]))
    # Groups of eight fire together; one maintenance slot follows the eighth group and three follow
    # the sixteenth. The cycle is that of a real sensor's packets, 165.83 us for three; the manual's
    # is 53.3 us.
    write_sensor(out / "vls128.json", "VLS-128", velodyne_lasers(velodyne / "VLS128.yaml"),
                 [2.665 * (i // 8 + i // 64) for i in range(128)], 55.277, 1809,
                 detection(0.5, 245.0, 220.0, 0.01, [3.0, 1.5], *VLS128))
    earliest_us = max(PANDAR64_BEFORE_END_US)
    write_sensor(out / "pandar64.json", "Pandar64", hesai_lasers(hesai / "Pandar64.csv"),
                 [earliest_us - before_us for before_us in PANDAR64_BEFORE_END_US],
                 55.5555555556, 1800, detection(0.3, 200.0, 200.0, 0.01, [3.0, 1.5], *PANDAR64))
    hesai = data / "lidar_hesai" / "calibration"
    write_sensor(out / "xt32.json", "XT32", hesai_lasers(hesai / "nebula_PandarXT32.csv"),
                 [1.512 * i for i in range(32)], 50.0, 2000,
                 detection(0.05, 120.0, 80.0, 0.005, [3.0, 1.5], *XT32))
    write_sensor(out / "qt128.json", "QT128",
                 *qt128_firings(hesai / "sdk_QT128C2X_Angle_Correction_File.csv",
                                hesai / "sdk_QT128C2X_Firetime_Correction_File.csv"),
                 222.2222222222, 450, detection(0.05, 50.0, 20.0, 0.01, [3.0, 1.5], *QT128))


if __name__ == "__main__":
    main()
