#pragma once

#include <filesystem>
#include <string>

#include "tests/core/io/recording/made_sequence.h"

namespace railcast {

inline constexpr std::uint32_t kRunBegins = 7;
inline constexpr std::uint32_t kRunFrames = 6;

/// Makes frames 7 to 12 of a vehicle in a curve of 500 m radius at 20 m/s, moving towards a box
/// that stands to the left of the track.
/// @param directory Must not exist.
inline MadeSequence MakeRun(const std::filesystem::path& directory,
                            const std::string& fidelity = "plausibility") {
  return MakeSequence(directory, {.fidelity = fidelity,
                                  .object = R"({"name": "crate", "type": "box", "s_m": 295, )"
                                            R"("d_m": 4, "size_m": [2, 3, 4], )"
                                            R"("material": "concrete", "label": "wagon"})",
                                  .start_frame = kRunBegins,
                                  .num_frames = kRunFrames});
}

}  // namespace railcast
