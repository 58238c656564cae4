#pragma once

#include <string>

#include "core/base/error.h"
#include "core/io/strict_json.h"

namespace railcast {

/// Sums up what frames.jsonl counts of each frame, to be compared with the manifest's totals.
class CountTotals {
 public:
  /// @param line Of frames.jsonl. @throws StrictJson::exception if it has no counts.
  void Add(const StrictJson& line);

  /// A fault for every total that is another: "place: points: must be 7, ... (got 8)".
  void Compare(const StrictJson& manifest, const std::string& place, ErrorList& faults) const;

 private:
  StrictJson sums_ = {{"points", 0U},
                      {"outcomes", StrictJson::object()},
                      {"points_per_label", StrictJson::object()}};
};

}  // namespace railcast
