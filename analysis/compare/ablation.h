#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/compare/beam_changes.h"
#include "analysis/compare/comparison.h"
#include "railcast/effects.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// What one effect changes in a scenario while all other effects stay as they are.
struct EffectStudy {
  std::string effect;
  bool is_in_scenario{};  ///< Otherwise the effect was switched on for the study.
  /// The rung on which it was studied, if it does not go together with the scenario's effects.
  std::optional<Fidelity> rung{};
  BeamChanges beams;
  Comparison clouds;  ///< A: without the effect, B: with it.
};

/// The effects that can be studied: each one that is compatible with the others once it is
/// switched.
[[nodiscard]] std::vector<std::string> StudiedEffects(const EffectSet& effects);

/// Which effects an ablation studies: those that go together with the scenario's, or all, where the
/// others are switched among the effects of the first rung that has them.
enum class StudyScope { kCompatible, kAll };

using AblationProgress = std::function<void(const std::string& what, double done)>;

/// Simulates frames with the scenario's effects and then with each studied effect switched.
/// All runs use the same random draws, so a beam that an effect leaves alone is bit-identical.
/// @param simulator Made from the scenario; its spec is restored afterwards.
[[nodiscard]] std::vector<EffectStudy> Ablate(Simulator& simulator,
                                              const std::vector<std::uint32_t>& frames,
                                              const std::vector<double>& distances_m,
                                              const AblationProgress& on_progress,
                                              StudyScope scope = StudyScope::kCompatible);

}  // namespace railcast
