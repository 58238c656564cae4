#include "analysis/report/output.h"

#include <array>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>
#include <vector>

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
      Check(chart.caption.text.ends_with('.'),
            ("the caption of chart " + chart.key + " is a sentence that says what to see").c_str());
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

// Whether two rows are of the same group: equal in all of their words.
bool AreOneGroup(const std::vector<Cell>& a, const std::vector<Cell>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto* const word = std::get_if<std::string>(&a[i]);
    const auto* const other = std::get_if<std::string>(&b[i]);
    if (word != nullptr && (other == nullptr || *word != *other)) return false;
  }
  return true;
}

// The row of the bins that are missing between two rows, if any are.
std::optional<std::vector<Cell>> RowBetween(const std::vector<Cell>& a,
                                            const std::vector<Cell>& b) {
  if (!AreOneGroup(a, b)) return std::nullopt;
  bool is_gap = false;
  std::vector<Cell> row = a;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::holds_alternative<std::string>(a[i])) continue;
    row[i] = std::numeric_limits<double>::quiet_NaN();
    const auto* const before = std::get_if<Span>(&a[i]);
    const auto* const after = std::get_if<Span>(&b[i]);
    if (before == nullptr || after == nullptr) continue;
    if (after->low <= before->high) return std::nullopt;
    row[i] = Span{before->high, after->low};
    is_gap = true;
  }
  return is_gap ? std::optional(std::move(row)) : std::nullopt;
}

// Bins without data get a row, one for all that follow each other.
void MarkMissingBins(Table& table) {
  std::vector<std::vector<Cell>> rows;
  for (std::vector<Cell>& row : table.rows) {
    if (!rows.empty()) {
      if (auto between = RowBetween(rows.back(), row)) rows.push_back(std::move(*between));
    }
    rows.push_back(std::move(row));
  }
  table.rows = std::move(rows);
}

void WriteTables(const Report& report, const std::filesystem::path& folder) {
  for (const Section& section : report.sections) {
    for (const Table& table : section.tables) {
      MakeFolders(folder);
      WriteFileWhole(folder / (table.key + ".csv"), TableCsv(table));
    }
  }
}

// Removes the tables and drawings of the report that is replaced; its keys have no folders.
void RemoveEarlier(const std::filesystem::path& out, const std::string& name) {
  std::error_code ignored;
  if (!std::filesystem::exists(out / name, ignored)) return;
  constexpr std::array<std::array<const char*, 3>, 4> kFiles = {{{"tables", "csv", ".csv"},
                                                                 {"charts", "charts", ".svg"},
                                                                 {"charts", "charts", ".png"},
                                                                 {"pictures", "charts", ".png"}}};
  try {
    const auto report = nlohmann::json::parse(ReadFileWhole(out / name));
    for (const auto& section : report.at("sections")) {
      for (const auto& [kind, folder, ending] : kFiles) {
        for (const auto& each : section.value(kind, nlohmann::json::array())) {
          const std::filesystem::path key = each.at("key").get<std::string>();
          std::filesystem::remove(out / folder / (key.filename().string() + ending), ignored);
        }
      }
    }
  } catch (const nlohmann::json::exception&) {  // Another file of this name tells nothing.
  }
}

void WriteFiles(const Report& report,
                const std::filesystem::path& out,
                const std::string& name,
                const std::string& json) {
  MakeFolders(out);
  RemoveEarlier(out, name);
  WriteFileWhole(out / name, json);
  WriteTables(report, out / "csv");
  // The drawings come last, so that everything else is written even without gnuplot.
  WriteFileWhole(out / "report.html", ReportPage(report, {}));
  WriteFileWhole(out / "report.html", ReportPage(report, DrawAll(report, out / "charts")));
}

}  // namespace

void AddReportOptions(ProgramOptions& command, ReportOutput& output) {
  ProgramOptions where = command.AddOneOf("Report");
  where
      .AddOption("--out", output.out,
                 "Directory for report.html, the same as JSON and CSV, and its charts")
      .Check(NonEmpty());
  where
      .AddText(
          "--format",
          [&output](const std::string& format) {
            output.is_text = format == "text";
            output.is_json = format == "json";
          },
          "text: print the report on the terminal; json: print it as JSON")
      .Check(Named({"text", "json"}));
}

void CheckReportFolder(const std::filesystem::path& out, std::vector<std::string> own) {
  if (out.empty()) return;
  CheckIsOutside("--out", out);
  own.insert(own.end(), {"report.html", "csv", "charts"});
  RefuseLinks(out, own);
  std::error_code ignored;
  const bool is_new = !std::filesystem::exists(out, ignored);
  MakeFolders(out);
  CheckCanWrite(out / "report.html");
  if (is_new) std::filesystem::remove(out, ignored);
}

void EmitReport(Report report,
                const ReportOutput& output,
                std::string_view name,
                const std::string& details) {
  CheckSound(report);
  for (Section& section : report.sections) {
    for (Table& table : section.tables) MarkMissingBins(table);
  }
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
