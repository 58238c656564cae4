#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "railcast/effects.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// An error estimated from a sample of echoes.
struct SampledError {
  double value{};
  /// Lower end of its 95 % interval, so that a few echoes cannot exceed a limit by chance.
  double least{};

  bool operator==(const SampledError&) const = default;
};

/// The deviation in one part of the scene: in a range bin of 50 m, of a class of objects, or of an
/// object. Errors of ranges and intensities count for objects only: far away, on grazing ground and
/// among leaves, they exceed any useful tolerance even with all effects.
struct PartDeviation {
  std::string part;               ///< "50 to 100 m", or the name of the class or object.
  bool is_object{};               ///< Whether it is an object or a class of objects.
  std::uint64_t num_reference{};  ///< Echoes of the reference.
  std::uint64_t num{};            ///< Echoes of the compared frames.
  SampledError missed_share;
  SampledError false_share;
  SampledError range_m;    ///< Median.
  SampledError intensity;  ///< Median.

  bool operator==(const PartDeviation&) const = default;
};

/// How far frames deviate from those of the reference, in the quantities of ToleranceSpec.
struct Deviation {
  double range_m{};
  double missed_share{};
  double false_share{};
  double thin_missed_share{};
  double intensity{};  ///< Infinite if the echoes have no intensity.
  /// All parts of the scene, also those without echoes.
  std::vector<PartDeviation> parts{};

  bool operator==(const Deviation&) const = default;
};

/// Whether every quantity is within its limit: its value over all echoes, and, in every part of the
/// scene, the lower end of its interval (SampledError::least).
[[nodiscard]] bool IsWithin(const Deviation& deviation, const ToleranceSpec& tolerance);
/// The parts of the scene in which the lower end of a quantity's interval is beyond its limit.
[[nodiscard]] std::vector<PartDeviation> PartsBeyond(const Deviation& deviation,
                                                     const ToleranceSpec& tolerance);

/// The effects that fidelity `auto` selected, and the measurements behind the selection.
struct FidelityChoice {
  ToleranceSpec tolerance;  ///< The scenario's tolerance, for which the effects were selected.
  EffectSet effects;        ///< The selected effects.
  int footprint_rays{};     ///< The selected BeamSpec::footprint_rays.
  /// The selected BeamSpec::footprint_of: the scenario's own or, if that is empty, the classes of
  /// the tolerance: beams that cannot meet these need no width, as their echoes are not compared.
  std::vector<std::string> footprint_of{};
  /// The scenario's own scene detail, SimulatorSpec::has_full_detail, which is not searched for.
  bool has_full_detail{};
  Deviation deviation;       ///< Deviation of `effects` on the sample frames.
  Deviation full_deviation;  ///< Deviation of the full candidate set on the sample frames.
  /// Whether the selection is within tolerance on the sample frames. If false, the deviation of the
  /// full set was above 0.8 of the tolerance, and the deviation of the selection is larger by at
  /// most 0.2 of the tolerance.
  bool is_within_tolerance{};
  double instructions{};       ///< Estimated instructions per firing of the selection.
  double full_instructions{};  ///< The same estimate for the full candidate set.
  std::vector<std::uint32_t> sample_frames;
  /// Whether the reference has any echoes on the sample frames; if not, no effect was left out.
  bool has_echoes{};

  /// Something that costs time and whose necessity was measured.
  struct Measured {
    std::string what;  ///< The name of an effect, or "64 sub-rays".
    bool is_kept{};
    Deviation without;  ///< Deviation on the sample frames with all but this.
  };
  std::vector<Measured> measured;
  /// Effects kept without measuring: those the user switched on, `detection`, those that save next
  /// to nothing, and statistical effects that have a cause in the scenario.
  std::vector<std::string> kept;
  /// Effects left out without measuring, because nothing in the scenario causes them.
  std::vector<std::string> without_cause;

  /// A frame that took no part in the selection, and the deviation of the selected effects on it.
  struct HeldBack {
    std::uint32_t frame{};
    Deviation deviation;
    /// Whether it is within the tolerance or, if that is larger, within the deviation of all
    /// effects plus 0.2 of the tolerance.
    bool is_within_tolerance{};
  };
  std::vector<HeldBack> held_back;  ///< Empty if the run has only one frame.
};

/// Called before each of the many scans with the completed share of the work, in [0, 1].
using ChoiceProgress = std::function<void(double done)>;

/// Finds the cheapest selection that stays within the scenario's tolerance.
///
/// The effects of the rung `footprint`, and the number of its sub-rays, are searched on sample
/// frames: three that are spread over the run, and up to four in which objects are nearest or come
/// near (core/fidelity/sample_frames.h), as core/fidelity/effect_search.h describes, with the fixed
/// costs of the table of effects. The selection is then verified on three frames in between, which
/// took no part in it. A run of fewer than six frames has fewer sample frames and fewer frames to
/// verify with; a run of one frame has none to verify with.
///
/// Only what saves at least 1 % of all instructions is left out, so that chance does not decide
/// what hardly matters; `detection` is never left out. Effects that the user switches on or off
/// stay as set. Statistical effects, `mirror_paths` and the effects of the sensor itself (those
/// without Effect::instructions) are on if the scenario gives them a cause, because no echo-by-echo
/// comparison can judge them.
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
