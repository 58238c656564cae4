#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "analysis/estimate/estimate.h"
#include "core/io/run/dataset_files.h"
#include "railcast/io/recording.h"

namespace railcast {

/// A figure of a patch. None depends on where the patch is in the world or in the frame.
struct PatchFeature {
  std::string_view key;
  std::string_view title;
  std::string_view unit;
};

// With the standard deviations s1 >= s2 >= s3 of a patch along its principal axes: (s1 - s2) / s1,
// (s2 - s3) / s1, s3 / s1 (Demantke et al. 2011, "Dimensionality based scale selection in 3D lidar
// point clouds", ISPRS Archives XXXVIII-5/W12), and s3 itself.
inline constexpr std::size_t kNumPatchFeatures = 12;
inline constexpr std::array<PatchFeature, kNumPatchFeatures> kPatchFeatures = {{
    {"linearity", "Linearity", ""},
    {"planarity", "Planarity", ""},
    {"scattering", "Scattering", ""},
    {"thickness_m", "Deviation from the patch's plane", "m"},
    {"roughness_m", "Roughness: deviation from planes of 0.5 m", "m"},
    {"inclination_deg", "Inclination of the patch's plane", "deg"},
    {"height_spread_m", "Standard deviation of height", "m"},
    {"density_per_sr", "Points per solid angle", "1/sr"},
    {"filled_percent", "Share of cubes of 0.5 m with a point", "%"},
    {"several_returns_percent", "Share of points with other returns beside them", "%"},
    {"intensity", "Mean intensity", ""},
    {"intensity_spread", "Standard deviation of intensity", ""},
}};
/// Whether a feature is of intensities, whose scale differs between sensors.
[[nodiscard]] constexpr bool IsOfIntensity(std::size_t feature) {
  return kPatchFeatures.at(feature).key.starts_with("intensity");
}

/// Edge of the cubes into which a cloud is cut: some contain a person or a stretch of one rail.
inline constexpr double kPatchEdge_m = 2.0;
inline constexpr std::size_t kMinPatchPoints = 20;
/// If a frame has more patches, this many of them are taken, evenly spread.
inline constexpr std::size_t kMaxPatchesAFrame = 400;

/// The points of a frame in a cube of kPatchEdge_m along the axes of its points.
struct Patch {
  float range_m{};  ///< Range of the points' mean. Not a feature.
  /// In the order of kPatchFeatures; NaN where the frame or the patch lacks what it takes.
  std::array<float, kNumPatchFeatures> features{};
};

/// The patches of a frame with at least kMinPatchPoints points, by place.
[[nodiscard]] std::vector<Patch> PatchesOf(const RecordedFrame& recorded);

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
struct Separability {
  static constexpr std::uint64_t kMinPatches = 100;

  /// Area under the curve: the probability that a patch of B looks more like B than one of A does.
  Estimate area;
  Estimate balanced_accuracy;
  /// For a classifier that sees no intensities. "Not enough" if there are none, too.
  Estimate shape_area;
  std::array<Estimate, kNumDistanceBins> area_by_range;

  struct Feature {
    std::size_t index{};  ///< In kPatchFeatures.
    Estimate lost_area;   ///< Without the feature, its importance.
    /// How well the feature alone separates, without a classifier: the probability that it is
    /// greater in a patch of B than in one of A.
    double own_area{};
    Estimate median_a, median_b;
  };
  std::vector<Feature> features;  ///< The features that both clouds have; the most important first.

  [[nodiscard]] bool is_enough() const { return area.is_enough(); }
};

[[nodiscard]] Separability SeparabilityOf(const PatchPairs& patches);

}  // namespace railcast
