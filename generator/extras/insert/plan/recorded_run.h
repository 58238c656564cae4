#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "generator/extras/insert/insert_plan.h"
#include "generator/extras/insert/plan/recorded_line.h"
#include "generator/extras/insert/plan/recorded_way.h"
#include "railcast/scenario.h"

namespace railcast {

/// A plan beside its recording, of which all is read that other plans for it need, too.
struct RecordedRun {
  std::filesystem::path recording;
  /// As it was written, with the recording's sensor if it names none, and the noise and texture of
  /// its intensities (UseIntensities()).
  ScenarioSpec plan;
  RecordedWay way{};
  RecordedLine line{};
  std::string intensities{};  ///< Whose these are, in a sentence; empty if the plan wants none.
  std::vector<std::string> remarks{};  ///< What was found or assumed on the way.

  [[nodiscard]] std::uint32_t num_frames() const {
    return static_cast<std::uint32_t>(way.frame_times_ns.size());
  }
  /// Chainage of the vehicle when a frame begins, as plans count it.
  [[nodiscard]] double Chainage_m(std::uint32_t frame) const {
    return line.at_frames_m.at(frame) - line.zero_s_m;
  }
};

/// Reads a plan and the way that the recording's sensor took.
/// @throws InputError as ReadInsertPlan() does for these.
[[nodiscard]] RecordedRun ReadRecordedRun(const std::filesystem::path& plan_file,
                                          const std::filesystem::path& recording);

/// What tells recordings apart: the names and hashes of all their files, and of what stands beside
/// a capture about its sensor. Of a finished sequence of railcast it is the manifest, which holds
/// the hashes that are compared where frames are read.
/// @param source As OpenRecording() takes it.
/// @throws InputError if a file cannot be read.
[[nodiscard]] std::string RecordingTraits(const std::filesystem::path& source);

/// A plan for the recording as a scenario: with the recording's line in place of that, so that a
/// world can be made of it.
/// @param plan With the poses, the line and the sensor's mount and scan of `run.plan`.
/// @throws InputError as ReadInsertPlan() does for what the plan has and for places of objects.
[[nodiscard]] ScenarioSpec OnRecordedLine(const RecordedRun& run, ScenarioSpec plan);

/// Makes such a plan ready to be simulated. Of the recording, frames near objects are read for the
/// ground, and the first few for the scale of their intensities.
/// @throws InputError as OnRecordedLine() does.
[[nodiscard]] InsertPlan MakeInsertPlan(const RecordedRun& run, const ScenarioSpec& plan);

}  // namespace railcast
