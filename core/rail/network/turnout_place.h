#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/rail/base/world_faults.h"
#include "core/rail/line/piecewise_linear.h"
#include "core/rail/line/track_course.h"
#include "railcast/world_spec.h"

namespace railcast {

/// The axes of a turnout with a straight main track. The diverging axis is an arc that touches the
/// main axis at the turnout's beginning and turns by the angle; then it runs straight to the
/// turnout's end. Both axes are equally long from the point where their tangents meet to the end.
struct TurnoutGeometry {
  double radius_m{};   ///< Of the arc of the diverging axis.
  double angle_rad{};  ///< atan(1 / n) for a turnout 1:n.
  /// From the beginning to the point where the tangents meet: R tan(angle / 2).
  double tangent_m{};
  double length_m{};  ///< From the beginning to the end, along the main axis.

  /// Length of the arc of the diverging axis.
  [[nodiscard]] double arc_m() const { return radius_m * angle_rad; }
  /// Length of the straight behind the arc.
  [[nodiscard]] double straight_m() const { return length_m - 2.0 * tangent_m; }
};

/// The standard turnouts of docs/world.md: 1:9-300, 1:12-500 and 1:14-760 end where the arc
/// does. The arc of 1:9-190 ends before its crossing, and it is as long behind the point where the
/// tangents meet as a 1:9-300, whose crossing it shares.
[[nodiscard]] TurnoutGeometry GeometryOf(TurnoutType type);

/// A turnout as specified, on a track whose course is known.
struct TurnoutPlace {
  std::string pointer;  ///< Of its spec.
  TurnoutSpec spec;
  std::size_t track{};
  TrackCourse course;  ///< Of that track.
  TurnoutGeometry geometry;
  bool opens_ahead{};
};

/// The chainage of a track where a turnout that begins at `s_m` ends.
[[nodiscard]] double TurnoutEnd_m(const TurnoutPlace& place, double s_m);

/// Curvature of the track through a turnout that begins at `s_m`, in the plane of chainage and
/// offset, by the length from the turnout's beginning on: one piece where it is the same
/// throughout, else many. Returns nothing and adds a fault if the track ends within the turnout.
[[nodiscard]] std::optional<std::vector<LinearPiece>> CurvatureThrough(const TurnoutPlace& place,
                                                                       double s_m,
                                                                       WorldFaults& faults);

struct TurnoutSite;

/// Distance of the axes of two tracks that join at their fouling point, where the marker stands
/// (in German the Grenzzeichen).
inline constexpr double kFoulingDistance_m = 3.5;

/// The chainage at which the branch of a turnout is `distance_m` away from the track in which the
/// turnout lies, measured across the alignment; absent if it never is.
[[nodiscard]] std::optional<double> ClearChainage_m(const TrackCourse& track,
                                                    const TrackCourse& branch,
                                                    const TurnoutSite& turnout,
                                                    double distance_m);

/// All names of tracks, as messages list them.
[[nodiscard]] std::string NamesOfTracks(const WorldSpec& world);
[[nodiscard]] bool AreNamesKnown(const WorldSpec& world, const WorldFaults& faults);

/// A length to the millimetre.
[[nodiscard]] std::string MetresText(double length_m);
/// Text such as "from 0 to 1000 m", or "from 0 m on" if the end is infinite.
[[nodiscard]] std::string StretchText(double begin_s_m, double end_s_m);

}  // namespace railcast
