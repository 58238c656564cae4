#include "core/rail/traffic/object_draft.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/base/text.h"
#include "core/rail/line/line_place.h"
#include "core/rail/line/map_place.h"
#include "core/rail/network/route.h"
#include "core/rail/network/turnout_place.h"
#include "core/rail/traffic/object_way.h"

namespace railcast {
namespace {

/// The two keys of a place on the map, and what stands under them.
struct MapPlace {
  std::string pointer;  ///< Pointer of the first key.
  std::string other;    ///< The second key.
  std::optional<Eigen::Vector2d> world_m;
  /// Where it would be if its longitude were its latitude.
  std::optional<Eigen::Vector2d> exchanged_m = std::nullopt;
};

/// The place that the keys of an object or of a point of a path give; nothing if these are others.
template <class Placed>
std::optional<MapPlace> MapPlaceOf(const MappedTracks& tracks,
                                   const std::string& pointer,
                                   const Placed& placed,
                                   WorldFaults& faults) {
  const std::optional<MapSpec>& map = tracks.world.alignment.map;
  const bool is_geographic = placed.longitude_deg && placed.latitude_deg;
  if (!is_geographic && !(placed.x_m && placed.y_m)) return std::nullopt;
  MapPlace place{pointer + (is_geographic ? "/longitude_deg" : "/x_m"),
                 is_geographic ? "latitude_deg" : "y_m", std::nullopt};
  if (!faults.AreKnown({place.pointer, pointer + "/" + place.other, "/world/alignment/map"})) {
    return place;
  }
  if (!is_geographic) {
    const Eigen::Vector2d place_m(*placed.x_m, *placed.y_m);
    place.world_m = map ? WorldFromProjection(*map, place_m) : place_m;
    return place;
  }
  if (!map) {
    faults.Add(place.pointer,
               "must not be given: the alignment has no map that says where the world lies",
               NumberText(*placed.longitude_deg));
    return place;
  }
  const Eigen::Vector2d world_m =
      WorldFromGeographic(*map, *placed.longitude_deg, *placed.latitude_deg);
  if (world_m.allFinite()) {
    place.world_m = world_m;
    place.exchanged_m = WorldFromGeographic(*map, *placed.latitude_deg, *placed.longitude_deg);
  } else {
    faults.Add(place.pointer,
               "must lie within 90 degrees of the map's, " + NumberText(map->longitude_deg),
               NumberText(*placed.longitude_deg));
  }
  return place;
}

void PlacePathPoints(const MappedTracks& tracks,
                     const std::string& pointer,
                     ObjectSpec& object,
                     WorldFaults& faults) {
  if (!object.motion || !object.motion->path) return;
  for (std::size_t i = 0; i < object.motion->path->points.size(); ++i) {
    PathPoint& point = object.motion->path->points[i];
    const std::string point_pointer = pointer + "/motion/path/points/" + std::to_string(i);
    const std::optional<MapPlace> place = MapPlaceOf(tracks, point_pointer, point, faults);
    if (!place) continue;
    if (!place->world_m) {
      faults.unknown.Add(point_pointer);
      continue;
    }
    point.x_m = place->world_m->x();
    point.y_m = place->world_m->y();
    point.longitude_deg.reset();
    point.latitude_deg.reset();
  }
}

/// The course of the object's track or route. Its faults are reported elsewhere (DraftPath).
std::optional<Route> RouteOfPlaced(const MappedTracks& tracks,
                                   const std::string& pointer,
                                   const ObjectSpec& object,
                                   const WorldFaults& faults) {
  const bool has_route = !object.route.empty();
  const RouteSpec spec{.pointer = pointer + (has_route ? "/route" : "/track"),
                       .tracks = has_route ? object.route : std::vector<std::string>{object.track},
                       .runs_back = object.motion.has_value() && object.motion->reverse};
  WorldFaults ignored{{}, faults.unknown};
  if (!ignored.AreKnown({spec.pointer})) return std::nullopt;
  return MakeRoute(tracks.world, tracks.network, spec, ignored);
}

/// The chainage beside which a place lies, unless it is on no ground or beside several.
std::optional<double> ChainageBeside_m(const MappedTracks& tracks,
                                       const MapPlace& place,
                                       WorldFaults& faults) {
  const double half_width_m = tracks.world.terrain.half_width_m;
  const std::vector<PlaceBesideLine> nearest = NearestOnLine(*tracks.alignment, *place.world_m);
  if (!faults.AreKnown({"/world/terrain/half_width_m"})) return std::nullopt;
  if (!(std::abs(nearest.front().d_m) <= half_width_m)) {
    const auto lies_there = [&](const Eigen::Vector2d& place_m) {
      return place_m.allFinite() &&
             std::abs(NearestOnLine(*tracks.alignment, place_m).front().d_m) <= half_width_m;
    };
    const bool is_exchanged = place.exchanged_m && lies_there(*place.exchanged_m);
    faults.Add(place.pointer,
               "must lie with " + place.other + " on the ground, within " +
                   NumberText(half_width_m) + " m of the line" +
                   (is_exchanged ? ": longitude and latitude are exchanged" : ""),
               MetresText(std::abs(nearest.front().d_m)) + " m");
    return std::nullopt;
  }
  if (nearest.size() > 1) {
    faults.Add(
        place.pointer,
        "must lie with " + place.other + " nearer to one place of the line than to any other",
        MetresText(std::abs(nearest.front().d_m)) + " m from " + MetresText(nearest.front().s_m) +
            " and " + MetresText(nearest.back().s_m) + " m");
    return std::nullopt;
  }
  return nearest.front().s_m;
}

/// A place on the very end of a track is found to lie on either side of it.
constexpr double kFound_m = 1e-5;

/// Sets s_m and d_m if the object has a place beside its track.
bool PlaceBesideWay(const MappedTracks& tracks,
                    const std::string& pointer,
                    const MapPlace& place,
                    ObjectSpec& object,
                    WorldFaults& faults) {
  if (tracks.alignment == nullptr) return false;
  const std::optional<double> near_s_m = ChainageBeside_m(tracks, place, faults);
  if (!near_s_m) return false;
  const std::optional<Route> way = RouteOfPlaced(tracks, pointer, object, faults);
  if (!way) return false;
  const PlaceBesideTrack found =
      PlaceOnTrack(*tracks.alignment, way->course, *place.world_m, *near_s_m);
  const double s_m = std::clamp(found.s_m, way->course.begin_s_m(), way->course.end_s_m());
  if (!(std::abs(found.s_m - s_m) <= kFound_m)) {
    faults.Add(place.pointer,
               "must lie with " + place.other + " beside " + WayText(*way) + ", " +
                   StretchText(way->course.begin_s_m(), way->course.end_s_m()),
               "chainage " + MetresText(found.s_m) + " m");
    return false;
  }
  const bool is_on_rails = RestsOnPivots(object);
  if (is_on_rails && !(std::abs(found.d_m) <= kOffTrack_m)) {
    faults.Add(place.pointer,
               "must lie with " + place.other + " within " + NumberText(kOffTrack_m) +
                   " m of the axis of " + WayText(*way) + ", on which it stands",
               MetresText(std::abs(found.d_m)) + " m");
    return false;
  }
  object.s_m = s_m;
  object.d_m = is_on_rails ? 0.0 : found.d_m;
  return true;
}

}  // namespace

void PlaceFromMap(const MappedTracks& tracks,
                  const std::string& pointer,
                  ObjectSpec& object,
                  WorldFaults& faults) {
  PlacePathPoints(tracks, pointer, object, faults);
  const std::optional<MapPlace> place = MapPlaceOf(tracks, pointer, object, faults);
  if (!place) return;
  if (place->world_m && PlaceBesideWay(tracks, pointer, *place, object, faults)) return;
  // Rules of track coordinates do not apply to what has none.
  faults.unknown.Add(pointer + "/s_m");
  faults.unknown.Add(pointer + "/d_m");
}

}  // namespace railcast
