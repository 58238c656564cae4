#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string_view>

#include "analysis/report/report.h"

namespace railcast {

/// Where a report goes: into files, onto the terminal, or both.
struct ReportOutput {
  std::filesystem::path out;  ///< Directory; empty: no files.
  bool is_text = false;       ///< Whether stdout gets the whole report.
};

/// Adds --out DIR and --format text, of which at least one must be given.
void AddReportOptions(CLI::App& command, ReportOutput& output);

/// Makes a directory and its parents, if they are not there.
/// @throws InputError if the system refuses.
void MakeFolder(const std::filesystem::path& folder);

/// Writes DIR/report.html, DIR/`name`.json, DIR/csv/TABLE.csv and DIR/charts/CHART.svg and .png,
/// and prints the report, or without --format text its headlines and where the files lie.
/// @throws InputError if a file cannot be written, or if gnuplot is missing: then the page has no
/// charts and all else is there.
void EmitReport(const Report& report, const ReportOutput& output, std::string_view name);

}  // namespace railcast
