#pragma once

#include <string>
#include <vector>

#include "analysis/frontier/measure.h"
#include "core/frame/labels.h"

namespace railcast {

/// What the numbers of a frontier hold for.
struct FrontierCircumstances {
  std::string version;   ///< Of railcast.
  std::string scenario;  ///< Its file.
  std::uint64_t seed{};
  float match_distance_m{};
  std::string choice_json;  ///< What fidelity auto would use.
  std::string date{};       ///< ReportDate().
  std::string scenario_hash{};
  std::string weather{};  ///< WeatherText().
};

/// frontier.json: all numbers and what they hold for.
[[nodiscard]] std::string FrontierJson(const FrontierPlan& plan,
                                       const FrontierCircumstances& circumstances,
                                       const LabelTable& labels,
                                       const std::vector<RowResult>& results);

/// frontier.csv: a line per row, times and errors in SI units; empty where a row has none.
[[nodiscard]] std::string FrontierCsv(const std::vector<RowResult>& results);

}  // namespace railcast
