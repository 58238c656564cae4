#pragma once

#include <vector>

#include "core/base/transform.h"
#include "core/rail/chunk_context.h"

namespace railcast {

/// Sleepers of every track stand at whole multiples of this chainage (physics.md 7.1).
inline constexpr double kSleeperSpacing_m = 0.6;
inline constexpr double kSleeperHalfLength_m = 1.3;

/// How a kind of sleeper sits in its track: heights above top of rail.
struct SleeperSeat {
  double top_m{};          ///< Of the sleeper below the rail.
  double middle_drop_m{};  ///< How much lower its top is between the rails.
};

/// @pre `sleeper` is "concrete" or "wood".
[[nodiscard]] SleeperSeat SeatOf(const std::string& sleeper);

/// The line cut across at one chainage, smooth (without grain or roughness): where the formation
/// and the ballast lie. Lateral positions `d_m` are horizontal, left of the axis; heights are
/// vertical, above the axis' top of rail.
///
/// Ballast (physics.md 7.1): top 20 mm below the sleeper's top and parallel to it, 0.45 m beyond
/// the sleeper's end, then down 1:1.5. Where tracks lie side by side the highest of their ballast
/// counts. Around a sleeper, the top is 20 mm lower still, so that grains do not cover it.
class CrossSection {
 public:
  /// Below the axis' top of rail: 0.30 m of ballast under a concrete sleeper.
  static constexpr double kFormationDepth_m = 0.70;
  /// From a track's axis to where its ballast begins to fall.
  static constexpr double kShoulder_m = kSleeperHalfLength_m + 0.45;

  CrossSection(const ChunkContext& context, double s_m);

  /// Level beside the tracks, and rising or falling evenly from track to track.
  [[nodiscard]] double FormationHeight_m(double d_m) const;
  /// The slopes go on below the formation; minus infinity where no track is near.
  [[nodiscard]] double BallastHeight_m(double d_m) const;
  /// How far `d_m` is from the nearest track's axis, whether or not it exists here.
  [[nodiscard]] double DistanceFromTracks_m(double d_m) const;

  /// In the chunk's frame.
  [[nodiscard]] Vector3 PointAt(double d_m, double height_m) const;

 private:
  struct TrackHere {
    double d_m{};
    double height_m{};
    double cant_rad{};
    double beyond_end_m{};  ///< Along the line; 0 within the track.
    SleeperSeat seat;
  };

  [[nodiscard]] double BallastHeightOf(const TrackHere& track, double d_m) const;

  Transform chunk_from_axis_;      ///< Level: x along the heading, y left, z up.
  double sleeper_closeness_;       ///< 1 at a sleeper's middle, falling to 0 in 0.2 m.
  std::vector<TrackHere> tracks_;  ///< From right to left.
};

}  // namespace railcast
