#pragma once

#include <cstddef>
#include <vector>

#include "core/rail/line/alignment.h"
#include "core/rail/world_spec.h"

namespace railcast {

/// Of the HEB 240 that masts, posts and beams are made of.
inline constexpr double kMastHalfDepth_m = 0.12;

/// How near to the axis of any track the face of a mast may be: a G1 wagon reaches 1.58 m to the
/// side, and cant of 160 mm leans its corner 4.28 m high by 0.46 m.
inline constexpr double kMastClearance_m = 2.2;

/// What holds a track's cantilever.
struct CantileverSite {
  std::size_t track{};  ///< Index.
  /// Of the mast's or post's face, left of the track's axis, or of the pantograph's middle if it
  /// `hangs`.
  double face_m{};
  bool hangs{};             ///< On a post below a portal's beam; else on a mast.
  std::size_t structure{};  ///< The first of the tracks that share the mast or portal.
};

struct MastSite {
  std::size_t track{};   ///< Beside which it stands ...
  double from_axis_m{};  ///< ... with its middle so far to the left.
  std::size_t structure{};
};

/// A beam from mast to mast across tracks between which there is no room for masts. Posts hang from
/// it half way between tracks.
struct PortalSite {
  double right_d_m{};  ///< The masts' middles, left of the alignment.
  double left_d_m{};
  std::vector<double> posts_d_m;  ///< Middles, left of the alignment for a pantograph above its
                                  ///< track's middle; cant moves both sideways.
  std::size_t structure{};
};

/// All that stands at one support of the contact line.
struct SupportLayout {
  std::vector<CantileverSite> cantilevers;  ///< One for each wire, in the order of tracks.
  std::vector<MastSite> masts;              ///< No two at one place.
  std::vector<PortalSite> portals;
};

/// A track's mast stands CatenarySpec's distance to the right of its axis, or to the left of the
/// leftmost of several tracks; on the other side if another track is in the way there; half way to
/// the next track if both are; and if the next tracks are too near for that, too, a post half way
/// to the one on the right holds the cantilever, from a portal to the nearest places for masts. A
/// track is in the way of a mast that would be nearer than kMastClearance_m to its axis or beyond
/// it, from 10 m before its beginning to 10 m after its end.
[[nodiscard]] SupportLayout LayOutSupport(const WorldSpec& spec,
                                          const Alignment& alignment,
                                          double s_m);

/// Whether the track has a wire at chainage `s_m`, if the line has a contact line.
[[nodiscard]] bool HasWireAt(const TrackSpec& track, const Alignment& alignment, double s_m);

}  // namespace railcast
