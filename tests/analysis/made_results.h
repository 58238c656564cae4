#pragma once

#include <string>

#include "analysis/frontier/measure.h"

namespace railcast {

/// A row that takes `ratio` times the raw trace's 10 ms and misses so many of 100 echoes.
[[nodiscard]] inline RowResult MadeResult(const std::string& name,
                                          RowGroup group,
                                          double ratio,
                                          std::uint64_t num_missed) {
  RowResult result;
  result.row.name = name;
  result.row.group = group;
  result.times_ms = {10.0 * ratio};
  result.ratios = {ratio};
  if (group != RowGroup::kRawTrace) {
    RowErrors difference;
    difference.reference_echoes = {100, 100 - num_missed};
    result.difference = difference;
  }
  return result;
}

}  // namespace railcast
