#pragma once

#include <map>
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
/// @param drawn Charts and pictures by key (analysis/report/draw.h).
[[nodiscard]] std::string ReportPage(const Report& report,
                                     const std::map<std::string, std::string>& drawn);

}  // namespace railcast
