#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/transform.h"
#include "core/frame/frame.h"
#include "core/io/recording/scan_table.h"

namespace railcast {

/// A flat surface that the sensor, standing still, looks at; in the sensor's axes.
struct KnownPlane {
  std::string name;
  std::string material;  ///< Planes of one material share a reflectance; empty = the plane's name.
  Vector3 point_m = Vector3::Zero();
  Vector3 normal = Vector3::UnitX();  ///< Unit length.
  std::optional<double> radius_m;     ///< Extent: about `point_m`, ...
  std::vector<Vector3> corners_m;     ///< ... or a convex polygon, at least 3 corners.

  [[nodiscard]] const std::string& surface() const { return material.empty() ? name : material; }
};

/// Reads {"planes": [{"name", "material", "point_m", "normal", "radius_m" or "corners_m"}, ...]}.
/// @throws InputError with a line for every fault: "file: /planes/0/normal: rule (got value)".
[[nodiscard]] std::vector<KnownPlane> ReadKnownPlanes(const std::filesystem::path& file);

/// What a beam from the origin meets first.
struct PlaneHit {
  std::size_t plane{};
  double range_m{};
  double cos_incidence{};
};
/// @param direction Unit length, sensor axes.
[[nodiscard]] std::optional<PlaneHit> HitPlanes(const std::vector<KnownPlane>& planes,
                                                const Vector3& direction);

/// Moves each plane to the points within 0.3 m of it and within its extent, by least squares with
/// Tukey's weights, so that the noise of the given plane does not enter. Its extent moves along.
/// @param points_m Of a few frames, sensor axes.
/// @returns How many points each plane rests on.
/// @throws InputError with a line for each plane with fewer than kMinPlanePoints, or whose points
/// lie
///   on another plane, turned by more than 10 degrees.
inline constexpr std::size_t kMinPlanePoints = 50;
[[nodiscard]] std::vector<std::size_t> RefinePlanes(const std::vector<Vector3>& points_m,
                                                    std::vector<KnownPlane>& planes);

}  // namespace railcast
