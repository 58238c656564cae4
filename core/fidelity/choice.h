#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/detect/detect_spec.h"
#include "core/fidelity/deviation.h"
#include "core/scenario/scenario_spec.h"
#include "core/simulate/simulator.h"

namespace railcast {

/// What fidelity `auto` came to, and why.
struct FidelityChoice {
  EffectSet effects;           ///< To be used.
  Deviation deviation;         ///< Of `effects` on the sample frames.
  Deviation full_deviation;    ///< Of all effects that were chosen from, on the same.
  bool is_within_tolerance{};  ///< On the sample frames. If not, neither were all effects.
  double instructions{};       ///< Estimated, per firing, of `effects` (effect_costs.h).
  double full_instructions{};  ///< Of all effects that were chosen from.
  std::vector<std::uint32_t> sample_frames;
  bool has_echoes{};  ///< The reference has any there; if not, nothing was left out.

  /// An effect that was measured.
  struct Measured {
    std::string effect;
    bool is_kept{};
    Deviation without;  ///< Of all effects but this one, on the sample frames.
  };
  std::vector<Measured> measured;
  /// Kept without measuring: what the user switched on, and statistics that have a cause.
  std::vector<std::string> kept;
  /// Left out without measuring: statistics without a cause.
  std::vector<std::string> without_cause;

  /// Frames that had no part in the choice, and the chosen effects' deviation on each.
  struct HeldBack {
    std::uint32_t frame{};
    Deviation deviation;
    bool is_within_tolerance{};
  };
  std::vector<HeldBack> held_back;
};

/// Called before each scan of many. Shares of the whole, in [0, 1].
using ChoiceProgress = std::function<void(double done)>;

/// Finds the cheapest effects that stay within the scenario's tolerance.
///
/// On sample frames (3, at 0, 1 and 2 s; nearer where the track ends before) the effects of the
/// rung `footprint` are searched as effect_search.h says, by the fixed costs of effect_costs.h.
/// Then the choice is measured on frames that had no part in it (3, halfway between).
///
/// What the user switches on or off stays so. Effects that change statistics at little cost
/// (`sensor_dropout`, `clutter`, `fog_echo`, `sunlight`, `range_noise`, `channel_bias`,
/// `pointing_jitter`) are on if they have a cause: no comparison echo by echo can judge them.
///
/// Compared are the returns of the scenario's own return mode, before range noise, with the same
/// draws. A function of the scenario alone: neither of the number of threads, nor of the clock.
/// @param simulator The scenario's; its spec is afterwards what it was, not the choice.
/// @pre The scenario's fidelity is `auto`.
[[nodiscard]] FidelityChoice ChooseFidelity(Simulator& simulator,
                                            const ScenarioSpec& scenario,
                                            const ChoiceProgress& on_progress);

/// Makes the choice, too, and has the simulator use its effects: frames and stories are then those
/// that a run of the scenario gives.
/// @pre As ChooseFidelity().
FidelityChoice UseChosenFidelity(Simulator& simulator,
                                 const ScenarioSpec& scenario,
                                 const ChoiceProgress& on_progress);

}  // namespace railcast
