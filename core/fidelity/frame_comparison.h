#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/fidelity/scene_parts.h"
#include "railcast/effects.h"
#include "railcast/frame.h"

namespace railcast {

/// The effects with which all others are compared: the rung `reference` with the effects of the
/// weather and of the sensor on.
[[nodiscard]] EffectSet YardstickEffects();

/// The effects without those that add random errors to ranges and intensities after detection
/// (`range_noise`, `channel_bias`, `intensity_noise`, `channel_gain` and the published `noise`), so
/// that comparisons show only differences between the models. All other random draws are the same
/// for the same seed.
[[nodiscard]] EffectSet WithoutRangeErrors(EffectSet effects);

/// How the frames of two effect sets are compared.
struct ComparisonSpec {
  /// Echoes of a firing can match if their ranges differ by less than this.
  float match_distance_m{};
  float range_max_m{};                     ///< Upper end of the last range bin.
  std::vector<std::uint32_t> thin_labels;  ///< Labels of wires.
  std::vector<std::uint32_t> person_labels{};
  std::vector<std::uint32_t> pole_labels{};  ///< Labels of poles, masts and signals.
  std::vector<ScenePart> parts{};            ///< FrameDifference::parts.
  std::vector<std::uint32_t> labels{};  ///< Labels of the echoes that are compared; empty = all.
};

/// Makes the spec of a comparison. The match distance is half of the pulse's length in range,
/// c pulse_length / 4: 0.375 m for 5 ns (two equal echoes are resolved from 0.64 m on). The thin
/// labels are those of contact wires, messenger wires and droppers, as far as the table has them,
/// and poles are those of `pole`, `mast` and `signal`. Classes of thin labels are no parts, because
/// thin echoes are compared by a rule of their own (FrameDifference::thin).
[[nodiscard]] ComparisonSpec MakeComparisonSpec(const BeamSpec& beam,
                                                double range_max_m,
                                                const LabelTable& labels,
                                                const std::vector<SceneObject>& objects);

/// The echoes of a firing: their slots and measured ranges.
struct FiringEchoes {
  FiringEchoes(const Frame& frame, std::size_t firing);

  std::vector<std::size_t> slots;
  std::vector<float> ranges_m;
};

/// Whether a slot has an echo of a surface, not of rain, snow and the like.
[[nodiscard]] bool IsSurfaceEcho(const Frame& frame, std::size_t slot);

/// Pairs of (reference, other) indices that are the same echo. The nearest pair is matched first,
/// each echo at most once, and only if the ranges differ by less than `match_distance_m`.
/// @param reference_m, other_m Ranges of one firing's echoes.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> MatchEchoes(
    const std::vector<float>& reference_m,
    const std::vector<float>& other_m,
    float match_distance_m);

/// Median and percentiles of absolute errors; NaN if there are no errors.
struct ErrorQuantiles {
  double median = std::numeric_limits<double>::quiet_NaN();
  double p95 = std::numeric_limits<double>::quiet_NaN();
  double p99 = std::numeric_limits<double>::quiet_NaN();
};

/// Numbers of points on targets of one kind by their range.
struct TargetPoints {
  static constexpr std::size_t kNumBins = 6;
  /// Width of a bin; the last one has no end.
  static constexpr float kBin_m = 50.0F;
  /// Bins with fewer points of the reference have no error: one point more would be 5 % of it.
  static constexpr std::uint64_t kLeastPoints = 20;
  struct Bin {
    std::uint64_t num_reference{};
    std::uint64_t num{};
  };
  std::array<Bin, kNumBins> bins{};

  /// The bin of a range; ranges must not be NaN.
  [[nodiscard]] static std::size_t BinOf(float range_m);
  /// Mean over the bins with enough points of |num / num_reference - 1|; NaN if there is none.
  [[nodiscard]] double Error() const;
};

