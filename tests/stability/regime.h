#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <string>

namespace railcast {

/// A number with two significant digits.
inline std::string TwoDigits(double value) {
  const double size = std::abs(value);
  const int places = size > 0.0 ? 1 - static_cast<int>(std::floor(std::log10(size))) : 0;
  char text[32];
  std::snprintf(text, sizeof(text), "%.*f", std::clamp(places, 0, 9), value);
  return text;
}

/// Records a row of docs/results/where_methods_fail.md, which scripts/dev/measure_results.py reads
/// from the report of this program: what the simple method does in a regime and what railcast does
/// on every rung; or what one ray a beam, the rung `footprint` and the rung `reference` do.
inline void RecordRegime(const std::string& regime, std::initializer_list<std::string> cells) {
  std::string text;
  for (const std::string& cell : cells) text += (text.empty() ? "" : " | ") + cell;
  testing::Test::RecordProperty("regime: " + regime, text);
}

}  // namespace railcast
