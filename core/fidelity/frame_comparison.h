#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "core/detect/detect_spec.h"
#include "core/frame/frame.h"
#include "core/frame/labels.h"

namespace railcast {

/// How the frames of two effect sets are compared.
struct ComparisonSpec {
  /// Echoes of a firing may be the same if their ranges differ by less.
  float match_distance_m{};
  float range_max_m{};                     ///< The bins of range end here.
  std::vector<std::uint32_t> thin_labels;  ///< Of wires.
};

/// Half of the pulse's length: c pulse_length / 4, with 5 ns 0.375 m (two equal echoes part from
/// 0.64 m on). Thin labels are those of contact wires, messenger wires and droppers, as far as
/// the table has them.
[[nodiscard]] ComparisonSpec MakeComparisonSpec(const BeamSpec& beam,
                                                double range_max_m,
                                                const LabelTable& labels);

/// Pairs of (reference, other) indices that are the same echo: the nearest pair first, each echo
/// once, none farther apart than `match_distance_m` or as far.
/// @param reference_m, other_m Ranges of one firing's echoes.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> MatchEchoes(
    const std::vector<float>& reference_m,
    const std::vector<float>& other_m,
    float match_distance_m);

/// How many of a kind there are and how many of them the other side has, too.
struct Matched {
  std::uint64_t num{};
  std::uint64_t num_matched{};

  void Count(bool is_matched) {
    ++num;
    num_matched += is_matched ? 1 : 0;
  }
  /// In [0, 1]; 1 if there are none.
  [[nodiscard]] double share() const {
    return num == 0 ? 1.0 : static_cast<double>(num_matched) / static_cast<double>(num);
  }
  bool operator==(const Matched&) const = default;
};

/// Median and 95th percentile of absolute errors; NaN if there are none.
struct ErrorQuantiles {
  double median = std::numeric_limits<double>::quiet_NaN();
  double p95 = std::numeric_limits<double>::quiet_NaN();
};

/// By how much frames differ from the reference's.
struct FrameDifference {
  static constexpr std::size_t kNumRangeBins = 10;
  struct RangeBin {
    std::uint64_t num_firings{};
    std::uint64_t num_reference_returned{};
    std::uint64_t num_returned{};
  };

  // Surfaces' echoes only: drops, flakes and fog echo by the same draws on both sides, and would
  // hide what differs. Either may be matched by any echo.
  Matched reference_echoes;  ///< Their share() is the recall.
  Matched echoes;            ///< Of the other; their share() is the precision.
  // All echoes, clutter included.
  std::map<std::uint32_t, Matched> reference_echoes_per_label;  ///< By the reference's label.
  std::map<std::uint32_t, Matched> echoes_per_label;            ///< By the other's label.
  /// Of firings' strongest echoes in the reference that are matched.
  ErrorQuantiles range_m;
  ErrorQuantiles intensity;  ///< Relative, of the same where both have one.
  /// Equal bins up to range_max_m by the true range of the reference's first slot.
  std::array<RangeBin, kNumRangeBins> range_bins{};
  /// Mean over the bins with firings of the absolute difference in the share of firings with at
  /// least one return.
  double dropout_error{};
  /// The reference's echoes of wires with at least 2 % of the beam; matched by an echo of a wire.
  Matched thin;
  /// The reference's surface echoes with at least 5 % of the beam that are not the strongest.
  Matched further;
  /// The reference's firings with at least 5 % of the beam beside their main surface (0.5 m or more
  /// apart or in the sky); matched if the other's beam meets anything beside its main surface.
  Matched second;
};

/// Compares frames of the same scan under two effect sets and sums up.
class FrameComparison {
 public:
  explicit FrameComparison(ComparisonSpec spec) : spec_(std::move(spec)) {}

  /// @pre Both are the same frame of the same pattern; their numbers of returns may differ.
  void Add(const Frame& reference, const Frame& other);
  [[nodiscard]] FrameDifference Result() const;

 private:
  void AddFiring(const Frame& reference, const Frame& other, std::size_t firing);
  void AddMatched(const Frame& reference, std::size_t slot, const Frame& other, std::size_t match);
  void AddRangeBin(float true_range_m, bool has_reference_return, bool has_return);

  ComparisonSpec spec_;
  FrameDifference sums_;  // Its quantiles and its dropout error come last.
  std::vector<float> range_errors_m_;
  std::vector<float> intensity_errors_;
};

}  // namespace railcast
