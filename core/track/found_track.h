#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "railcast/transform.h"

namespace railcast {

/// Width of a rail's head (60E1), from gauge face to field face: the middles of two heads are this
/// much farther apart than the gauge.
inline constexpr double kHeadWidth_m = 0.072;

/// The gauges that are tried before any other, in m.
inline constexpr std::array<double, 8> kNamedGauges_m = {1.435, 1.000, 1.067, 1.520,
                                                         1.524, 1.600, 1.668, 0.760};

/// A figure and the half width of its 95 % interval.
struct BoundedFigure {
  double value{};
  double margin{};
};

/// How far a circle that touches the x axis at 0 is from it at `x_m`; to the fourth order.
[[nodiscard]] inline double ArcRise_m(double curvature_per_m, double x_m) {
  const double turn = curvature_per_m * x_m;
  return 0.5 * turn * x_m * (1.0 + 0.25 * turn * turn);
}

/// A track as the points of one frame show it. Its axes are those of the track where the sensor is
/// beside it: the origin in the middle between the rails at the height of their heads, x along the
/// track to where the sensor faces, y to the left, z up from the plane of the heads.
struct FoundTrack {
  Transform track_from_sensor = Transform::Identity();
  BoundedFigure height_m;    ///< How high the sensor is above the plane of the heads.
  BoundedFigure sideways_m;  ///< Where the sensor is from the middle, left positive.
  BoundedFigure yaw_rad, pitch_rad, roll_rad;  ///< As RotationFromYawPitchRoll().
  BoundedFigure gauge_m;
  BoundedFigure curvature_per_m;        ///< In the plane of the heads, left positive.
  std::array<std::size_t, 2> points{};  ///< On the left head and on the right one.
  double first_m{}, last_m{};           ///< From where to where along x the heads are seen.
  double share{};                       ///< Share of this length in which both heads are seen.

  /// Where a point is: along the track, left of its middle, and above the plane of its heads.
  /// @param point_m In the sensor's axes.
  [[nodiscard]] Vector3 Place_m(const Vector3& point_m) const {
    Vector3 place_m = track_from_sensor * point_m;
    place_m.y() -= ArcRise_m(curvature_per_m.value, place_m.x());
    return place_m;
  }
  /// Half the width of the 95 % interval of where the track is, across or above, so far along.
  [[nodiscard]] double Margin_m(double x_m) const;
  /// How far along, ahead and behind, it is known to a margin: up to 200 m.
  [[nodiscard]] double KnownFor_m(double margin_m) const;
};

/// What a frame shows of tracks.
struct FoundTracks {
  std::vector<FoundTrack> tracks;  ///< The nearest to the sensor first.
  std::string why_not;             ///< Why there is none, as a clause; else empty.
};

/// Finds the tracks that a frame shows: pairs of ridges at a gauge's distance, lower ground on both
/// sides of each, no wider than a rail's head, along one curve. The way up is first sought near the
/// sensor's z and then anywhere, so that a sensor may lie on its side.
///
///     const FoundTracks found = FindTracks(points_m, std::nullopt);
///     if (!found.tracks.empty()) Use(found.tracks.front().height_m.value);
///
/// @param points_m In the sensor's axes, finite, in any order.
/// @param gauge_m Of the tracks to find; nothing: the named ones, then any from 0.6 to 1.7 m.
[[nodiscard]] FoundTracks FindTracks(const std::vector<Eigen::Vector3f>& points_m,
                                     std::optional<double> gauge_m);

}  // namespace railcast
