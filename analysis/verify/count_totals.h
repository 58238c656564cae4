#pragma once

#include <string>

#include "core/base/error.h"
#include "core/io/strict_json.h"

namespace railcast {

/// Sums the counts of each frame in frames.jsonl, for comparison with the manifest's totals.
class CountTotals {
 public:
  /// @param line A line of frames.jsonl.
  /// @throws StrictJson::exception if it has no counts.
  void Add(const StrictJson& line);

  /// Adds a fault for every total that differs: "place: points: must be 7, ... (got 8)".
  void Compare(const StrictJson& manifest, const std::string& place, ErrorList& faults) const;

 private:
  StrictJson sums_ = {{"points", 0U},
                      {"outcomes", StrictJson::object()},
                      {"points_per_label", StrictJson::object()}};
};

}  // namespace railcast
