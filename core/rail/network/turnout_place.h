#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/rail/base/world_faults.h"
#include "core/rail/line/piecewise_linear.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/turnout_geometry.h"
#include "railcast/world_spec.h"

namespace railcast {

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

/// All names of tracks, as messages list them.
[[nodiscard]] std::string NamesOfTracks(const WorldSpec& world);
[[nodiscard]] bool AreNamesKnown(const WorldSpec& world, const WorldFaults& faults);

/// A length to the millimetre.
[[nodiscard]] std::string MetresText(double length_m);
/// Text such as "from 0 to 1000 m", or "from 0 m on" if the end is infinite.
[[nodiscard]] std::string StretchText(double begin_s_m, double end_s_m);

}  // namespace railcast
