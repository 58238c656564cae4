#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/rail/catenary/independent_wires.h"
#include "core/rail/line/track_course.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Half depth of the HEB 240 used for masts, posts and beams.
inline constexpr double kMastHalfDepth_m = 0.12;

/// Minimum distance between the face of a mast and the axis of any track: a G1 wagon extends 1.58 m
/// to the side, and a cant of 160 mm moves its corner at 4.28 m height by 0.46 m.
inline constexpr double kMastClearance_m = 2.2;

/// A cantilever, and the structure that carries it.
struct CantileverSite {
  std::size_t track{};  ///< The first of its tracks.
  double axis_d_m{};    ///< Where the wire of that one hangs (HungWire).
  double lift_m{};      ///< Lift of that wire's axis.
  /// Face of the mast or post: left of that axis or, if `hangs`, of the pantograph's middle.
  double face_m{};
  bool hangs{};  ///< Whether it is on a post below a portal's beam; otherwise it is on a mast.
  std::size_t structure{};      ///< Index of the first of the tracks that share the mast or portal.
  std::vector<HungWire> wires;  ///< The wires that it carries: of tracks less than 3 m apart.
  /// Where its room ends on the side away from the face, left of the axis: halfway to the next
  /// tracks, less a post. Infinite if there are none.
  double room_m{};
};

struct MastSite {
  std::size_t track{};   ///< Track beside which the mast stands.
  double axis_d_m{};     ///< Where the wire of that track hangs.
  double from_axis_m{};  ///< Middle of the mast, left of that axis.
  std::size_t structure{};

  [[nodiscard]] double d_m() const { return axis_d_m + from_axis_m; }
};

/// A beam between two masts, over tracks that leave no room for masts between them. Posts hang from
/// it halfway between tracks.
struct PortalSite {
  double right_d_m{};  ///< Middle of the right mast, left of the alignment.
  /// Middle of the left mast, left of the alignment.
  double left_d_m{};
  /// Middles of the posts, left of the alignment, where the pantograph is above the middle of its
  /// track. Cant displaces both.
  std::vector<double> posts_d_m;
  /// How much lower than at the line's height a cantilever hangs from it: 0 or less.
  double lowest_lift_m{};
  std::size_t structure{};
};

/// All structures at one support of the contact line.
struct SupportLayout {
  std::vector<CantileverSite> cantilevers;  ///< In the order of their first tracks.
  std::vector<MastSite> masts;              ///< No two at the same place.
  std::vector<PortalSite> portals;
};

/// Lays out the structures at one support.
///
/// A track's mast stands at CatenarySpec's distance to the right of its axis; for the leftmost of
/// several tracks, to the left. If another track obstructs that place, it stands on the other side;
/// if both are obstructed, halfway to the next track. If the next tracks are too close for that as
/// well, the cantilever is carried by a post halfway to the track on the right, which hangs from a
/// portal between the nearest places for masts.
///
/// Where a structure leaves no room for a mast, it stands up to 3 m farther out.
///
/// A track obstructs a mast if the mast would be nearer than kMastClearance_m to its axis, or
/// beyond it. This applies from 10 m before the track's beginning to 10 m after its end.
///
/// Tracks less than 3 m apart, as in and behind a turnout, share one mast or post, which stands
/// where it would for the outermost of them, with one cantilever for all their wires.
/// @param tracks In the order of WorldSpec::tracks.
/// @param wires Those that the support carries, in the same order.
[[nodiscard]] SupportLayout LayOutSupport(const WorldSpec& spec,
                                          std::span<const TrackCourse> tracks,
                                          double s_m,
                                          const std::vector<HungWire>& wires);

}  // namespace railcast
