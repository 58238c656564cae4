#pragma once

#include <nlohmann/json.hpp>

#include "generator/frame_record.h"

namespace railcast {

/// Members `points`, `outcomes` and `points_per_label`, as frames.jsonl and manifest.json have
/// them.
inline void PutCounts(const FrameCounts& counts, nlohmann::ordered_json& object) {
  nlohmann::ordered_json outcomes = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < kOutcomeNames.size(); ++i) {
    outcomes[std::string(kOutcomeNames[i])] = counts.outcomes[i];
  }
  object["points"] = counts.points;
  object["outcomes"] = outcomes;
  object["points_per_label"] = counts.points_per_label;
}

}  // namespace railcast
