#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "analysis/report/report.h"

namespace railcast {

/// Draws every chart of a report into `folder`, as KEY.svg and KEY.png, with one run of gnuplot,
/// and every picture as KEY.png.
/// @returns the SVGs of the charts and the PNGs of the pictures by their keys.
/// @throws InputError if gnuplot is not installed or fails.
std::map<std::string, std::string> DrawAll(const Report& report,
                                           const std::filesystem::path& folder);

/// Draws charts side by side as one picture, `picture` + ".svg" and ".png", and writes the script
/// that draws it, `picture` + ".gnuplot", which needs no other file and sets neither terminal nor
/// output.
/// @throws InputError as DrawAll() does; the script is written before.
void DrawSheet(const std::vector<Chart>& charts,
               const std::string& title,
               const std::filesystem::path& picture);

/// Adapts gnuplot's SVG to a page: black becomes the colour of the surrounding text
/// (`currentColor`), other colours are written as "#0072b2" so that a style sheet can find and
/// replace them, ids get the unique `prefix`, and titles, which browsers show as tooltips, are
/// removed.
[[nodiscard]] std::string CleanSvg(const std::string& gnuplot_svg, const std::string& prefix);

}  // namespace railcast
