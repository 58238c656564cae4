#pragma once

#include <vector>

#include "tests/core/track/track_truth.h"

namespace railcast {

/// Scenes of several sensors, mounts, curves, gauges and weathers, each with its own track.
inline std::vector<TrackScene> TrackScenes() {
  return {
      {.name = "Vlp16OnTheBumper",
       .sensor = "vlp16",
       .mount = R"({"position_m": [0.4, 0.1, 1.1], "pitch_deg": 8})"},
      {.name = "Vlp16InACurve",
       .sensor = "vlp16",
       .mount = R"({"position_m": [2.2, 0, 1.8], "pitch_deg": 10})",
       .radius_m = "500",
       .cant_mm = 60},
      {.name = "Hdl32eOnTheRoof",
       .sensor = "hdl32e",
       .mount = R"({"position_m": [1.5, -0.4, 3.4], "pitch_deg": 12, "yaw_deg": 3})",
       .radius_m = "-300",
       .cant_mm = -120},
      {.name = "Xt32BehindTheWindscreen",
       .sensor = "xt32",
       .mount = R"({"position_m": [2.2, 0.3, 2.4], "pitch_deg": 10})",
       .radius_m = "300",
       .cant_mm = 150},
      {.name = "Pandar64InATightCurve",
       .sensor = "pandar64",
       .mount = R"({"position_m": [2.0, 0, 2.8], "pitch_deg": 5, "roll_deg": 2})",
       .radius_m = "190"},
      {.name = "Vls128OnTheRoof",
       .sensor = "vls128",
       .mount = R"({"position_m": [1.0, 0, 3.8], "pitch_deg": 10})",
       .radius_m = "1000",
       .cant_mm = 100},
      {.name = "Hdl64eOnMetreGauge",
       .sensor = "hdl64e",
       .mount = R"({"position_m": [0.5, 0, 1.6], "pitch_deg": 0})",
       .radius_m = "250",
       .gauge_mm = 1000},
      {.name = "Pandar128OnBroadGauge",
       .sensor = "pandar128e4x",
       .mount = R"({"position_m": [2.2, 0, 2.6], "pitch_deg": 6})",
       .radius_m = "-2000",
       .cant_mm = -50,
       .gauge_mm = 1520},
      {.name = "Xt32mOnAMast",
       .sensor = "xt32m",
       .mount = R"({"position_m": [0, 3.6, 5.5], "pitch_deg": 35, "yaw_deg": -50})"},
      {.name = "Pandar40pOnWetRails",
       .sensor = "pandar40p",
       .mount = R"({"position_m": [2.2, 0, 2.2], "pitch_deg": 8})",
       .weather = R"({"wetness": 1.0, "rain_rate_mmph": 5})"},
      {.name = "Vlp32cInLightSnow",
       .sensor = "vlp32c",
       .mount = R"({"position_m": [1.2, 0, 2.9], "pitch_deg": 12})",
       .weather = R"({"snow_rate_mmph": 0.5})"},
      {.name = "Vir2railWithATurnoutAhead",
       .sensor = "vir2rail",
       .world = R"(, "tracks": [{"name": "main"}, {"name": "loop", "offset_m": 4.5, "begin": )"
                R"({"track": "main", "s_m": 240, "turnout": "1:9-300"}}])"},
      {.name = "Xt32AtAStation",
       .sensor = "xt32",
       .world = R"(, "tracks": [{"name": "main"}, {"name": "second", "offset_m": 4.5}], )"
                R"("structures": [{"type": "platform", "name": "p1", "track": "main", )"
                R"("side": "right", "begin_s_m": 150, "end_s_m": 400, "height_m": 0.55, )"
                R"("width_m": 4}])"},
      {.name = "Pandar64InACantRamp",
       .sensor = "pandar64",
       .mount = R"({"position_m": [2.0, 0, 3.0], "pitch_deg": 10})",
       .cant_after_mm = 150,
       .start_s_m = 180.0},
      {.name = "Pandar64LeansInACurve",
       .sensor = "pandar64",
       .mount =
           R"({"position_m": [2.0, -0.5, 3.2], "pitch_deg": 15, "yaw_deg": 20, "roll_deg": -4})",
       .radius_m = "700",
       .cant_mm = 80},
  };
}

}  // namespace railcast
