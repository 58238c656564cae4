#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "analysis/report/report.h"

namespace railcast {

/// Draws every chart of a report into `folder`, as KEY.svg and KEY.png, with one run of gnuplot.
/// @returns the SVGs by their charts' keys.
/// @throws InputError if gnuplot is not installed or fails.
std::map<std::string, std::string> DrawCharts(const Report& report,
                                              const std::filesystem::path& folder);

}  // namespace railcast
