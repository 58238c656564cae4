#pragma once

#include <filesystem>
#include <string>

#include "analysis/report/report.h"

namespace railcast {

/// What a style sheet may repaint, beside the series' colours.
inline constexpr const char* kGridColor = "#dddddd";
inline constexpr const char* kMutedColor = "#767676";

/// gnuplot commands that draw a chart as an SVG, without title and on no background, and as a PNG
/// with both. A chart without a point says "not enough data".
[[nodiscard]] std::string DrawingOf(const Chart& chart,
                                    const std::filesystem::path& svg,
                                    const std::filesystem::path& png);

}  // namespace railcast
