#include "generator/import/map/map_projection.h"

#include <geodesic.h>
#include <proj.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

struct ProjDeleter {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
  void operator()(PJ* object) const { proj_destroy(object); }
};
using ProjContext = std::unique_ptr<PJ_CONTEXT, ProjDeleter>;
using ProjObject = std::unique_ptr<PJ, ProjDeleter>;

constexpr const char* kGeographic = "EPSG:4326";

Eigen::AlignedBox2d BoundsOf_deg(const RailMap& map) {
  Eigen::AlignedBox2d bounds_deg;
  for (const MapNode& node : map.nodes) bounds_deg.extend(node.geographic_deg);
  return bounds_deg;
}

/// The middle of the nodes' bounding box, in whole hundredths of a degree.
Eigen::Vector2d MiddleOf_deg(const Eigen::AlignedBox2d& bounds_deg) {
  return (bounds_deg.center() * 100.0).array().round() / 100.0;
}

std::string LocalDefinition(const Eigen::Vector2d& middle_deg) {
  return "+proj=tmerc +lat_0=" + NumberText(middle_deg.y()) +
         " +lon_0=" + NumberText(middle_deg.x()) +
         " +k=1 +x_0=0 +y_0=0 +ellps=WGS84 +units=m +type=crs";
}

/// What is wrong with a coordinate system for a world in metres; empty: nothing.
std::string FaultOf(PJ_CONTEXT* context, const PJ* system) {
  if (proj_get_type(system) != PJ_TYPE_PROJECTED_CRS) {
    return "must be a projected system, with axes in metres";
  }
  const ProjObject axes(proj_crs_get_coordinate_system(context, system));
  if (!axes || proj_cs_get_type(context, axes.get()) != PJ_CS_TYPE_CARTESIAN) {
    return "must be a projected system, with axes in metres";
  }
  double metres_per_unit = 0.0;
  proj_cs_get_axis_info(context, axes.get(), 0, nullptr, nullptr, nullptr, &metres_per_unit,
                        nullptr, nullptr, nullptr);
  if (metres_per_unit != 1.0) return "must have axes in metres";
  return {};
}

/// Throws what is wrong with --crs.
[[noreturn]] void RefuseSystem(const std::string& rule, const std::string& got) {
  throw InputError("--crs: " + rule + " (got " + got + ")");
}

using ProjArea = std::unique_ptr<PJ_AREA, decltype(&proj_area_destroy)>;

ProjObject TransformationTo(PJ_CONTEXT* context,
                            const std::string& definition,
                            const Eigen::AlignedBox2d& bounds_deg) {
  const ProjObject system(proj_create(context, definition.c_str()));
  if (!system) {
    throw InputError(
        "--crs: must be a coordinate system that PROJ knows, such as EPSG:31256 (got " +
        ShownText(definition) + ")");
  }
  if (const std::string fault = FaultOf(context, system.get()); !fault.empty()) {
    throw InputError("--crs: " + fault + " (got " + ShownText(definition) + ")");
  }
  const ProjArea area(proj_area_create(), &proj_area_destroy);
  proj_area_set_bbox(area.get(), bounds_deg.min().x(), bounds_deg.min().y(), bounds_deg.max().x(),
                     bounds_deg.max().y());
  const ProjObject as_defined(
      proj_create_crs_to_crs(context, kGeographic, definition.c_str(), area.get()));
  if (!as_defined) {
    throw InputError("--crs: must be reachable from WGS 84 (got " + ShownText(definition) + ")");
  }
  // Longitude before latitude, and easting before northing, whatever the systems say.
  ProjObject normal(proj_normalize_for_visualization(context, as_defined.get()));
  if (!normal) RefuseSystem("must have axes to the east and the north", ShownText(definition));
  return normal;
}

/// What a projection makes of 100 m on the ellipsoid, to the north and to the east: the factor that
/// differs more from 1.
template <typename Project>
double ScaleAt(const Eigen::Vector2d& place_deg, const Project& project) {
  constexpr double kLength_m = 100.0;
  geod_geodesic wgs84{};
  geod_init(&wgs84, 6378137.0, 1.0 / 298.257223563);
  double scale = 1.0;
  for (const double azimuth_deg : {0.0, 90.0}) {
    Eigen::Vector2d end_deg;
    geod_direct(&wgs84, place_deg.y(), place_deg.x(), azimuth_deg, kLength_m, &end_deg.y(),
                &end_deg.x(), nullptr);
    const double found = (project(end_deg) - project(place_deg)).norm() / kLength_m;
    if (!(std::abs(found - 1.0) <= std::abs(scale - 1.0))) scale = found;
  }
  return scale;
}

}  // namespace

MapProjection ProjectMap(const std::string& definition, RailMap& map) {
  const ProjContext context(proj_context_create());
  // Faults are reported as errors of the input.
  proj_log_level(context.get(), PJ_LOG_NONE);
  const bool is_local = definition.empty();
  const Eigen::AlignedBox2d bounds_deg = BoundsOf_deg(map);
  const Eigen::Vector2d middle_deg = MiddleOf_deg(bounds_deg);
  MapProjection projection{is_local ? LocalDefinition(middle_deg) : definition, {0.0, 0.0}};
  const ProjObject projected_from_geographic =
      TransformationTo(context.get(), projection.definition, bounds_deg);
  const auto project = [&](const Eigen::Vector2d& place_deg) -> Eigen::Vector2d {
    const PJ_COORD place = proj_trans(projected_from_geographic.get(), PJ_FWD,
                                      proj_coord(place_deg.x(), place_deg.y(), 0.0, 0.0));
    return {place.xy.x, place.xy.y};
  };
  if (!is_local) projection.origin_m = project(middle_deg).array().round();
  for (MapNode& node : map.nodes) {
    node.place_m = project(node.geographic_deg) - projection.origin_m;
    if (node.place_m.allFinite()) continue;
    const std::string place = NumberText(node.geographic_deg.x()) + ", " +
                              NumberText(node.geographic_deg.y()) + " degrees";
    if (!is_local) {
      RefuseSystem("must cover the map, also " + place, ShownText(projection.definition));
    }
    throw InputError("the map must lie about its middle at " + NumberText(middle_deg.x()) + ", " +
                     NumberText(middle_deg.y()) + " degrees (got also " + place + ")");
  }
  for (MapThing& thing : map.things) {
    thing.places_m.clear();
    for (const Eigen::Vector2d& place_deg : thing.geographic_deg) {
      thing.places_m.emplace_back(project(place_deg) - projection.origin_m);
    }
  }
  // One that cannot be projected is far from all tracks.
  std::erase_if(map.things, [](const MapThing& thing) {
    return !std::ranges::all_of(thing.places_m, [](const auto& at) { return at.allFinite(); });
  });
  constexpr double kLargestDifference = 0.01;
  const double scale = ScaleAt(middle_deg, project);
  if (!is_local && !(std::abs(scale - 1.0) <= kLargestDifference)) {
    RefuseSystem("must have a scale from 0.99 to 1.01 in the middle of the map",
                 ShownText(projection.definition) + " with " + ShortText(scale));
  }
  return projection;
}

}  // namespace railcast
