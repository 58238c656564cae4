#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "generator/extras/insert/firing_finder.h"
#include "generator/extras/insert/insert_plan.h"

namespace railcast {

/// What an object of a plan finds in the recording.
struct ThingCheck {
  std::string name;
  std::size_t num_frames_in_reach{};  ///< Frames in which firings aim at its bounding box.
  std::size_t most_firings{};  ///< Most such firings of one frame, within the sensor's range.
  std::size_t most_firings_frame{};
  /// Recorded points in its direction, over all frames that were looked at: all of them, those
  /// nearer than the object, which hide it, and those inside its bounding box, where a recorded
  /// surface stands already.
  std::size_t num_points{};
  std::size_t num_points_before{};
  std::size_t num_points_inside{};
  std::size_t num_frames_inside{};  ///< Frames with at least one point inside.
};

struct PlanCheck {
  std::size_t num_frames{};         ///< Frames of the range.
  std::size_t num_frames_looked{};  ///< Whose points were looked at.
  std::vector<ThingCheck> things;   ///< In the order of the plan's world.
};

/// Holds a plan against the range of its recording, without simulating: which firings of the
/// sensor's pattern aim at the bounding box of each object, and what was recorded there. Clouds are
/// read of at most 200 frames, evenly over the range. What lies in the lowest 0.1 m of a box counts
/// as ground.
/// @param finder Finds the firings of these frames, as insertion would.
/// @throws InputError if the recording cannot be read, or as CheckRanges() and
///   FiringFinder::Find().
[[nodiscard]] PlanCheck CheckPlan(const InsertPlan& plan,
                                  const std::filesystem::path& recording,
                                  const InsertRange& range,
                                  const FiringFinder& finder);

/// The report of a check, a few lines for each object.
[[nodiscard]] std::string PlanCheckText(const InsertPlan& plan, const PlanCheck& check);

}  // namespace railcast
