#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/io/cloud/scan_motion.h"
#include "core/track/found_track.h"
#include "railcast/alignment.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// A scene whose track is to be found.
struct TrackScene {
  std::string name;
  std::string sensor = "xt32";
  std::string mount = R"({"position_m": [2.2, 0, 2.5], "pitch_deg": 10})";
  std::string radius_m{};  ///< Empty: straight.
  double cant_mm = 0.0;
  double cant_after_mm{};  ///< From 300 m on, if it is another one: it changes from 150 m on.
  double gauge_mm = 1435.0;
  std::string weather = "{}";
  std::string lidar{};    ///< Further members of the section `lidar`: R"(, "effects": {})".
  std::string world{};    ///< Further members of the section `world`, likewise.
  std::string vehicle{};  ///< Likewise.
  double start_s_m = 220.0;
};

inline ScenarioSpec ScenarioOf(const TrackScene& scene) {
  const std::string folder = RAILCAST_SOURCE_DIR "/scenarios/";
  const std::string course =
      scene.radius_m.empty()
          ? R"({"type": "straight", "length_m": 1200})"
          : R"({"type": "arc", "length_m": 1200, "radius_m": )" + scene.radius_m + "}";
  const std::string ramp = scene.cant_after_mm == 0.0
                               ? ""
                               : R"(, {"s_m": 150, "value": )" + std::to_string(scene.cant_mm) +
                                     R"(}, {"s_m": 300, "value": )" +
                                     std::to_string(scene.cant_after_mm) + "}";
  return ReadScenarioText(
      R"({"version": 1, "fidelity": "footprint", "lidar": {"file": ")" + folder + "sensors/" +
          scene.sensor + R"(.json", "mount": )" + scene.mount + scene.lidar + R"(}, "weather": )" +
          scene.weather + R"(, "world": {"alignment": {"gauge_mm": )" +
          std::to_string(scene.gauge_mm) + R"(, "cants_mm": [{"s_m": 0, "value": )" +
          std::to_string(scene.cant_mm) + "}" + ramp +
          R"(], "course": {"type": "elements", "elements": [)" + course + "]}}" + scene.world +
          R"(}, "vehicle": {"start_s_m": )" + std::to_string(scene.start_s_m) +
          R"(, "motion": {"profile": [{"time_s": 0, "speed_mps": 8}]})" + scene.vehicle +
          R"(}, "materials": ")" + folder + R"(materials/railway.json", "labels": ")" + folder +
          "labels.json\"}",
      folder + "scene.json");
}

/// The track that the sensor's vehicle is on, beside the sensor.
inline FoundTrack TrueTrack(const ScenarioSpec& scenario,
                            const Transform& world_from_sensor,
                            double about_s_m) {
  const Alignment line(scenario.world.alignment);
  double s_m = about_s_m;
  Transform track_from_sensor;
  for (int i = 0; i < 20; ++i) {
    track_from_sensor = line.WorldFromTrack(s_m).inverse() * world_from_sensor;
    s_m += track_from_sensor.translation().x();
  }
  FoundTrack track;
  track.track_from_sensor = track_from_sensor;
  track.height_m.value = track_from_sensor.translation().z();
  track.sideways_m.value = track_from_sensor.translation().y();
  const Eigen::Matrix3d turn = track_from_sensor.linear();
  track.yaw_rad.value = std::atan2(turn(1, 0), turn(0, 0));
  track.pitch_rad.value = -std::asin(turn(2, 0));
  track.roll_rad.value = std::atan2(turn(2, 1), turn(2, 2));
  track.gauge_m.value = 1e-3 * scenario.world.alignment.gauge_mm;
  track.curvature_per_m.value = line.At(s_m).curvature_per_m;
  return track;
}

/// The points of a frame in the sensor's axes at its stamp.
inline std::vector<Eigen::Vector3f> PointsOf(const Frame& frame) {
  const ScanMotion motion(frame);
  std::vector<Eigen::Vector3f> points_m;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (!std::isfinite(frame.range_m[i])) continue;
    points_m.push_back(
        motion.AtStamp({frame.x[i], frame.y[i], frame.z[i]}, frame.time_ns[i]).cast<float>());
  }
  return points_m;
}

/// What was found in a frame, beside what is true.
struct TrackTrial {
  FoundTracks found;
  FoundTrack truth;
  /// The found track that is nearest to the true one; null if there is none.
  [[nodiscard]] const FoundTrack* own() const {
    const FoundTrack* nearest = nullptr;
    for (const FoundTrack& track : found.tracks) {
      const auto off_m = [&](const FoundTrack& each) {
        return std::abs(each.sideways_m.value - truth.sideways_m.value);
      };
      if (nearest == nullptr || off_m(track) < off_m(*nearest)) nearest = &track;
    }
    return nearest;
  }
};

inline std::vector<TrackTrial> TryScene(const TrackScene& scene,
                                        std::uint32_t num_frames,
                                        std::uint32_t step) {
  const ScenarioSpec scenario = ScenarioOf(scene);
  const auto simulator = MakeSimulator(scenario, 0);
  std::vector<TrackTrial> trials;
  for (std::uint32_t i = 0; i < num_frames; ++i) {
    Frame frame;
    simulator->Scan(i * step, frame);
    trials.push_back(
        {FindTracks(PointsOf(frame), std::nullopt),
         TrueTrack(scenario, frame.world_from_sensor,
                   scene.start_s_m + 8.0 * 1e-9 * static_cast<double>(frame.stamp_ns))});
  }
  return trials;
}

}  // namespace railcast
