#pragma once

#include <cstdint>
#include <string>

#include "analysis/report/report.h"

namespace railcast {

/// What people read of a cell. An estimate of 12.3412 with an interval of +-0.44 is "12.34",
/// "[11.90, 12.78]", "n = 4,512": digits that its interval does not support are not shown.
struct CellText {
  std::string value;     ///< Also "-" where there is none, "not enough" where samples lacked.
  std::string interval;  ///< Of estimates that have one; else empty.
  std::string samples;   ///< Of estimates; else empty.
  bool is_number = false;
  bool is_absent = false;  ///< Nothing was found out.
};

[[nodiscard]] CellText TextOf(const Cell& cell);

/// All of it in one line: "12.34 [11.90, 12.78], n = 4,512"; "not enough (n = 3)".
[[nodiscard]] std::string LineOf(const CellText& text);

/// 4512 as "4,512".
[[nodiscard]] std::string CountText(std::uint64_t count);

/// "Range (m)"; without a unit the title alone.
[[nodiscard]] std::string WithUnit(const std::string& title, const std::string& unit);

}  // namespace railcast
