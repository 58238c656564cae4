#!/usr/bin/env python3
"""Writes scenarios/sensors/*.json from published calibration files.

usage: make_sensor_tables.py DATA_DIR OUT_DIR

DATA_DIR holds velodyne_calibration/ (of ros-drivers/velodyne), lidar_packets_nebula/calibration/ (of
tier4/nebula), lidar_hesai/calibration/ (of tier4/nebula and HesaiLidar_SDK_2.0) and
hesai_calibration/ (of tier4/nebula).
scenarios/sensors/README.md names the source of every other figure.
"""

import csv
import hashlib
import json
import math
import pathlib
import re
import struct
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

# Pandar40P: microseconds from the firing of channels 1 to 40 to the end of their block (tier4/nebula, pandar_40.hpp).
PANDAR40P_BEFORE_END_US = [
    42.22, 28.47, 16.04, 3.62, 45.49, 31.74, 47.46, 54.67, 20.62, 33.71, 40.91, 8.19, 20.62, 27.16,
    50.73, 8.19, 14.74, 36.98, 45.49, 52.70, 23.89, 31.74, 38.95, 11.47, 18.65, 25.19, 48.76, 6.23,
    12.77, 35.01, 21.92, 9.50, 43.52, 29.77, 17.35, 4.92, 42.22, 28.47, 16.04, 3.62,
]

# QT64: microseconds from the begin of a block to the firing of channels 1 to 64 (tier4/nebula, pandar_qt64.hpp, where
# that of channel 56 lacks a digit: the four groups of sixteen have the same steps).
QT64_SINCE_BEGIN_US = [
    12.31, 14.37, 16.43, 18.49, 20.54, 22.60, 24.66, 26.71, 29.16, 31.22, 33.28, 35.34, 37.39, 39.45, 41.50, 43.56,
    46.61, 48.67, 50.73, 52.78, 54.84, 56.90, 58.95, 61.01, 63.45, 65.52, 67.58, 69.63, 71.69, 73.74, 75.80, 77.86,
    80.90, 82.97, 85.02, 87.08, 89.14, 91.19, 93.25, 95.30, 97.75, 99.82, 101.87, 103.93, 105.98, 108.04, 110.10,
    112.15, 115.20, 117.26, 119.32, 121.38, 123.43, 125.49, 127.54, 129.60, 132.05, 134.11, 136.17, 138.22, 140.28,
    142.34, 144.39, 146.45,
]

# 128E4X: nanoseconds from the begin of a block to the firing of lasers 0 to 127 (tier4/nebula, pandar_128e4x.hpp).
# The tables there contradict each other and a recorded cloud; scenarios/sensors/README.md says what was put right.
E4X_SINCE_BEGIN_NS = [
    21980, 15446, 8912, 2378, 21980, 15446, 8912, 2378, 21980, 15446, 8912, 2378, 2378, 15446, 8912, 21980, 15446,
    2378, 21980, 8912, 15446, 2378, 21980, 8912, 6534, 17224, 10690, 13068, 13068, 6534, 23758, 19602, 4156, 19602,
    4156, 23758, 10690, 0, 0, 17224, 10690, 13068, 23758, 17224, 4156, 19602, 6534, 0, 10690, 13068, 23758, 17224,
    4156, 19602, 6534, 0, 10690, 13068, 23758, 17224, 4156, 19602, 6534, 0, 17224, 17224, 23758, 10690, 13068, 19602,
    13068, 4156, 17224, 0, 10690, 13068, 4156, 0, 10690, 6534, 6534, 6534, 19602, 23758, 4156, 23758, 19602, 0, 21980,
    15446, 8912, 2378, 21980, 15446, 8912, 2378, 21980, 15446, 8912, 2378, 21980, 15446, 8912, 2378, 21980, 15446,
    8912, 2378, 21980, 15446, 8912, 2378, 15446, 21980, 2378, 8912, 21980, 15446, 2378, 8912, 21980, 15446, 8912,
    2378, 21980, 15446, 8912, 2378,
]
E4X_BLOCK_US = 27.778


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


def e4x_is_central(laser):
    return 24 <= laser < 88


