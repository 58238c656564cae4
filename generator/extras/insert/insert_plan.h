#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/io/run/scenario_identity.h"
#include "generator/extras/insert/intensity_scale.h"
#include "railcast/scenario.h"
#include "railcast/scene.h"

namespace railcast {

/// Where an object of a plan was asked for, and where it is at first.
struct PlacedThing {
  std::string asked;    ///< As the plan says it: "frame 120, s_m 60, d_m 0.4".
  double s_m{};         ///< Chainage, as the plan counts it.
  double d_m{};         ///< Left of the line.
  double h_m{};         ///< Above the rails.
  bool is_on_ground{};  ///< Whether it stands on the ground instead of at a height of the plan's.
  bool has_ground{};    ///< Whether that was found in the recording.
  double ground_residual_m{};  ///< Root mean square distance of the ground's points from its plane.
};

/// What is put into a recording, ready to be simulated.
struct InsertPlan {
  /// The sensor, its effects, receiver and weather, labels, materials and models. `world` has the
  /// line of the recording as its alignment and the objects at their places on it.
  ScenarioSpec scenario;
  /// The objects alone, and the recorded way of the vehicle. Time 0 is `first_stamp_ns`.
  std::shared_ptr<const World> world;
  std::int64_t first_stamp_ns{};  ///< Stamp of the recording's first frame.
  /// When each frame of the recording begins, by the clock of `world`. Frames that have no stamps
  /// follow each other at the sensor's rate.
  std::vector<std::int64_t> frame_times_ns;
  IntensityScale intensity_scale{};  ///< The recording's scale.
  /// Frame::sensor_from_spin of the recording's first frame: by the axes about whose z the sensor
  /// spins, its beams and what is on its window are oriented.
  std::optional<Eigen::Matrix3d> sensor_from_spin{};
  std::vector<PlacedThing> places;  ///< Places of the objects, without the vehicles of trains.
  /// The plan as it was written, with the recording's sensor if it names none.
  ScenarioIdentity identity;
  /// What was found or assumed on the way, each in a sentence for the user.
  std::vector<std::string> remarks;
};

/// The frames of a recording that something is inserted into.
struct InsertRange {
  std::uint32_t first{};
  std::uint32_t num{};
};

/// Where the sensor is by the plan's way of the vehicle, in world coordinates.
/// @param time_ns As in InsertPlan::frame_times_ns.
[[nodiscard]] Transform PlannedPose(const InsertPlan& plan, std::int64_t time_ns);

/// Reads a plan, a scenario whose world is a recording, and the way that the recording's sensor
/// took.
/// @param plan_file `world` has the section `recording` in place of an alignment (docs/insert.md).
/// @param recording As OpenRecording() takes it; is read once for its poses, and of frames near
///   objects once more for the ground.
/// @throws InputError with a line for every fault: "plan.json: /world/objects/0/s_m: rule (got
///   value)".
[[nodiscard]] InsertPlan ReadInsertPlan(const std::filesystem::path& plan_file,
                                        const std::filesystem::path& recording);

}  // namespace railcast
