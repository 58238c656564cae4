#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "analysis/limits/limit_sections.h"
#include "core/scenario/json_text.h"

namespace railcast {

extern const char* const kLimits;

Section LimitsSection(const std::vector<ScenarioSpec>& sample, bool has_detector) {
  std::set<std::string> rungs;
  for (const ScenarioSpec& scenario : sample) {
    // What `auto` leaves out of its rung, the scene does not need.
    const bool is_auto = scenario.fidelity == Fidelity::kAuto;
    rungs.emplace(NameOf(is_auto ? Fidelity::kFootprint : scenario.fidelity));
  }
  Table table{.key = "limits",
              .title = "What differs from reality",
              .note =
                  "On the rungs of these scenarios; docs/effects.md and docs/world.md of railcast "
                  "have the rest.",
              .columns = ColumnsOf("real: In reality; model: Modelled; errs: Which way it errs"),
              .is_open = true};
  for (const Json& row : Json::parse(kLimits)) {
    const bool is_due = std::ranges::any_of(
        row.at("rungs"), [&](const Json& rung) { return rungs.contains(rung.get<std::string>()); });
    if (!is_due || (has_detector && row.value("without_detector", false))) continue;
    table.rows.push_back({row.at("real").get<std::string>(), row.at("model").get<std::string>(),
                          row.at("errs").get<std::string>()});
  }
  return {.key = "limits", .title = "What is not modelled", .tables = {std::move(table)}};
}

}  // namespace railcast
