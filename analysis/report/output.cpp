#include "analysis/report/output.h"

#include <iostream>
#include <set>
#include <string>
#include <system_error>

#include "analysis/report/draw.h"
#include "analysis/report/formats.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"
#include "core/program/command_line.h"

namespace railcast {
namespace {

// Checks the preconditions that report.h states.
void CheckSound(const Report& report) {
  std::set<std::string> drawings, tables;
  for (const Section& section : report.sections) {
    for (const Chart& chart : section.charts) {
      Check(drawings.insert(chart.key).second, "keys of charts are unique");
    }
    for (const Picture& picture : section.pictures) {
      Check(drawings.insert(picture.key).second, "keys of pictures are unique");
    }
    for (const Table& table : section.tables) {
      Check(tables.insert(table.key).second, "keys of tables are unique");
      for (const std::vector<Cell>& row : table.rows) {
        Check(row.size() == table.columns.size(), "a row has a cell for every column");
      }
    }
  }
}

void WriteTables(const Report& report, const std::filesystem::path& folder) {
  for (const Section& section : report.sections) {
    for (const Table& table : section.tables) {
      MakeFolders(folder);
      WriteFileWhole(folder / (table.key + ".csv"), TableCsv(table));
    }
  }
}

void WriteFiles(const Report& report,
                const std::filesystem::path& out,
                const std::string& name,
                const std::string& json) {
  MakeFolders(out);
  WriteFileWhole(out / name, json);
  WriteTables(report, out / "csv");
  // The drawings come last, so that everything else is written even without gnuplot.
  WriteFileWhole(out / "report.html", ReportPage(report, {}));
  WriteFileWhole(out / "report.html", ReportPage(report, DrawAll(report, out / "charts")));
}

}  // namespace

void AddReportOptions(CLI::App& command, ReportOutput& output) {
  CLI::Option_group* const where = command.add_option_group("Report");
  where
      ->add_option("--out", output.out,
                   "Directory for report.html, the same as JSON and CSV, and its charts")
      ->check(NonEmpty());
  where
      ->add_option_function<std::string>(
          "--format",
          [&output](const std::string& format) {
            output.is_text = format == "text";
            output.is_json = format == "json";
          },
          "text: print the report on the terminal; json: print it as JSON")
      ->check(CLI::IsMember({"text", "json"}));
  where->require_option(1, 0);
}

void EmitReport(const Report& report,
                const ReportOutput& output,
                std::string_view name,
                const std::string& details) {
  CheckSound(report);
  if (output.is_text) std::cout << ShownLines(ReportText(report)) << std::flush;
  if (output.is_json) std::cout << ReportJson(report, details) << std::flush;
  if (output.out.empty()) return;
  const std::string json = std::string(name) + ".json";
  WriteFiles(report, output.out, json, ReportJson(report, details));
  if (output.is_json) return;
  if (!output.is_text) std::cout << ShownLines(HeadlinesText(report));
  std::cout << "report.html, " << json << ", csv/ and charts/ in " << ShownPath(output.out) << "\n"
            << std::flush;
}

}  // namespace railcast
