#include "analysis/frontier/measure.h"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string_view>

#include "core/base/text.h"

namespace railcast {
namespace {

EffectSet With(EffectSet effects, bool EffectSet::*effect, bool is_on) {
  effects.*effect = is_on;
  return effects;
}

// With the central ray these are 4, 7, 19 and 64 rays per beam.
constexpr int kBruteForceSubRays[] = {3, 6, 18, 63};
constexpr int kReferenceSubRays[] = {16, 64, 256};

constexpr const char* kFootprintOf = "footprint_of";
// What most beams of a usual line meet, and few tasks ask about.
constexpr std::string_view kBackground[] = {"ground", "ballast", "sleeper", "slab_track",
                                            "road",   "grass",   "bush",    "tree"};

std::vector<std::uint32_t> Things(const LabelTable& labels) {
  std::vector<std::uint32_t> things;
  for (const Label& label : labels.labels()) {
    const bool is_thing = std::ranges::find(kBackground, label.name) == std::end(kBackground);
    if (is_thing) things.push_back(label.id);
  }
  std::ranges::sort(things);
  return things;
}

}  // namespace

RowSimulators::RowSimulators(const ScenarioSpec& scenario,
                             Simulator& full_detail,
                             const std::vector<FrontierRow>& rows)
    : full_detail_(full_detail) {
  for (const FrontierRow& row : rows) {
    const bool has_width = row.effects.footprint;
    if (!row.has_auto_detail() || auto_detail_.contains(has_width)) continue;
    ScenarioSpec coarser = scenario;
    coarser.world.detail = SceneDetail::kAuto;
    // A simulator chooses the detail when it is made, by the effects that it then has.
    coarser.fidelity = has_width ? Fidelity::kFootprint : Fidelity::kSurface;
    auto_detail_[has_width] = MakeSimulator(coarser, static_cast<int>(full_detail.num_threads()));
  }
}

Simulator& RowSimulators::Of(const FrontierRow& row) {
  return row.has_auto_detail() ? *auto_detail_.at(row.effects.footprint) : full_detail_;
}

void RowSimulators::UseThreads(int num_threads) {
  full_detail_.UseThreads(num_threads);
  for (auto& [has_width, simulator] : auto_detail_) simulator->UseThreads(num_threads);
}

void RowSimulators::BuildWindows(std::uint32_t frame) {
  static_cast<void>(full_detail_.Begin(frame));
  for (auto& [has_width, simulator] : auto_detail_) static_cast<void>(simulator->Begin(frame));
}

const char* RowGroupName(RowGroup group) {
  switch (group) {
    case RowGroup::kRawTrace:
      return "raw_trace";
    case RowGroup::kLadder:
      return "ladder";
    case RowGroup::kBetween:
      return "between";
    case RowGroup::kBruteForce:
      return "brute_force";
    case RowGroup::kChosen:
      return "chosen";
    case RowGroup::kAutoDetail:
      return "auto_detail";
    case RowGroup::kReference:
      break;
  }
  return "reference";
}

std::vector<FrontierRow> AllFrontierRows() {
  const EffectSet surface = EffectsOfRung(Fidelity::kSurface);
  const EffectSet footprint = EffectsOfRung(Fidelity::kFootprint);
  const EffectSet sampled_wires = With(footprint, &EffectSet::thin_conductors, false);
  const EffectSet surface_wires = With(surface, &EffectSet::thin_conductors, true);
  std::vector<FrontierRow> rows = {
      {"raw_trace", RowGroup::kRawTrace},
      {"geometry", RowGroup::kLadder, EffectsOfRung(Fidelity::kGeometry)},
      {"plausibility", RowGroup::kLadder, EffectsOfRung(Fidelity::kPlausibility)},
      {"surface", RowGroup::kLadder, surface},
      {"surface+thin_conductors", RowGroup::kLadder, surface_wires},
      {"footprint-thin_conductors", RowGroup::kBetween, sampled_wires},
      {kFootprintOf, RowGroup::kLadder, footprint},
      {"footprint_16", RowGroup::kLadder, footprint, {}, 16},
      {"footprint", RowGroup::kLadder, footprint},
      {"auto", RowGroup::kChosen},
      {"surface+thin_conductors+auto_detail", RowGroup::kAutoDetail, surface_wires},
      {"footprint_16+auto_detail", RowGroup::kAutoDetail, footprint, {}, 16},
      {"footprint+auto_detail", RowGroup::kAutoDetail, footprint},
  };
  for (const int sub_rays : kBruteForceSubRays) {
    rows.push_back({"brute_force_" + std::to_string(sub_rays + 1), RowGroup::kBruteForce,
                    With(sampled_wires, &EffectSet::dense_footprint, true), sub_rays});
  }
  for (const int sub_rays : kReferenceSubRays) {
    rows.push_back({"reference_" + std::to_string(sub_rays), RowGroup::kReference,
                    EffectsOfRung(Fidelity::kReference), sub_rays});
  }
  return rows;
}

std::vector<FrontierRow> ChooseFrontierRows(const std::string& names) {
  std::vector<FrontierRow> rows = AllFrontierRows();
  if (names == "all") return rows;
  std::vector<std::string> wanted = {"raw_trace"};
  std::istringstream list(names);
  for (std::string name; std::getline(list, name, ',');) {
    const auto is_called = [&](const FrontierRow& row) { return row.name == name; };
    if (std::none_of(rows.begin(), rows.end(), is_called)) {
      std::string line = "--rows: must be all, or of";
      for (const FrontierRow& row : rows) line += ' ' + row.name;
      throw InputError(line + " (got " + ShownText(name) + ")");
    }
    wanted.push_back(name);
  }
  std::erase_if(rows, [&](const FrontierRow& row) {
    return std::find(wanted.begin(), wanted.end(), row.name) == wanted.end();
  });
  return rows;
}

void UseChoice(const FidelityChoice& choice,
               const LabelTable& labels,
               std::vector<FrontierRow>& rows) {
  const std::vector<std::uint32_t> chosen = labels.Ids(choice.footprint_of, "/tolerance/of");
  for (FrontierRow& row : rows) {
    if (row.name == kFootprintOf) row.footprint_labels = chosen.empty() ? Things(labels) : chosen;
    if (row.group != RowGroup::kChosen) continue;
    row.effects = choice.effects;
    row.footprint_rays = choice.footprint_rays;
    row.footprint_labels = chosen;
  }
}

SimulatorSpec SpecOfRow(const FrontierRow& row, const SimulatorSpec& scenario) {
  SimulatorSpec spec = scenario;
  spec.detector.effects = row.effects;
  spec.detector.beam.footprint_rays = row.footprint_rays;
  spec.detector.footprint_labels = row.footprint_labels;
  if (row.sub_rays) spec.detector.beam.reference_rays = *row.sub_rays;
  spec.detector.plausibility.reference_threshold = 0.1;
  spec.detector.plausibility.reference_range_m = scenario.detector.receiver.range_at_10_percent_m;
  return spec;
}

}  // namespace railcast
