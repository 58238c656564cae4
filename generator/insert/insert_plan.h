#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "railcast/scenario.h"
#include "railcast/scene.h"

namespace railcast {

/// What is put into a recording, ready to be simulated.
struct InsertPlan {
  /// The sensor, its effects, receiver and weather, labels, materials and models. `world` has the
  /// driven path as its alignment and the objects at their places on it.
  ScenarioSpec scenario;
  /// The objects alone, and the recorded way of the vehicle. Time 0 is `first_stamp_ns`.
  std::shared_ptr<const World> world;
  std::int64_t first_stamp_ns{};  ///< Stamp of the recording's first frame.
  std::string hash;               ///< XXH3 of the plan and of every file that it names.
  /// What was found or assumed on the way, each in a sentence for the user.
  std::vector<std::string> remarks;
};

/// Reads a plan, a scenario whose world is a recording, and the way that the recording's sensor
/// took.
/// @param plan_file `world` has the section `recording` in place of an alignment (docs/insert.md).
/// @param recording As OpenRecording() takes it; is read once, for poses and ground.
/// @throws InputError with a line for every fault: "plan.json: /world/objects/0/s_m: rule (got
///   value)".
[[nodiscard]] InsertPlan ReadInsertPlan(const std::filesystem::path& plan_file,
                                        const std::filesystem::path& recording);

}  // namespace railcast
