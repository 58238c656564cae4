#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/detect/base/detect_tile.h"
#include "core/detect/kernels/kernels.h"
#include "railcast/effects.h"
#include "railcast/frame.h"

namespace railcast {

/// One loop of the detector over a tile.
struct EffectStep {
  std::string_view effect;  ///< Its name in the explanation of a firing.
  std::function<void(DetectTile&)> apply;
};

/// The order of the detector's loops over a tile, which is that of the physical processes. The loop
/// of a new effect gets an enumerator of its own; loops with the same one run in the order of the
/// table.
enum class StepOrder {
  // Surface and air: every component of a wide beam passes through these on its own.
  kSurfaceResponse,
  kPulseStretch,
  kExtinction,
  // Receiver.
  kHit,
  kThreshold,
  kSensorDropout,  ///< Before weather: of a lost pulse neither surface nor snow is seen.
  kRain,
  kSnow,
  kSunlight,
  kCover,
  kDetection,
  kCoverBlame,
  kRangeWalk,
  kIntensity,
  kSaturation,
  kMeasurement,
};

/// A loop that an effect adds to the detector.
struct EffectLoop {
  StepOrder order{};
  std::function<void(DetectTile&)> (*make)(const DetectorSpec& spec, const Kernels& kernels);
};

/// The label of echoes that an effect adds and no surface sends.
struct EffectLabel {
  const char* name;  ///< In the table of labels.
  std::uint32_t ClutterLabels::*id;
  /// Whether the table must have it while the effect is on; null: where the effect has a cause.
  bool (*is_needed)(const DetectorSpec& spec) = nullptr;
};

/// Everything that the program knows about one effect.
struct Effect {
  const char* name;             ///< Name in scenarios and reports.
  bool EffectSet::*is_on;       ///< The effect's switch.
  std::vector<Fidelity> rungs;  ///< The rungs that include the effect.
  /// Whether the effect can change anything with this spec: `rain` needs rain. Fidelity `auto` and
  /// the detector leave out effects without a cause. A reference, so that no effect can lack it.
  bool (&has_cause)(const DetectorSpec& spec);
  /// Describes its parameters and their consequences in this weather; null if it has none.
  std::string (*text)(const DetectorSpec& spec) = nullptr;
  /// The keys of section `weather` that it reads. `check` reports keys that no effect reads.
  std::vector<std::string_view> weather_keys{};
  std::vector<EffectLabel> labels{};  ///< Labels of the echoes that it adds.
  /// Empty if the effect acts elsewhere: in aiming and tracing beams, in the clutter or in the
  /// measurement.
  std::vector<EffectLoop> loops{};
  /// Instructions per firing on top of the other effects. Given for the effects whose need fidelity
  /// `auto` measures by comparing echoes; the others only change statistics, at little cost.
  ///
  /// Callgrind's counts of Simulator::Scan on frame 0 of scenarios/open_line.json in heavy rain,
  /// rung `footprint`, less those with it switched off (scripts/dev/measure_effect_costs.sh);
  /// 10 where the difference is less, since switching an effect off also changes the work of the
  /// others. Counts differ between scenes, but their order hardly does, and only the order matters.
  std::optional<double> instructions{};
  /// Whether it adds random errors to ranges or intensities after detection. Comparisons leave such
  /// effects out.
  bool is_measurement_error = false;
  /// Whether light of one beam's echoes reaches other beams, so that it needs the echoes of all.
  bool acts_between_beams = false;
  bool EffectSet::*needed = nullptr;    ///< Another effect that must be on with it, or null.
  bool EffectSet::*excluded = nullptr;  ///< Another effect that must be off with it, or null.
};

/// The table of all effects, in the order of scenario keys: first the published model, then the
/// effects of surfaces, air and receiver, then those of the sensor's window and stray light, then
/// those of the beam's width.
[[nodiscard]] const std::vector<Effect>& EffectTable();

// The four parts of the table, each in a file of its own.
[[nodiscard]] std::vector<Effect> PublishedEffects();
[[nodiscard]] std::vector<Effect> PhysicalEffects();
[[nodiscard]] std::vector<Effect> SensorEffects();
[[nodiscard]] std::vector<Effect> BeamEffects();

/// The effect of that name, or null.
[[nodiscard]] const Effect* FindEffect(std::string_view name);
/// The names of all effects, or of those that are on.
[[nodiscard]] std::vector<std::string> EffectNames();
[[nodiscard]] std::vector<std::string> EffectNames(const EffectSet& effects);

/// The effect that acts between beams, if it is on and has a cause; otherwise null.
[[nodiscard]] const Effect* EffectBetweenBeams(const DetectorSpec& spec);

/// The labels of the echoes that effects add. A label that no effect needs, and that the table
/// lacks, is 0.
/// @throws InputError if the table lacks a label that an effect needs.
[[nodiscard]] ClutterLabels ClutterLabelsOf(const LabelTable& labels, const DetectorSpec& spec);

/// Whether a rung of the fidelity ladder has the effect.
[[nodiscard]] bool IsInRung(const Effect& effect, Fidelity rung);
/// The effects of a rung.
[[nodiscard]] EffectSet EffectsInRung(Fidelity rung);
/// Whether any physical effect is on, that is one that the rung `plausibility` lacks.
[[nodiscard]] bool IsPhysical(const EffectSet& effects);

}  // namespace railcast
