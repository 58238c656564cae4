#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/line/rail_section.h"
#include "railcast/transform.h"

namespace railcast {

/// The chainages of the sleepers in the chunk.
[[nodiscard]] std::vector<double> SleeperPlaces(const ChunkContext& context);

/// Height of a type of sleeper in its track, above top of rail.
struct SleeperSeat {
  double top_m{};          ///< Top of the sleeper below the rail.
  double middle_drop_m{};  ///< How much lower the top is between the rails.
};

[[nodiscard]] SleeperSeat SeatOf(SleeperType sleeper);

/// Distance from a track's axis at which its ballast begins to fall.
[[nodiscard]] double ShoulderOf_m(const WorldSpec& spec);

/// Cross-section of the line at one chainage: smooth heights of formation and ballast, without
/// grain or roughness. Lateral positions `d_m` are horizontal, left of the axis; heights are
/// vertical, relative to the axis' top of rail.
///
/// Ballast (docs/physics.md 7.1): its top is 20 mm below the sleeper's top and parallel to it,
/// extends 0.45 m beyond the sleeper's end and then falls at 1:1.5; BallastSpec has it higher or
/// lower, outside the rails too, and the shoulder wider or narrower. Where the ballast of several
/// tracks overlaps, the highest counts. Around a sleeper, the top is another 20 mm lower, so that
/// grains do not cover the sleeper.
class CrossSection {
 public:
  /// Below the axis' top of rail; gives 0.30 m of ballast under a concrete sleeper.
  static constexpr double kFormationDepth_m = 0.70;
  CrossSection(const ChunkContext& context, double s_m);

  /// Level beside the tracks, and interpolated linearly between neighbouring tracks.
  [[nodiscard]] double FormationHeight_m(double d_m) const;
  /// The slopes continue below the formation. Minus infinity where no track is near.
  [[nodiscard]] double BallastHeight_m(double d_m) const;
  /// Distance of `d_m` from the axis of the nearest track. Where a track does not exist, its
  /// nearest end counts, at the same offset.
  [[nodiscard]] double DistanceFromTracks_m(double d_m) const;

  /// Distance of `d_m` from the axis of the nearest track for which `counts(d of its axis)`;
  /// infinite if there is none.
  template <class Counts>
  [[nodiscard]] double DistanceFromTracksIf_m(double d_m, const Counts& counts) const {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const TrackHere& track : tracks_) {
      if (!counts(track.d_m)) continue;
      const double aside_m = std::abs(d_m - track.d_m);
      const double beyond_m = track.is_everywhere ? 0.0 : BeyondEnd_m(track, s_m_);
      if (std::max(aside_m, beyond_m) >= nearest_m) continue;
      nearest_m = std::min(nearest_m, beyond_m > 0.0 ? std::hypot(aside_m, beyond_m) : aside_m);
    }
    return nearest_m;
  }

  /// The point in the chunk's frame.
  [[nodiscard]] Vector3 PointAt(double d_m, double height_m) const;

 private:
  struct TrackHere {
    double d_m{};
    double height_m{};
    double cant_rad{};
    double turn_rad{};  ///< Turn of its heading from that of the alignment.
    double begin_s_m{};
    double end_s_m{};
    SleeperSeat seat;
    bool has_ballast{};  ///< Here, or close beyond its end.
    /// Whether it shapes the ground all along the line, as one that is parallel to the alignment.
    bool is_everywhere{};
  };

  /// Distance along the line from the track's end; 0 within the track.
  [[nodiscard]] static double BeyondEnd_m(const TrackHere& track, double s_m);
  [[nodiscard]] double BallastHeightOf(const TrackHere& track, double d_m) const;

  Transform chunk_from_axis_;  ///< Level: x along the heading, y left, z up.
  double s_m_;
  double shift_m_;                 ///< Shift of rails, sleepers' ends and shoulders (RailShift_m).
  double shoulder_m_;              ///< From a track's axis to where its ballast begins to fall.
  double below_sleepers_m_;        ///< How much lower the ballast's top is than the sleepers'.
  double outside_below_m_;         ///< The same outside the rails.
  double sleeper_closeness_;       ///< For tracks parallel to the alignment.
  std::vector<TrackHere> tracks_;  ///< From right to left.
  std::vector<std::size_t> ballasted_;  ///< Tracks that have ballast.
};

}  // namespace railcast
