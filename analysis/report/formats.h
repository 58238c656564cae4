#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "analysis/report/report.h"

namespace railcast {

// The file formats of a report.

/// JSON for programs. Estimates are {"value", "low", "high", "samples"}; a figure that is absent or
/// had too few samples is null.
/// @param details A JSON object whose members follow the report's own.
[[nodiscard]] std::string ReportJson(const Report& report, const std::string& details = "{}");

/// A table as CSV (RFC 4180, but lines end in \n) with a header of the columns' keys. A column with
/// estimates becomes four: key, key_low, key_high, key_samples. Absent figures are empty.
[[nodiscard]] std::string TableCsv(const Table& table);

/// Text for the terminal: everything but the charts, with tables in aligned columns.
[[nodiscard]] std::string ReportText(const Report& report);

/// Markdown for the README of a folder that has the report's charts/ and csv/ beside it. Tables
/// that are not open are links to their files.
[[nodiscard]] std::string ReportMarkdown(const Report& report);

/// The headlines only, one per line.
[[nodiscard]] std::string HeadlinesText(const Report& report);

/// Splits the columns of a table that is too wide into blocks of at most `max_width` that each
/// begin with the first column.
[[nodiscard]] std::vector<std::vector<std::size_t>> BlocksOf(const std::vector<std::size_t>& widths,
                                                             std::size_t max_width);

/// One self-contained HTML page, in light and dark, that needs no network and no script; on paper
/// all sections are unfolded.
/// @param drawn Charts and pictures by key (DrawAll()).
[[nodiscard]] std::string ReportPage(const Report& report,
                                     const std::map<std::string, std::string>& drawn);

/// Layout of a table's column in the page.
struct PageColumn {
  bool is_number = false;
  /// Estimates take three cells, so that figures, intervals and counts are aligned.
  bool has_estimates = false;
};

[[nodiscard]] std::vector<PageColumn> PageColumns(const Table& table);

/// Whether a text has a word, such as a path, that is broken where its column is narrow.
[[nodiscard]] bool HasLongWord(const std::string& text);

/// The columns of a table that fit beside each other: one block if all do, else several that begin
/// with the first column. A table longer than a page of paper is one block, which is scrolled.
[[nodiscard]] std::vector<std::vector<std::size_t>> TableBlocks(const Table& table);

/// Keys of the tables that are printed, so that the report has about ten pages of A4 at most: open
/// ones before folded ones, in their order, as long as there is room. A table that would take more
/// than a page is left to its file.
[[nodiscard]] std::set<std::string> TablesOnPaper(const Report& report);

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
