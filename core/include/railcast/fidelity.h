#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "railcast/effects.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// How far frames deviate from those of the reference, in the quantities of ToleranceSpec.
struct Deviation {
  double range_m{};
  double missed_share{};
  double false_share{};
  double thin_missed_share{};
  double intensity{};  ///< Infinite if the echoes have no intensity.

  bool operator==(const Deviation&) const = default;
};

/// Returns whether every quantity is within its limit.
[[nodiscard]] bool IsWithin(const Deviation& deviation, const ToleranceSpec& tolerance);

/// The effects that fidelity `auto` selected, and the measurements behind the selection.
struct FidelityChoice {
  EffectSet effects;         ///< The selected effects.
  Deviation deviation;       ///< Deviation of `effects` on the sample frames.
  Deviation full_deviation;  ///< Deviation of the full candidate set on the sample frames.
  /// Whether `effects` is within tolerance on the sample frames. If false, the full set was not
  /// either.
  bool is_within_tolerance{};
  double instructions{};  ///< Estimated instructions per firing with `effects` (effect_search.h).
  double full_instructions{};  ///< The same estimate for the full candidate set.
  std::vector<std::uint32_t> sample_frames;
  /// Whether the reference has any echoes on the sample frames; if not, no effect was left out.
  bool has_echoes{};

  /// An effect whose necessity was measured.
  struct Measured {
    std::string effect;
    bool is_kept{};
    Deviation without;  ///< Deviation on the sample frames of all effects but this one.
  };
  std::vector<Measured> measured;
  /// Effects kept without measuring: those the user switched on, and statistical effects that have
  /// a cause in the scenario.
  std::vector<std::string> kept;
  /// Statistical effects left out without measuring, because nothing in the scenario causes them.
  std::vector<std::string> without_cause;

  /// A frame that took no part in the selection, and the deviation of the selected effects on it.
  struct HeldBack {
    std::uint32_t frame{};
    Deviation deviation;
    bool is_within_tolerance{};
  };
  std::vector<HeldBack> held_back;
};

/// Called before each of the many scans with the completed share of the work, in [0, 1].
using ChoiceProgress = std::function<void(double done)>;

/// Finds the cheapest set of effects that stays within the scenario's tolerance.
///
/// The effects of the rung `footprint` are searched on three sample frames (at 0, 1 and 2 s; closer
/// together where the track ends earlier), as effect_search.h describes, with the fixed costs of
/// the table of effects. The selection is then verified on three frames halfway between, which took
/// no part in it.
///
/// Effects that the user switches on or off stay as set. Cheap statistical effects
/// (`sensor_dropout`, `clutter`, `fog_echo`, `sunlight`, `range_noise`, `channel_bias`,
/// `pointing_jitter`), `mirror_paths` and the effects of the sensor itself (`cover`, `halo`,
/// `range_walk`, `interference`, `saturation`, `ghost`) are on if the scenario gives them a cause,
/// because no echo-by-echo comparison can judge them.
///
/// The comparison uses the returns of the scenario's own return mode, before range noise, with the
/// same random draws. The result depends on the scenario alone, not on the number of threads or on
/// any clock.
/// @param simulator Simulator of the scenario. Its spec is restored before the function returns;
///   the selection is not applied.
/// @pre The scenario's fidelity is `auto`.
[[nodiscard]] FidelityChoice ChooseFidelity(Simulator& simulator,
                                            const ScenarioSpec& scenario,
                                            const ChoiceProgress& on_progress);

/// As ChooseFidelity(), and applies the selected effects to the simulator, so that frames and
/// firing stories equal those of a run of the scenario.
/// @pre As ChooseFidelity().
FidelityChoice UseChosenFidelity(Simulator& simulator,
                                 const ScenarioSpec& scenario,
                                 const ChoiceProgress& on_progress);

}  // namespace railcast
