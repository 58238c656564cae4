#pragma once

#include <memory>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/scene.h"
#include "railcast/world_spec.h"

namespace railcast {

/// A B70 sleeper in the track frame: 2600 x 300 mm; 214 mm high below the rail, 234 mm outside it
/// and 175 mm in the middle, where it is 220 mm wide; W14 fastenings on rail seats canted 1:40.
/// @param shift_m How much farther from the middle its rails lie, and its ends (RailShift_m).
[[nodiscard]] Model MakeConcreteSleeper(const RailSurfaces& surfaces, double shift_m);

/// A wooden sleeper in the track frame: 2600 x 260 x 160 mm, with baseplates canted 1:40.
[[nodiscard]] Model MakeWoodSleeper(const RailSurfaces& surfaces, double shift_m);

/// Lengths in which bearers are made: from a part in a crossover on cant up to that under all four
/// tracks of a scissors crossover.
inline constexpr double kBearerStep_m = 0.1;
inline constexpr double kShortestBearer_m = 1.6;
inline constexpr double kLongestBearer_m = 12.0;

/// Long bearers under the tracks of a turnout, in steps of 0.1 m as they are made, in the frame of
/// a track in whose plane they lie, with their middle at the origin. 300 (concrete) or
/// 260 mm (wood) wide; their tops are as high as those of sleepers. 12 triangles each.
[[nodiscard]] Model MakeBearer(SleeperType sleeper, double length_m, const RailSurfaces& surfaces);

/// A plate with two clips under one rail on a bearer: 36 triangles. In the frame of a track, below
/// its left rail's place moved to the axis.
[[nodiscard]] Model MakeRailPlate(SleeperType sleeper, const RailSurfaces& surfaces);

/// A point machine: 0.95 x 0.50 x 0.35 m, in the frame of a track, with its middle at the origin
/// and its top at the height of top of rail less 50 mm. 12 triangles.
[[nodiscard]] Model MakePointMachine(const RailSurfaces& surfaces);

/// Models that are placed repeatedly in tracks.
struct TrackModels {
  /// Sleepers in the track frame; their rail seats fit the rails of RailSection. The sleepers have
  /// 92 (concrete) and 12 (wood) triangles, plus 168 for pads or plates and fastenings.
  std::shared_ptr<const Model> concrete_sleeper;
  std::shared_ptr<const Model> wood_sleeper;

  /// Of turnouts (track/track_structure.h): bearers from 1.6 m on, each 0.1 m longer.
  std::vector<std::shared_ptr<const Model>> concrete_bearers;
  std::vector<std::shared_ptr<const Model>> wood_bearers;
  std::shared_ptr<const Model> concrete_plate;
  std::shared_ptr<const Model> wood_plate;
  std::shared_ptr<const Model> point_machine;
};

[[nodiscard]] TrackModels MakeTrackModels(const AlignmentSpec& line, const RailSurfaces& surfaces);

}  // namespace railcast
