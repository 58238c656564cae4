#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/extras/recipe/dataset_record.h"
#include "core/io/recording/line_reader.h"
#include "core/io/run/frame_record.h"

namespace railcast {

/// What the index says of a frame.
struct IndexedFrame {
  FrameRecord record;
  double vehicle_s_m{};
  double vehicle_speed_mps{};
  std::vector<IndexObjectRecord> objects;
};

/// A scenario's line of scenarios.jsonl and the frames of its sequences.
struct IndexedScenario {
  ScenarioRecord record;
  std::vector<std::vector<IndexedFrame>> frames;  ///< For each of `record.sequences`.
};

/// Reads a scenario and the records of its sequences.
/// @param line Its line of scenarios.jsonl.
/// @throws InputError if it or a file of a sequence cannot be read or is damaged.
[[nodiscard]] IndexedScenario ReadIndexedScenario(const std::filesystem::path& dataset,
                                                  const PlacedLine& line);

/// Lines of index.jsonl, one for each frame.
[[nodiscard]] std::string IndexLines(const IndexedScenario& scenario);

}  // namespace railcast
