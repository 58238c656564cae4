#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/base/error.h"

namespace railcast {

/// Sums up what frames.jsonl counts of each frame, to be compared with the manifest's totals.
class CountTotals {
 public:
  /// @param line Of frames.jsonl. @throws nlohmann::json::exception if it has no counts.
  void Add(const nlohmann::json& line);

  /// A fault for every total that is another: "place: points: must be 7, ... (got 8)".
  void Compare(const nlohmann::json& manifest, const std::string& place, ErrorList& faults) const;

 private:
  nlohmann::json sums_ = {{"points", 0U},
                          {"outcomes", nlohmann::json::object()},
                          {"points_per_label", nlohmann::json::object()}};
};

}  // namespace railcast
