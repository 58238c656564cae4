#include "analysis/frontier/row_simulators.h"

namespace railcast {

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

}  // namespace railcast
