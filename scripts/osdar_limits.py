"""The sensors and dimensions that the operator's validator accepts (raillabel-providerkit 1.4)."""

SENSORS = {
    **dict.fromkeys((f"{kind}_{place}" for kind in ("rgb", "ir", "rgb_highres", "rgb_longrange")
                     for place in ("left", "center", "right")), "camera"),
    **dict.fromkeys((f"{kind}_{place}" for kind in ("rgb_12mp", "rgb_5mp", "ir")
                     for place in ("left", "middle", "right")), "camera"),
    "lidar": "lidar", "lidar_merged": "lidar", "radar": "radar", "radar_cartesian": "radar", "gps_imu": "gps_imu",
}
# Cameras of OSDaR26 have optical axes (x right, y down, z forward), all others x forward, y left, z up.
CAMERAS_WITH_OPTICAL_AXES = ("rgb_12mp_", "rgb_5mp_", "ir_left", "ir_middle", "ir_right")
ANNOTATIONS = {"camera": ("bbox", "poly2d"), "lidar": ("cuboid", "poly3d", "vec"), "radar": ("bbox", "cuboid")}

# (classes, attributes that select the row, heights, widths) in m; the first row that applies counts.
# A width is the lesser side of the base for the least, the greater side for the most.
DIMENSIONS = (
    (("person",), {"age": "adult", "pose": "upright"}, (1.1, 2.7), (0.1, 2.0)),
    (("person",), {"age": "adult", "pose": "sitting"}, (0.5, 2.5), (0.1, 2.0)),
    (("person",), {"age": "adult", "pose": "lying"}, (0.1, 0.6), (0.1, 2.5)),
    (("person",), {"age": "child", "pose": "upright"}, (0.5, 1.6), (0.1, 1.5)),
    (("person",), {"age": "child", "pose": "sitting"}, (0.5, 1.4), (0.1, 1.5)),
    (("person",), {}, (0.1, 2.7), (0.1, 2.0)),
    (("personal_item",), {}, (0.2, 3.5), (0.2, 3.5)),
    (("pram",), {}, (0.3, 1.6), (0.4, 2.0)),
    (("crowd",), {}, (0.5, 2.5), None),
    (("scooter", "bicycle"), {}, (0.3, 1.6), (0.1, 2.5)),
    (("group_of_bicycles",), {}, (0.3, 1.6), None),
    (("wheelchair",), {}, (0.6, 1.6), (0.5, 1.6)),
    (("train", "rail_vehicle", "wagons"), {}, (0.9, 6.0), (1.7, 900.0)),
    (("motorcycle",), {}, (0.9, 3.0), (0.1, 3.0)),
    (("road_vehicle",), {"type": "bus"}, (1.5, 8.0), (1.5, 25.0)),
    (("road_vehicle",), {}, (0.5, 8.0), (1.5, 25.0)),
    (("animal",), {"size": "small"}, (0.1, 0.6), (0.1, 1.5)),
    (("animal",), {"size": "medium"}, (0.4, 1.3), (0.3, 2.0)),
    (("animal",), {}, (1.2, 3.0), (0.3, 4.0)),
    (("group_of_animals",), {}, (0.1, 3.0), None),
    (("drag_shoe",), {}, (0.08, 0.7), (0.08, 0.7)),
    (("track", "transition", "switch"), {}, (0.1, 0.8), None),
    (("catenary_pole",), {}, (3.0, 21.0), (0.1, 3.0)),
    (("signal",), {}, (0.1, 4.0), (0.1, 4.0)),
    (("signal_pole",), {}, (1.0, 14.0), (0.1, 4.0)),
    (("signal_bridge",), {}, (0.1, 10.0), (0.1, 30.0)),
    (("buffer_stop",), {}, (0.9, 4.0), (0.5, 4.5)),
)
