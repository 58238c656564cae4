#include "generator/extras/import/map/map_projection.h"

#include <geodesic.h>
#include <proj.h>
#include <Eigen/Geometry>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rail/line/map_place.h"
#include "railcast/alignment.h"

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

/// The terms of MapSpec::coefficients_m up to the fifth order.
Eigen::RowVectorXd PolynomialTerms(const Eigen::Vector2d& place) {
  constexpr int kOrder = 5;
  Eigen::RowVectorXd terms((kOrder + 1) * (kOrder + 2) / 2);
  Eigen::Index i = 0;
  for (int order = 0; order <= kOrder; ++order) {
    for (int of_y = 0; of_y <= order; ++of_y) {
      terms[i++] = std::pow(place.x(), order - of_y) * std::pow(place.y(), of_y);
    }
  }
  return terms;
}

/// Fits the polynomial that makes the world's metres of those of the transverse Mercator about the
/// middle of the map, to a grid over the map and at least 20 km about its middle.
/// @param world_from_deg Not finite where the projection cannot be used.
template <typename Project>
std::vector<std::array<double, 2>> FittedPolynomial_m(const Eigen::Vector2d& middle_deg,
                                                      const Eigen::AlignedBox2d& bounds_deg,
                                                      const Project& world_from_deg) {
  constexpr int kNumSteps = 10;
  constexpr double kLeast_deg = 0.2;
  const MapSpec local{{0.0, 0.0}, middle_deg.x(), middle_deg.y(), {}};
  const Eigen::Vector2d half_deg = (0.5 * bounds_deg.sizes()).cwiseMax(kLeast_deg);
  std::vector<Eigen::RowVectorXd> terms;
  std::vector<Eigen::RowVector2d> places_m;
  for (int i = 0; i <= kNumSteps; ++i) {
    for (int j = 0; j <= kNumSteps; ++j) {
      const Eigen::Vector2d share(2.0 * i / kNumSteps - 1.0, 2.0 * j / kNumSteps - 1.0);
      const Eigen::Vector2d place_deg = middle_deg + half_deg.cwiseProduct(share);
      const Eigen::Vector2d place_m = world_from_deg(place_deg);
      const Eigen::Vector2d local_m = WorldFromGeographic(local, place_deg.x(), place_deg.y());
      if (!place_m.allFinite() || !local_m.allFinite()) continue;
      terms.push_back(PolynomialTerms(local_m / MapSpec::kUnit_m));
      places_m.emplace_back(place_m);
    }
  }
  if (terms.empty()) return {};
  const auto num_rows = static_cast<Eigen::Index>(terms.size());
  Eigen::MatrixXd left(num_rows, terms.front().size());
  Eigen::MatrixXd right_m(num_rows, 2);
  for (Eigen::Index row = 0; row < num_rows; ++row) {
    left.row(row) = terms[static_cast<std::size_t>(row)];
    right_m.row(row) = places_m[static_cast<std::size_t>(row)];
  }
  // Columns of like size, since those of the highest order are small on a small map.
  const Eigen::RowVectorXd sizes = left.colwise().norm();
  const Eigen::MatrixXd fitted_m =
      (left * sizes.cwiseInverse().asDiagonal()).colPivHouseholderQr().solve(right_m);
  std::vector<std::array<double, 2>> coefficients_m;
  for (Eigen::Index i = 0; i < fitted_m.rows(); ++i) {
    coefficients_m.push_back({fitted_m(i, 0) / sizes[i], fitted_m(i, 1) / sizes[i]});
  }
  return coefficients_m;
}

/// The greatest distance of a node from where a scenario's longitudes and latitudes would place it.
double LargestError_m(const MapProjection& projection, const RailMap& map) {
  const MapSpec spec = MapSpecOf(projection);
  double largest_m = 0.0;
  for (const MapNode& node : map.nodes) {
    const Eigen::Vector2d& there_deg = node.geographic_deg;
    const double error_m =
        (WorldFromGeographic(spec, there_deg.x(), there_deg.y()) - node.place_m).norm();
    if (!(error_m <= largest_m)) largest_m = error_m;
  }
  return largest_m;
}

}  // namespace

MapSpec MapSpecOf(const MapProjection& projection) {
  return {.origin_m = {projection.origin_m.x(), projection.origin_m.y()},
          .longitude_deg = projection.middle_deg.x(),
          .latitude_deg = projection.middle_deg.y(),
          .coefficients_m = projection.coefficients_m};
}

MapProjection ProjectMap(const std::string& definition, RailMap& map) {
  const ProjContext context(proj_context_create());
  // Faults are reported as errors of the input.
  proj_log_level(context.get(), PJ_LOG_NONE);
  const bool is_local = definition.empty();
  const Eigen::AlignedBox2d bounds_deg = BoundsOf_deg(map);
  const Eigen::Vector2d middle_deg = MiddleOf_deg(bounds_deg);
  MapProjection projection{.definition = is_local ? LocalDefinition(middle_deg) : definition,
                           .middle_deg = middle_deg};
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
  if (!is_local) {
    projection.coefficients_m =
        FittedPolynomial_m(middle_deg, bounds_deg, [&](const Eigen::Vector2d& place_deg) {
          return Eigen::Vector2d(project(place_deg) - projection.origin_m);
        });
  }
  constexpr double kLargestError_m = 1.0;
  projection.geographic_error_m = LargestError_m(projection, map);
  if (!is_local && !(projection.geographic_error_m <= kLargestError_m)) {
    RefuseSystem("must be smooth over the map, a polynomial of the fifth order to 1 m",
                 ShownText(projection.definition) + " with " +
                     ShortText(projection.geographic_error_m) + " m");
  }
  return projection;
}

}  // namespace railcast
