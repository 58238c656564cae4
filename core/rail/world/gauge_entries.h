#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/rail/line/track_course.h"
#include "railcast/alignment.h"
#include "railcast/rail_world.h"

namespace railcast {

/// Something that stands in the clear space of a track, or in the way of its trains.
struct GaugeEntry {
  std::string name;   ///< As reports show it: `platform "west"`.
  std::string track;  ///< Name of the track.
  double begin_s_m{};
  double end_s_m{};
  /// Between these chainages it reaches in; it stays out for more than 5 m between two of them.
  std::vector<ChainageRange> stretches;
  double deepest_s_m{};  ///< Where it reaches farthest in.
  double depth_m{};   ///< From the space's side towards the track's axis; half its width at most.
  double bottom_m{};  ///< Above top of rail, inside the space.
  double top_m{};
  bool is_in_way{};  ///< Whether it reaches into the outline of vehicles.
};

/// What of the world's structures and standing objects is inside the clear space (ClearSpace()) or
/// the outline of vehicles (VehicleOutline()) of which track, by more than a millimetre: first
/// structures, then objects, in their order, each with its tracks in their order. It is found
/// triangle by triangle, so that whatever lies across a curve is found where it does. A wagon that
/// stands in the middle of its own track is left out there. Platforms may stand in the clear space,
/// but must be as far from the axis as EBO § 13 and EN 15273-3 want their edges, up to a tolerance
/// of 5 mm.
[[nodiscard]] std::vector<GaugeEntry> FindGaugeEntries(const WorldSpec& spec,
                                                       const RailWorld& world);

/// The same for one object, whether it moves or not, at one moment, and the outline of vehicles.
/// @param object Index into world.objects(); also of one that was added to it.
/// @param is_on_its_track Whether it is left out on the tracks under it, as a wagon on its rails.
[[nodiscard]] std::vector<GaugeEntry> FindObjectInTheWay(const WorldSpec& spec,
                                                         const RailWorld& world,
                                                         std::size_t object,
                                                         bool is_on_its_track,
                                                         std::int64_t time_ns);

struct StructuresInGauge {
  std::vector<GaugeEntry> entries;
  /// Of triangles with tracks, which is what it costs: in proportion to the structures, since each
  /// is compared with the tracks that are near it.
  std::size_t num_comparisons = 0;
};

/// The same for the structures alone.
/// @param spec With all tracks, also those of yards.
/// @param courses Of the tracks, in their order.
[[nodiscard]] StructuresInGauge FindStructuresInGauge(const WorldSpec& spec,
                                                      const Alignment& alignment,
                                                      std::span<const TrackCourse> courses);

}  // namespace railcast
