#pragma once

#include <string>

#include "analysis/report/report.h"

namespace railcast {

/// A report for programs. Estimates are {"value", "low", "high", "samples"}; a figure that is
/// absent, or had not enough samples, is null.
[[nodiscard]] std::string ReportJson(const Report& report);

/// A table as CSV (RFC 4180, lines end in \n) with a header of the columns' keys. A column with
/// estimates is four: key, key_low, key_high, key_samples. What is absent is empty.
[[nodiscard]] std::string TableCsv(const Table& table);

}  // namespace railcast
