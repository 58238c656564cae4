#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace railcast {

/// What a line of frames.jsonl says of the clouds that a bag holds of the frame.
struct CloudsOfFrame {
  std::int64_t stamp_ns{};
  std::string hash;   ///< ContentHash() of its messages, one after another.
  std::string place;  ///< Of the line: "out/frames.jsonl:3".
};

/// Compares the clouds in a bag with those of a sequence's frames.
/// @param topics Those of the sensor's clouds.
/// @param faults Gets a line for each frame whose clouds are missing or others, and for each cloud
///   that belongs to no frame.
/// @throws InputError if the bag cannot be read.
void CompareWithBag(const std::filesystem::path& bag,
                    const std::vector<std::string>& topics,
                    const std::vector<CloudsOfFrame>& frames,
                    ErrorList& faults);

}  // namespace railcast
