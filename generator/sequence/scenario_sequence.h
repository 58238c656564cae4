#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "generator/run/run_identity.h"
#include "railcast/scenario.h"

namespace railcast {

/// Which frames of a scenario are written, where and how.
struct SequenceChoices {
  std::filesystem::path directory;
  std::string format = "pcd";
  std::string fields = "all";
  std::string isa;  ///< Of the trace; empty = the machine's best.
  std::uint32_t start_frame = 0;
  std::uint32_t num_frames = 10;
  std::uint32_t stride = 1;
};

/// Checks that a format can hold the scenario's points.
/// @param shown The scenario's name in messages.
/// @throws InputError "SHOWN: /output: must be right-handed sensor coordinates for --format kitti
///   (got ...)".
void CheckOutputSuits(const std::string& format,
                      const ScenarioSpec& scenario,
                      const std::string& shown);

/// Makes the specification of a sequence of a scenario with one sensor.
/// @throws InputError if the fields or the instruction set do not fit.
[[nodiscard]] SequenceSpec SequenceSpecOf(const ScenarioSpec& scenario,
                                          const SequenceChoices& choices);

}  // namespace railcast
