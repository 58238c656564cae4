#pragma once

#include <map>
#include <string>

#include "analysis/report/report.h"

namespace railcast {

/// A report as one page that needs no other file and no network, in light and dark, without any
/// script; on paper everything is unfolded. `svgs` are its charts by key (analysis/report/draw.h).
[[nodiscard]] std::string ReportPage(const Report& report,
                                     const std::map<std::string, std::string>& svgs);

}  // namespace railcast
