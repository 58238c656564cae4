#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

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
/// Of a frame with more patches, this many are taken, evenly spread.
inline constexpr std::size_t kMaxPatchesAFrame = 400;

/// The points of a frame in a cube of kPatchEdge_m along the axes of its points.
struct Patch {
  float range_m{};  ///< Of the points' mean. Not a feature.
  /// In the order of kPatchFeatures; NaN where the frame or the patch lacks what it takes.
  std::array<float, kNumPatchFeatures> features{};
};

/// The patches of a frame with at least kMinPatchPoints points, by place.
[[nodiscard]] std::vector<Patch> PatchesOf(const RecordedFrame& recorded);

}  // namespace railcast
