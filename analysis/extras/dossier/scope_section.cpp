#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "analysis/extras/dossier/dossier_report.h"
#include "analysis/extras/study/study_factors.h"
#include "analysis/report/words.h"
#include "core/base/text.h"
#include "core/extras/recipe/json_place.h"

namespace railcast {

extern const char* const kOddAxes;

namespace {

constexpr const char* kObjectPrefix = "object ";

double ToThousandth(double value) {
  constexpr double kSteps = 1e3;
  return std::round(value * kSteps) / kSteps;
}

/// The values of something that a recipe draws.
struct DrawnValues {
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();
  std::map<std::string, std::uint64_t> others;  ///< How often, by value.

  void Add(const Json& value) {
    if (value.is_number()) {
      least = std::min(least, value.get<double>());
      greatest = std::max(greatest, value.get<double>());
    } else {
      ++others[value.is_string() ? value.get<std::string>() : value.dump()];
    }
  }
  [[nodiscard]] bool is_one() const { return others.size() + (least < greatest ? 2 : 0) < 2; }
  [[nodiscard]] std::string InWords() const {
    constexpr std::size_t kMostShown = 8;
    std::string text;
    if (least <= greatest) text = NumberText(ToThousandth(least));
    if (least < greatest) text += " to " + NumberText(ToThousandth(greatest));
    std::size_t num_shown = 0;
    for (const auto& [value, count] : others) {
      if (++num_shown > kMostShown) {
        return text + " and " + NumberText(others.size() - kMostShown) + " more";
      }
      if (!text.empty()) text += ", ";
      text += value + " (" + NumberText(count) + ")";
    }
    return text;
  }
};

using DrawnByName = std::map<std::string, DrawnValues>;

DrawnByName DrawnIn(const std::vector<ApproachRecord>& approaches) {
  DrawnByName drawn;
  for (const ApproachRecord& approach : approaches) {
    drawn["base"].Add(approach.base);
    for (const auto& [name, value] : approach.drawn) drawn[name].Add(value);
    for (const StudiedObject& object : approach.objects) {
      drawn["object /type"].Add(object.type);
      drawn["speed_kmph"].Add(ToThousandth(3.6 * object.speed_mps));
      for (const auto& [name, value] : object.drawn) {
        drawn[std::string(kObjectPrefix) + name].Add(value);
      }
    }
  }
  return drawn;
}

bool ChangesAny(const std::string& name, const std::vector<std::string>& keys, const Json& recipe) {
  const std::set<std::string> changed = DrawnKeys(name, recipe);
  return std::ranges::any_of(keys, [&](const std::string& key) {
    return std::ranges::any_of(
        changed, [&](const std::string& pointer) { return LiesWithin(pointer, key); });
  });
}

// What a scenario says at some keys that have values of their own: "rain_rate_mmph 0, tracks: 2".
std::string ValuesIn(const Json& scenario, const std::vector<std::string>& keys) {
  std::string text;
  for (const std::string& key : keys) {
    if (!key.starts_with('/') || !scenario.contains(Json::json_pointer(key))) continue;
    const Json& value = scenario[Json::json_pointer(key)];
    if (value.is_object()) continue;
    text += (text.empty() ? "" : ", ") + key.substr(key.rfind('/') + 1);
    if (value.is_array()) {
      text += ": " + NumberText(value.size());
    } else {
      text += " " + (value.is_string() ? value.get<std::string>() : value.dump());
    }
  }
  return text;
}

}  // namespace

Section ScopeSection(const FinishedStudy& study, const std::vector<ScenarioSpec>& sample) {
  const DrawnByName drawn = DrawnIn(study.result.approaches);
  const Json scenario = Json::parse(ResolvedScenarioJson(sample.front()));
  Table table = TableOf(kDossierWords, "scope");
  for (const Json& axis : Json::parse(kOddAxes)) {
    const auto keys = axis.at("keys").get<std::vector<std::string>>();
    bool is_varied = false;
    std::string values;
    for (const auto& [name, of_name] : drawn) {
      if (!ChangesAny(name, keys, study.recipe)) continue;
      is_varied = is_varied || !of_name.is_one();
      values += (values.empty() ? "" : "; ") + name + ": " + of_name.InWords();
    }
    if (values.empty()) values = ValuesIn(scenario, keys);
    table.rows.push_back({axis.at("group").get<std::string>(), axis.at("axis").get<std::string>(),
                          std::string(is_varied ? "yes" : "no"), values});
  }
  Section section = SectionOf(kDossierWords, "scope");
  section.tables = {std::move(table)};
  return section;
}

}  // namespace railcast
