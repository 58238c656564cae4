#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/io/run/frame_record.h"
#include "core/scenario/json_text.h"

namespace railcast {

/// What the index says of an object in a frame.
struct IndexedObject {
  std::string name;
  std::string type;
  std::string label;
  std::uint32_t instance{};
  double distance_m{};  ///< From the sensor to the centre of its box.
  std::uint32_t points{};
  std::uint32_t firings_visible{};
  std::uint32_t firings_alone{};
  std::optional<double> occlusion;
};

/// What the index says of a frame.
struct IndexedFrame {
  FrameRecord record;
  double vehicle_s_m{};
  double vehicle_speed_mps{};
  std::vector<IndexedObject> objects;
};

/// The sequence of one of a scenario's sensors.
struct IndexedSequence {
  Json record;  ///< Its part of the scenario's line.
  std::vector<IndexedFrame> frames;
};

/// A scenario's line of scenarios.jsonl and its sequences.
struct IndexedScenario {
  Json record;
  std::vector<IndexedSequence> sequences;
};

/// Reads a scenario and the records of its sequences.
/// @param record Its line of scenarios.jsonl.
/// @throws InputError if a file of the sequence cannot be read or is damaged.
[[nodiscard]] IndexedScenario ReadIndexedScenario(const std::filesystem::path& dataset,
                                                  Json record);

/// Lines of index.jsonl, one for each frame.
[[nodiscard]] std::string IndexLines(const IndexedScenario& scenario);

}  // namespace railcast
