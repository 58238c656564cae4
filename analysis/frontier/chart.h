#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/frontier/measure.h"

namespace railcast {

/// The chart as a gnuplot script that needs no other file: four panels, time (logarithmic, in raw
/// traces) against the first four of kFrontierErrors, our rungs as one line, brute force as
/// another. It sets no terminal and no output.
[[nodiscard]] std::string ChartScript(const std::vector<RowResult>& results,
                                      const std::string& title);

/// Draws a script as PNG and SVG: `picture` + ".png", ".svg".
/// @throws InputError if gnuplot is not installed or fails.
void DrawChart(const std::filesystem::path& script, const std::filesystem::path& picture);

}  // namespace railcast
