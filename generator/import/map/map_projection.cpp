#include "generator/import/map/map_projection.h"

#include <proj.h>

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

/// The middle of the nodes' bounding box, in whole hundredths of a degree.
Eigen::Vector2d MiddleOf_deg(const RailMap& map) {
  Eigen::AlignedBox2d bounds_deg;
  for (const MapNode& node : map.nodes) bounds_deg.extend(node.geographic_deg);
  return (bounds_deg.center() * 100.0).array().round() / 100.0;
}

std::string LocalDefinition(const Eigen::Vector2d& middle_deg) {
  return "+proj=tmerc +lat_0=" + NumberText(middle_deg.y()) +
         " +lon_0=" + NumberText(middle_deg.x()) +
         " +k=1 +x_0=0 +y_0=0 +ellps=WGS84 +units=m +type=crs";
}

/// What is wrong with a coordinate system for a world in metres; empty: nothing.
std::string FaultOf(PJ_CONTEXT* context, const PJ* system) {
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

ProjObject TransformationTo(PJ_CONTEXT* context, const std::string& definition) {
  const ProjObject system(proj_create(context, definition.c_str()));
  if (!system) {
    throw InputError(
        "--crs: must be a coordinate system that PROJ knows, such as EPSG:31256 (got " +
        ShownText(definition) + ")");
  }
  if (const std::string fault = FaultOf(context, system.get()); !fault.empty()) {
    throw InputError("--crs: " + fault + " (got " + ShownText(definition) + ")");
  }
  const ProjObject as_defined(
      proj_create_crs_to_crs(context, kGeographic, definition.c_str(), nullptr));
  if (!as_defined) {
    throw InputError("--crs: must be reachable from WGS 84 (got " + ShownText(definition) + ")");
  }
  // Longitude before latitude, and easting before northing, whatever the systems say.
  return ProjObject(proj_normalize_for_visualization(context, as_defined.get()));
}

}  // namespace

MapProjection ProjectMap(const std::string& definition, RailMap& map) {
  const ProjContext context(proj_context_create());
  // Faults are reported as errors of the input.
  proj_log_level(context.get(), PJ_LOG_NONE);
  const bool is_local = definition.empty();
  const Eigen::Vector2d middle_deg = MiddleOf_deg(map);
  MapProjection projection{is_local ? LocalDefinition(middle_deg) : definition, {0.0, 0.0}};
  const ProjObject projected_from_geographic =
      TransformationTo(context.get(), projection.definition);
  const auto project = [&](const Eigen::Vector2d& place_deg) -> Eigen::Vector2d {
    const PJ_COORD place = proj_trans(projected_from_geographic.get(), PJ_FWD,
                                      proj_coord(place_deg.x(), place_deg.y(), 0.0, 0.0));
    return {place.xy.x, place.xy.y};
  };
  if (!is_local) projection.origin_m = project(middle_deg).array().round();
  for (MapNode& node : map.nodes) {
    node.place_m = project(node.geographic_deg) - projection.origin_m;
    if (node.place_m.allFinite()) continue;
    throw InputError("--crs: must cover the map, also " + NumberText(node.geographic_deg.x()) +
                     ", " + NumberText(node.geographic_deg.y()) + " degrees (got " +
                     ShownText(projection.definition) + ")");
  }
  return projection;
}

}  // namespace railcast
