#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "analysis/compare/beam_changes.h"
#include "analysis/compare/comparison.h"
#include "core/scenario/scenario_spec.h"
#include "core/simulate/simulator.h"

namespace railcast {

/// What one effect changes in a scenario, all others being as they are.
struct EffectStudy {
  std::string effect;
  bool is_in_scenario{};  ///< Else it was switched on for the study.
  BeamChanges beams;
  Comparison clouds;  ///< A: without the effect, B: with it.
};

/// The effects that can be studied: each that goes together with the others once it is switched.
[[nodiscard]] std::vector<std::string> StudiedEffects(const EffectSet& effects);

using AblationProgress = std::function<void(const std::string& what, double done)>;

/// Simulates frames with the scenario's effects and then with each of StudiedEffects() switched,
/// with the same draws: beams that an effect leaves alone are the same in every bit.
/// @param simulator The scenario's; its spec is what it was afterwards.
[[nodiscard]] std::vector<EffectStudy> Ablate(Simulator& simulator,
                                              const std::vector<std::uint32_t>& frames,
                                              const std::vector<double>& distances_m,
                                              const AblationProgress& on_progress);

}  // namespace railcast
