#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

#include "analysis/report/report.h"

namespace railcast {

/// Concatenates pieces of text. (GCC 12 takes chains of + for overlapping copies and warns.)
[[nodiscard]] inline std::string Joined(std::initializer_list<std::string_view> pieces) {
  std::string text;
  for (const std::string_view piece : pieces) text += piece;
  return text;
}

/// Text of a cell for readers. An estimate of 12.3412 with an interval of +-0.44 becomes "12.34",
/// "[11.90, 12.78]", "n = 4,512": digits that the interval does not support are not shown.
struct CellText {
  std::string value;     ///< "-" if there is no figure, "not enough" if there were too few samples.
  std::string interval;  ///< Interval of an estimate that has one, else empty.
  std::string samples;   ///< Number of samples of an estimate, else empty.
  bool is_number = false;
  bool is_absent = false;  ///< Whether there is no figure.
};

[[nodiscard]] CellText TextOf(const Cell& cell);

/// All parts on one line: "12.34 [11.90, 12.78], n = 4,512" or "not enough (n = 3)".
[[nodiscard]] std::string LineOf(const CellText& text);

/// Text such as "20 to 30".
[[nodiscard]] std::string SpanText(const Span& span);

/// Formats 4512 as "4,512".
[[nodiscard]] std::string CountText(std::uint64_t count);

/// Text such as "Range (m)"; the title alone if there is no unit.
[[nodiscard]] std::string WithUnit(const std::string& title, const std::string& unit);

}  // namespace railcast