def e4x_fires(laser, state):
    """Whether a laser of the 128E4X fires in this azimuth state: the central ones in both, groups of four others in
    turn."""
    return e4x_is_central(laser) or laser // 4 % 2 != state


def e4x_firings(angles, since_begin_us):
    """(elevation, azimuth) in degrees and the time in us of each firing of a cycle of two blocks: those of azimuth
    state 0, then those of state 1, by rising laser."""
    fired = [(state, laser) for state in range(2) for laser in range(128) if e4x_fires(laser, state)]
    return ([angles[laser] for _, laser in fired],
            [since_begin_us[laser] + state * E4X_BLOCK_US for state, laser in fired])


def e4x_standard_times(since_begin_us):
    """The times in us at which the lasers of the 128E4X fire in its standard mode: all once in two blocks."""
    times_us = [time_us + (E4X_BLOCK_US if e4x_is_central(laser) or laser // 4 % 2 == 0 else 0.0)
                for laser, time_us in enumerate(since_begin_us)]
    return [time_us - min(times_us) for time_us in times_us]


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


def write_sensor(path, name, lasers, times_us, cycle_us, columns, detection, rate_hz=10, turned_us=0.0):
    """turned_us is the time from the azimuth of a packet's first block to its first firing: the frame begins where
    that azimuth is 0."""
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
                "start_azimuth_deg": round(360e-6 * rate_hz * turned_us, 6),
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


# Measured on a recording of each sensor (docs/results/validation.md). The pointing jitter of all is that of
# VLS-128, the only one that was outdoors.
VLP16 = [
    {"noise_sigma0_m": 0.008, "noise_sigma1": 0.0, "dropout_probability": 0.0002,
     "dark_dropout_probability": 0.037, "dark_dropout_intensity": 0.021},
    {"range_noise_floor_m": 0.0075, "channel_bias_sigma_m": 0.003, "pointing_jitter_deg": 0.0015,
     "dead_time_ns": 7.9, "intensity_noise": 0.1},
]
VLP32C = [
    {"noise_sigma0_m": 0.015, "noise_sigma1": 0.0, "dark_dropout_probability": 0.0046,
     "dark_dropout_intensity": 0.11},
    {"range_noise_floor_m": 0.0045, "channel_bias_sigma_m": 0.014, "pointing_jitter_deg": 0.0015,
     "intensity_noise": 0.15, "channel_gain": 0.29},
]
PANDAR64 = [
    {"noise_sigma0_m": 0.013, "noise_sigma1": 0.0, "dropout_probability": 0.00005,
     "dark_dropout_probability": 0.004, "dark_dropout_intensity": 0.024},
    {"range_noise_floor_m": 0.009, "channel_bias_sigma_m": 0.009, "pointing_jitter_deg": 0.0015,
     "dead_time_ns": 5.6, "intensity_noise": 0.06, "channel_gain_variation": 0.14},
]
VLS128 = [
    {"noise_sigma0_m": 0.014, "noise_sigma1": 0.0, "dropout_probability": 0.00035,
     "dark_dropout_probability": 0.014, "dark_dropout_intensity": 0.007},
    {"signal": "energy", "range_noise_floor_m": 0.0075, "range_noise_scale_m": 0.13,
     "channel_bias_sigma_m": 0.01, "pointing_jitter_deg": 0.0015,
     "intensity_noise": 0.08, "channel_gain_variation": 0.19},
]
XT32 = [
    {"noise_sigma0_m": 0.003, "noise_sigma1": 0.0, "dropout_probability": 0.00005,
     "dark_dropout_probability": 0.042, "dark_dropout_intensity": 0.00115},
    {"range_noise_floor_m": 0.0026, "channel_bias_sigma_m": 0.0, "pointing_jitter_deg": 0.0015,
     "dead_time_ns": 2.6, "intensity_noise": 0.014, "channel_gain": 0.025},
]
QT128 = [
    {"noise_sigma0_m": 0.011, "noise_sigma1": 0.0, "dark_dropout_probability": 0.003,
     "dark_dropout_intensity": 0.04},
    {"range_noise_floor_m": 0.0077, "channel_bias_sigma_m": 0.0075, "pointing_jitter_deg": 0.0015,
     "dead_time_ns": 2.6, "intensity_noise": 0.058, "channel_gain": 0.036,
     "channel_gain_variation": 0.039},
]


def at128_correction():
    """A correction file without the deviations of a unit, as core/scan/at128.cpp reads it: lasers 0.2 deg apart
    that look 2.4 and 0.65 deg to either side in turn, 16 and 16 (tier4/nebula, PandarAT128.csv), fields 120 deg apart,
    and no shifts."""
    steps_per_deg = 25600 // 2
    starts = [20 + 120 * field for field in range(3)]
    azimuths = [(-1 if i // 16 % 2 == 0 else 1) * (2.4 if i % 2 == 0 else -0.65) for i in range(128)]
    elevations = [12.93 - 0.2 * i for i in range(128)]
    head = bytes([0xEE, 0xFF, 1, 5, 128, 3, 3, 1, 2, 4, 0, 0, 0, 0, 0, 2])
    angles = struct.pack("<262i", *(round(steps_per_deg * angle)
                                    for angle in [*starts, *starts[1:], starts[0], *azimuths, *elevations]))
    body = head + angles + bytes(2 * 128 * 180)
    return body + hashlib.sha256(body).digest()


def write_at128(path, detection):
    """The sensor whose firings are those of a correction file, which lies beside it."""
    path.with_suffix(".dat").write_bytes(at128_correction())
    pattern = {"type": "table", "file": path.with_suffix(".dat").name, "frames": 3}
    section = {"version": 1, "name": "AT128", "scan": {"rate_hz": 10, "pattern": pattern}}
    path.write_text(json.dumps({**section, **detection}, indent=2) + "\n")


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
    e4x_angles = hesai_lasers(hesai / "nebula_Pandar128E4X.csv")
    e4x_us = [1e-3 * time_ns for time_ns in E4X_SINCE_BEGIN_NS]
    write_sensor(out / "pandar128e4x.json", "Pandar128E4X", *e4x_firings(e4x_angles, e4x_us),
                 55.5555555556, 1800, detection(0.3, 230.0, 200.0, 0.01, [3.0, 1.5]))
    write_sensor(out / "pandar128e4x_standard.json", "Pandar128E4X standard", e4x_angles,
                 e4x_standard_times(e4x_us), 55.5555555556, 1800, {"file": "pandar128e4x.json"},
                 turned_us=2.378)
    hesai = data / "hesai_calibration"
    earliest_us = max(PANDAR40P_BEFORE_END_US)
    write_sensor(out / "pandar40p.json", "Pandar40P", hesai_lasers(hesai / "Pandar40P.csv"),
                 [earliest_us - before_us for before_us in PANDAR40P_BEFORE_END_US],
                 55.5555555556, 1800,
                 detection(0.3, 200.0, 200.0, 0.01, [3.0, 1.5],
                           receiver={"dead_time_ns": 5.4, "intensity_noise": 0.06, "channel_gain_variation": 0.19}))
    write_sensor(out / "qt64.json", "QT64", hesai_lasers(hesai / "PandarQT64.csv"),
                 [time_us - QT64_SINCE_BEGIN_US[0] for time_us in QT64_SINCE_BEGIN_US],
                 166.6666666667, 600,
                 detection(0.1, 60.0, 20.0, 0.01, [3.0, 1.5], receiver={"dead_time_ns": 4.4}),
                 turned_us=QT64_SINCE_BEGIN_US[0])
    write_sensor(out / "xt16.json", "XT16", hesai_lasers(hesai / "PandarXT16.csv"),
                 [3.024 * i for i in range(16)], 50.0, 2000,
                 detection(0.05, 120.0, 80.0, 0.005, [3.0, 1.5], *XT32), turned_us=6.0)
    write_sensor(out / "xt32m.json", "XT32M", hesai_lasers(hesai / "PandarXT32M.csv"),
                 [2.888 * (i % 16) for i in range(32)], 50.0, 2000,
                 detection(0.5, 300.0, 80.0, 0.005, [3.0, 1.5], *XT32), turned_us=6.0)
    write_at128(out / "at128.json", detection(1.0, 180.0, 200.0, 0.01, [3.0, 1.5]))


if __name__ == "__main__":
    main()
