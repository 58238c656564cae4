#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/frontier/measure.h"
#include "analysis/report/report.h"
#include "railcast/frame.h"

namespace railcast {

/// The words of frontiers (report/words.h).
extern const char* const kFrontierWords;

/// The circumstances under which the numbers of a frontier hold.
struct FrontierCircumstances {
  std::string version;   ///< Version of railcast.
  std::string scenario;  ///< Scenario file.
  std::uint64_t seed{};
  float match_distance_m{};
  std::string choice_json;  ///< The choice that fidelity auto would make, as JSON ...
  std::string choice_text;  ///< ... and in sentences, one per line.
  std::string date{};       ///< ReportDate().
  std::string scenario_hash{};
  std::string weather{};  ///< WeatherText().
};

/// Makes the report: charts of time against the first four of kFrontierErrors, then tables of all
/// errors, of the findings, and of the Pareto fronts; the same by range, class and object; what
/// scene detail `auto` changes; and what the scene needs.
/// @param command Command line, for a reader to repeat.
[[nodiscard]] Report MakeFrontierReport(const FrontierPlan& plan,
                                        const FrontierCircumstances& circumstances,
                                        const LabelTable& labels,
                                        const std::vector<RowResult>& results,
                                        const std::string& command);

/// The errors by range bin, class and object, and the detection distances of objects. Defined in
/// frontier_parts.cpp.
[[nodiscard]] Section PartsSection(const std::vector<RowResult>& results);

/// What scene detail `auto` changes, by class and range. Defined in
/// frontier_parts.cpp.
[[nodiscard]] Table DetailTable(const LabelTable& labels, const std::vector<RowResult>& results);
/// The same as a section; absent if no row has it.
[[nodiscard]] std::optional<Section> DetailSection(const FrontierPlan& plan,
                                                   const LabelTable& labels,
                                                   const std::vector<RowResult>& results);

/// Contents of frontier.json beside the report: all numbers and their circumstances. Defined in
/// frontier_json.cpp.
[[nodiscard]] std::string FrontierJson(const FrontierPlan& plan,
                                       const FrontierCircumstances& circumstances,
                                       const LabelTable& labels,
                                       const std::vector<RowResult>& results);

/// Contents of frontier.csv: one line per row, times in milliseconds and errors in SI units; a cell
/// is empty where a row has no such figure.
[[nodiscard]] std::string FrontierCsv(const std::vector<RowResult>& results);

}  // namespace railcast
