#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/extras/recipe/dataset_record.h"
#include "core/extras/recipe/dataset_report_record.h"
#include "core/extras/recipe/recipe.h"
#include "core/extras/recipe/split_quota.h"
#include "core/scenario/json_text.h"
#include "generator/extras/dataset/indexed_scenario.h"

namespace railcast {

/// Counts what the scenarios of a data set are, which is known before any frame is made.
class ScenarioReport {
 public:
  void Add(const ScenarioRecord& record);

  /// The members `weathers` and `drawn` of report.json.
  [[nodiscard]] const CountsByName& weathers() const { return weathers_; }
  [[nodiscard]] const std::map<std::string, CountsByName>& drawn() const { return drawn_; }
  /// report.json of scenarios without frames: parts, bases, weathers, words drawn, objects placed.
  [[nodiscard]] Json Write(const SplitSpec& split) const;
  /// The same for readers.
  [[nodiscard]] std::string Text(const SplitSpec& split) const;

 private:
  PerPart<std::uint32_t> parts_{};
  CountsByName bases_;
  CountsByName weathers_;
  CountsByName placed_;                        ///< Objects, by their names in the recipe.
  std::map<std::string, CountsByName> drawn_;  ///< Words, by draw.
};

/// A line for each part: "train   17 scenarios, 70.8 % (asked for: 70.0 %)".
[[nodiscard]] std::string PartsText(const PerPart<std::uint32_t>& parts, const SplitSpec& split);

/// Counts what a data set holds: balance of the classes, objects by distance and occlusion,
/// weathers, frames that are the same or hold nothing.
class DatasetReport {
 public:
  void Add(const IndexedScenario& scenario);

  /// report.json.
  [[nodiscard]] DatasetReportRecord Record();

 private:
  void AddFrame(const IndexedFrame& frame, SplitCountsRecord& split);
  void AddObject(const IndexObjectRecord& object);
  [[nodiscard]] std::uint64_t NumDuplicates();

  ScenarioReport scenarios_;
  DatasetReportRecord record_;
  /// One for each frame that has files, of the hashes of its files: of 10 million frames, two that
  /// differ have the same with a probability of 3e-6.
  std::vector<std::uint64_t> frame_hashes_;
};

}  // namespace railcast
