#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "railcast/scenario.h"

namespace railcast {

/// A plan beside its recording, as far as drawing from them asks. The generator, which reads
/// recordings for plans, provides it.
class RecordedBase {
 public:
  /// Where the vehicle is when a frame of the recording begins.
  struct FramePlace {
    std::int64_t time_ns{};
    double s_m{};     ///< As plans count chainages.
    bool faces_up{};  ///< Whether it faces rising chainage.
  };

  virtual ~RecordedBase() = default;

  /// The plan as it was written, with the recording's sensor if it names none.
  [[nodiscard]] virtual const ScenarioSpec& plan() const = 0;
  [[nodiscard]] virtual const std::filesystem::path& recording() const = 0;
  [[nodiscard]] virtual const std::vector<FramePlace>& frames() const = 0;
  /// What tells recordings apart: names and hashes of their files.
  [[nodiscard]] virtual const std::string& Traits() const = 0;
  /// A plan for the recording as a scenario: with the recording's line in place of that, so that a
  /// world can be made of it.
  /// @param plan With the poses, the line and the sensor's mount and scan of plan().
  /// @throws InputError for what the plan has, and for places of objects.
  [[nodiscard]] virtual ScenarioSpec OnLine(ScenarioSpec plan) const = 0;

  [[nodiscard]] std::uint32_t num_frames() const {
    return static_cast<std::uint32_t>(frames().size());
  }
};

/// Reads a plan and the way that its recording's sensor took.
/// @throws InputError if either cannot be read.
using RecordingReader = std::function<std::shared_ptr<const RecordedBase>(
    const std::filesystem::path& plan_file, const std::filesystem::path& recording)>;

}  // namespace railcast
