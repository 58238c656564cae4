#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace railcast {

/// The offset of a track from its line by chainage, sampled every metre.
struct TrackSketch {
  std::string name;
  double begin_s_m{};
  double end_s_m{};
  std::vector<double> offsets_m;  ///< At begin_s_m, begin_s_m + 1, ...; one behind the end.
  /// Where it is straight against the line, or nearly so, so that turnouts may lie in it: from, to.
  std::vector<std::pair<double, double>> straights_m;
  bool is_parallel = false;  ///< Whether it is exactly parallel to the line there.

  [[nodiscard]] bool Has(double s_m) const { return s_m >= begin_s_m && s_m <= end_s_m; }
  /// Whether it is straight between two chainages, in either order.
  [[nodiscard]] bool IsStraight(double one_s_m, double other_s_m) const;
  /// Between the samples linear. @pre Has(s_m).
  [[nodiscard]] double OffsetAt_m(double s_m) const;
};

/// Tangent geometry of a turnout (docs/physics.md 7.1).
struct TurnoutShape {
  const char* name{};
  double ratio{};  ///< n of 1 : n.
  double radius_m{};
  double length_m{};    ///< From its beginning to its end.
  double speed_kmph{};  ///< Of the diverging track.

  [[nodiscard]] double angle_rad() const;
  [[nodiscard]] double tangent_m() const;
  /// The least distance of a parallel track behind it that turns back with the same radius.
  [[nodiscard]] double least_distance_m() const;
  /// Distance from the main track at `x_m` behind the beginning of the turnout, if the branch
  /// turns back to be parallel at `distance_m`.
  [[nodiscard]] double OffsetAt_m(double x_m, double distance_m) const;
  /// The chainage, behind the turnout's beginning, at which it is parallel.
  [[nodiscard]] double Parallel_m(double distance_m) const;
};

/// The turnout whose diverging track is made for a speed.
[[nodiscard]] const TurnoutShape& ShapeFor(double speed_kmph);

}  // namespace railcast
