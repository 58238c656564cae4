#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "analysis/report/report.h"
#include "core/program/options.h"

namespace railcast {

/// Destination of a report: files, the terminal, or both.
struct ReportOutput {
  std::filesystem::path out;  ///< Directory; no files are written if empty.
  bool is_text = false;       ///< Whether the whole report is printed to stdout.
  bool is_json = false;       ///< Whether it is printed as JSON, and nothing else is.
};

/// Adds --out DIR and --format text or json, of which at least one must be given.
void AddReportOptions(ProgramOptions& command, ReportOutput& output);

/// To be called when a command begins, before hours of work: checks that a report can be written to
/// a folder, and is to be outside of those of CheckIsOutside(). Leaves
/// no folder but those above it.
/// @param out Nothing is checked if it is empty.
/// @param own Names of what the command writes beside the page and the folders of EmitReport().
/// @throws InputError if it cannot or must not, or as RefuseLinks().
void CheckReportFolder(const std::filesystem::path& out, std::vector<std::string> own);

/// Writes DIR/report.html, DIR/`name`.json, DIR/csv/TABLE.csv and DIR/charts/CHART.svg and .png,
/// and prints the report or, without --format, its headlines and the paths of the files. Tables and
/// drawings that DIR/`name`.json of an earlier report names are removed before.
/// @param details A JSON object whose members are added to the JSON.
/// @throws InputError if a file cannot be written, or if gnuplot is missing: then the page has no
///   charts, but everything else is written.
void EmitReport(Report report,
                const ReportOutput& output,
                std::string_view name,
                const std::string& details = "{}");

}  // namespace railcast
