#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/compare/patches.h"
#include "analysis/estimate/estimate.h"
#include "core/io/run/dataset_files.h"

namespace railcast {

/// Patches of pairs of frames, for a classifier. Their number does not grow with the recordings:
/// of long ones, every second pair is kept, or every fourth, and so on.
class PatchPairs {
 public:
  struct Pair {
    std::vector<Patch> a, b;
  };
  void Add(Pair pair);

  [[nodiscard]] const std::vector<Pair>& pairs() const { return pairs_; }
  [[nodiscard]] std::uint64_t stride() const { return stride_; }
  [[nodiscard]] std::uint64_t num_a() const;
  [[nodiscard]] std::uint64_t num_b() const;

 private:
  std::vector<Pair> pairs_;
  std::uint64_t num_seen_{}, stride_ = 1;
};

/// How well patches of B can be told from patches of A. All are "not enough" below kMinPatches of
/// A or of B, or kMinSamples pairs.
struct ToldApart {
  static constexpr std::uint64_t kMinPatches = 100;

  /// Area under the curve: the probability that a patch of B looks more like B than one of A does.
  Estimate area;
  Estimate balanced_accuracy;
  /// Of a classifier that does not see intensities. "Not enough" if there are none, too.
  Estimate shape_area;
  std::array<Estimate, kNumDistanceBins> area_by_range;

  struct Feature {
    std::size_t index{};  ///< In kPatchFeatures.
    Estimate lost_area;   ///< Without the feature, its importance.
    /// Of the feature alone, without a classifier: the probability that it is greater in a patch of
    /// B than in one of A.
    double own_area{};
    Estimate median_a, median_b;
  };
  std::vector<Feature> features;  ///< Those that both clouds have; the most important first.

  [[nodiscard]] bool is_enough() const { return area.is_enough(); }
};

[[nodiscard]] ToldApart TellApart(const PatchPairs& patches);

}  // namespace railcast
