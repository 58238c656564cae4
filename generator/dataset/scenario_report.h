#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "core/scenario/json_text.h"
#include "generator/dataset/recipe.h"
#include "generator/dataset/split_quota.h"

namespace railcast {

/// Counts what the scenarios of a data set are, which is known before any frame is made.
class ScenarioReport {
 public:
  /// @param record What scenarios.jsonl says of a scenario (DrawnScenario).
  void Add(const Json& record);

  /// The members `weathers` and `drawn` of report.json.
  [[nodiscard]] Json Weathers() const { return weathers_; }
  [[nodiscard]] Json Drawn() const { return drawn_; }
  /// report.json of scenarios without frames: parts, bases, weathers, words drawn, objects placed.
  [[nodiscard]] Json Write(const SplitSpec& split) const;
  /// The same for readers.
  [[nodiscard]] std::string Text(const SplitSpec& split) const;

 private:
  using Counts = std::map<std::string, std::uint64_t>;

  PerPart<std::uint32_t> parts_{};
  Counts bases_;
  Counts weathers_;
  Counts placed_;                        ///< Objects, by their names in the recipe.
  std::map<std::string, Counts> drawn_;  ///< Words, by draw.
};

/// A line for each part: "train   17 scenarios, 70.8 % (asked for: 70.0 %)".
[[nodiscard]] std::string PartsText(const PerPart<std::uint32_t>& parts, const SplitSpec& split);

}  // namespace railcast