/// The difference between frames and those of the reference.
struct FrameDifference {
  static constexpr std::size_t kNumRangeBins = 10;
  struct RangeBin {
    std::uint64_t num_firings{};
    std::uint64_t num_reference_returned{};
    std::uint64_t num_returned{};
  };

  // Only echoes of surfaces with ComparisonSpec::labels are counted: drops, flakes and fog use the
  // same random draws on both sides and would hide the differences. Any echo of the other side may
  // match them.
  Matched reference_echoes;  ///< Echoes of the reference; share() is the recall.
  Matched echoes;            ///< Echoes of the other frames; share() is the precision.
  // These count all echoes, including clutter.
  std::map<std::uint32_t, Matched> reference_echoes_per_label;  ///< By the reference's label.
  std::map<std::uint32_t, Matched> echoes_per_label;            ///< By the other's label.
  /// Range errors of the firings' strongest echoes in the reference that are matched.
  ErrorQuantiles range_m;
  ErrorQuantiles intensity;  ///< Relative intensity errors of the same echoes where both have one.
  /// Bins of equal width up to range_max_m, by the true range of the reference's first slot.
  std::array<RangeBin, kNumRangeBins> range_bins{};
  /// Mean over the bins with firings of the absolute difference in the share of firings with at
  /// least one return.
  double dropout_error{};
  /// The reference's echoes of wires with at least 2 % of the beam; only echoes of wires match.
  Matched thin;
  /// The reference's surface echoes with at least 5 % of the beam that are not the strongest.
  Matched further;
  /// The reference's firings with at least 5 % of the beam off their main surface (0.5 m or more
  /// apart, or in the sky); matched if part of the other's beam is off its main surface as well.
  Matched second;
  /// The reference's firings with a step within the beam (core/fidelity/beam_steps.h); matched if
  /// the other's beam has one, too.
  Matched steps;
  /// Range errors of these firings' strongest echoes, whatever their distance.
  ErrorQuantiles step_range_m;
  /// Relative intensity errors of retroreflectors at edges: of firings with a step or a second
  /// surface whose strongest echo in the reference is brighter than any diffuse surface. 1 where
  /// the other has no echo.
  ErrorQuantiles bright_edges;
  TargetPoints persons;  ///< All echoes of persons, by their true range.
  TargetPoints poles;
  std::vector<PartDifference> parts;  ///< In the order of ComparisonSpec::parts.
};

/// Compares frames of the same scan under two effect sets and accumulates the differences.
class FrameComparison {
 public:
  explicit FrameComparison(ComparisonSpec spec) : spec_(std::move(spec)), parts_(spec_.parts) {}

  /// @pre Both are the same frame of the same pattern; their numbers of returns may differ.
  void Add(const Frame& reference, const Frame& other);
  /// Adds what happens at edges, for frames that Add() was given.
  /// @param reference_steps_m, other_steps_m By firing, as StepsOf() gives them.
  void AddEdges(const Frame& reference,
                const std::vector<float>& reference_steps_m,
                const Frame& other,
                const std::vector<float>& other_steps_m);
  [[nodiscard]] FrameDifference Result() const;

 private:
  /// Whether a slot has an echo that is compared.
  [[nodiscard]] bool IsCompared(const Frame& frame, std::size_t slot) const;
  void AddFiring(const Frame& reference, const Frame& other, std::size_t firing);
  void AddMatched(const Frame& reference, std::size_t slot, const Frame& other, std::size_t match);
  void AddTargets(const Frame& reference, const Frame& other);
  void AddRangeBin(float true_range_m, bool has_reference_return, bool has_return);

  ComparisonSpec spec_;
  PartsComparison parts_;
  FrameDifference sums_;  // Result() adds the quantiles and the dropout error.
  std::vector<float> range_errors_m_;
  std::vector<float> intensity_errors_;
  std::vector<float> step_errors_m_;
  std::vector<float> bright_errors_;
};

}  // namespace railcast
