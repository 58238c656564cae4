#pragma once

#include <string>

#include "analysis/report/report.h"

namespace railcast {

/// A report for the terminal: everything but the charts, tables in aligned columns.
[[nodiscard]] std::string ReportText(const Report& report);

/// Its headlines only, one a line.
[[nodiscard]] std::string HeadlinesText(const Report& report);

}  // namespace railcast
