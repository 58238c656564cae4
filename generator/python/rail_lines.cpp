#include "generator/python/rail_lines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/rail/line/rail_section.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/network.h"
#include "core/rail/network/route.h"

namespace railcast {
namespace {

struct ChainageStretch {
  double from_s_m{};
  double to_s_m{};
};

/// Draws stretches of courses as the vehicle faces.
struct RailDrawing {
  const Alignment& alignment;
  Transform to_from_world;
  double rail_d_m{};  ///< Middle of the left rail's head.
  bool runs_along{};  ///< Whether the vehicle faces rising chainage.

  [[nodiscard]] RailLines Draw(const std::string& name,
                               const TrackCourse& course,
                               const ChainageStretch& stretch) const {
    std::vector<double> chainages_m = {stretch.from_s_m};
    for (double s_m = std::floor(stretch.from_s_m) + 1.0; s_m < stretch.to_s_m; s_m += 1.0) {
      chainages_m.push_back(s_m);
    }
    chainages_m.push_back(stretch.to_s_m);
    if (!runs_along) std::reverse(chainages_m.begin(), chainages_m.end());
    RailLines lines{.track = name, .is_ego = false, .left_m = {}, .right_m = {}};
    for (const double s_m : chainages_m) {
      const Transform to_from_track = to_from_world * course.WorldFromTrack(alignment, s_m);
      const double left_d_m = runs_along ? rail_d_m : -rail_d_m;
      lines.left_m.emplace_back(to_from_track * Vector3(0.0, left_d_m, 0.0));
      lines.right_m.emplace_back(to_from_track * Vector3(0.0, -left_d_m, 0.0));
    }
    return lines;
  }
};

double RailMiddle_m(const AlignmentSpec& line) {
  const RailSection section = MakeRailSection(/*left=*/true);
  const Eigen::Vector2d middle_m =
      (section.outline_m[section.head_first] + section.outline_m[section.head_last]) / 2.0;
  return middle_m.x() + RailShift_m(line);
}

// What is left of a track within the reach without the parts of it that the route follows.
std::vector<ChainageStretch> BesideRoute(std::size_t track,
                                         const Route& route,
                                         ChainageStretch stretch) {
  std::vector<ChainageStretch> rest;
  for (const RouteSection& section : route.sections) {
    if (section.track != track || section.end_s_m <= stretch.from_s_m ||
        section.begin_s_m >= stretch.to_s_m) {
      continue;
    }
    if (section.begin_s_m > stretch.from_s_m) {
      rest.push_back({stretch.from_s_m, section.begin_s_m});
    }
    stretch.from_s_m = section.end_s_m;
  }
  if (stretch.from_s_m < stretch.to_s_m) rest.push_back(stretch);
  return rest;
}

}  // namespace

std::vector<RailLines> RailLinesAbout(const RailWorld& world,
                                      const AlignmentSpec& line,
                                      std::int64_t time_ns,
                                      const RailReach& reach,
                                      const Transform& to_from_world) {
  const TrackCourse& way = world.vehicle_course();
  const double vehicle_s_m = world.VehicleChainage_m(time_ns);
  const Vector3 forward = world.WorldFromVehicle(time_ns).linear().col(0);
  const Vector3 rising = way.WorldFromTrack(world.alignment(), vehicle_s_m).linear().col(0);
  const RailDrawing drawing{.alignment = world.alignment(),
                            .to_from_world = to_from_world,
                            .rail_d_m = RailMiddle_m(line),
                            .runs_along = forward.dot(rising) > 0.0};
  const bool runs_along = drawing.runs_along;
  const double from_s_m = vehicle_s_m - (runs_along ? reach.behind_m : reach.ahead_m);
  const double to_s_m = vehicle_s_m + (runs_along ? reach.ahead_m : reach.behind_m);
  const auto within = [&](const TrackCourse& course) {
    return ChainageStretch{std::max(from_s_m, course.begin_s_m()),
                           std::min(to_s_m, course.end_s_m())};
  };
  std::vector<RailLines> lines;
  if (const ChainageStretch own = within(way); own.from_s_m < own.to_s_m) {
    lines.push_back(drawing.Draw(world.vehicle_track().name, way, own));
    lines.back().is_ego = true;
  }
  const std::vector<TrackCourse>& courses = world.network().courses;
  for (std::size_t i = 0; i < courses.size(); ++i) {
    for (const ChainageStretch& rest : BesideRoute(i, world.vehicle_route(), within(courses[i]))) {
      lines.push_back(drawing.Draw(world.tracks()[i].name, courses[i], rest));
    }
  }
  return lines;
}

}  // namespace railcast
