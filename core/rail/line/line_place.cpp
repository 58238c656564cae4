#include "core/rail/line/line_place.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace railcast {
namespace {

constexpr int kPlaceSteps = 12;
constexpr double kExact_m = 1e-6;
// Beyond the centre of a curve, steps must not change their direction.
constexpr double kLeastStretch = 0.2;

double Distance_m(const Alignment& alignment, double s_m, const Eigen::Vector2d& place_m) {
  return (alignment.At(s_m).position_m.head<2>() - place_m).norm();
}

/// No ground is so wide.
constexpr double kFar_m = 2000.0;

/// Chainages of the line so close to each other that the nearest places of the line are beside some
/// of them, near enough for PlaceOnLine().
std::vector<double> ChainagesNear_m(const Alignment& alignment, const Eigen::Vector2d& place_m) {
  // The tightest arc of a line has a radius of 10 m.
  constexpr double kSpacing_m = 5.0;
  // Within such steps the distance changes by a hundred-thousandth at most.
  constexpr double kStepOfFar = 0.01;
  struct Sample {
    double s_m{};
    double distance_m{};
  };
  std::vector<Sample> samples;
  double least_m = std::numeric_limits<double>::infinity();
  double s_m = 0.0;
  while (true) {
    const double distance_m = Distance_m(alignment, s_m, place_m);
    least_m = std::min(least_m, distance_m);
    if (distance_m <= least_m + kSpacing_m) samples.push_back({s_m, distance_m});
    if (!(s_m < alignment.length_m())) break;
    // Chainage is arc length in plan, so that the line comes no nearer any faster.
    const double step_m =
        std::max({kSpacing_m, distance_m - least_m, kStepOfFar * (distance_m - kFar_m)});
    s_m = std::min(s_m + step_m, alignment.length_m());
  }
  std::vector<double> near_s_m;
  for (const Sample& sample : samples) {
    if (sample.distance_m <= least_m + kSpacing_m) near_s_m.push_back(sample.s_m);
  }
  return near_s_m;
}

}  // namespace

PlaceBesideLine PlaceOnLine(const Alignment& alignment,
                            const Vector3& place_world_m,
                            double near_s_m) {
  PlaceBesideLine place{.s_m = near_s_m};
  for (int i = 0; i < kPlaceSteps; ++i) {
    const AxisPoint axis = alignment.At(place.s_m);
    const Eigen::Vector2d ahead(std::cos(axis.heading_rad), std::sin(axis.heading_rad));
    const Vector3 from_axis_m = place_world_m - axis.position_m;
    place.d_m = ahead.x() * from_axis_m.y() - ahead.y() * from_axis_m.x();
    place.h_m = from_axis_m.z();
    const double step_m = ahead.dot(from_axis_m.head<2>()) /
                          std::max(kLeastStretch, 1.0 - axis.curvature_per_m * place.d_m);
    place.s_m += step_m;
    if (std::abs(step_m) < kExact_m) break;
  }
  return place;
}

std::vector<PlaceBesideLine> NearestOnLine(const Alignment& alignment,
                                           const Eigen::Vector2d& place_m) {
  constexpr double kApart_m = 1.0;
  struct Found {
    PlaceBesideLine place;
    double distance_m{};
  };
  const std::vector<double> chainages_m = ChainagesNear_m(alignment, place_m);
  const double about_m = Distance_m(alignment, chainages_m.front(), place_m);
  if (about_m > kFar_m) return {{.s_m = chainages_m.front(), .d_m = about_m}};
  std::vector<Found> all;
  double least_m = std::numeric_limits<double>::infinity();
  for (const double near_s_m : chainages_m) {
    const PlaceBesideLine place = PlaceOnLine(alignment, {place_m.x(), place_m.y(), 0.0}, near_s_m);
    const double on_line_m = std::clamp(place.s_m, 0.0, alignment.length_m());
    all.push_back({place, Distance_m(alignment, on_line_m, place_m)});
    least_m = std::min(least_m, all.back().distance_m);
  }
  std::erase_if(all, [&](const Found& found) { return found.distance_m > least_m + kTie_m; });
  std::ranges::sort(all, {}, [](const Found& found) { return found.place.s_m; });
  std::vector<PlaceBesideLine> nearest;
  for (const Found& found : all) {
    const bool is_new = nearest.empty() || found.place.s_m > nearest.back().s_m + kApart_m;
    if (is_new) nearest.push_back(found.place);
  }
  return nearest;
}

PlaceBesideTrack PlaceOnTrack(const Alignment& alignment,
                              const TrackCourse& course,
                              const Eigen::Vector2d& place_m,
                              double near_s_m) {
  PlaceBesideTrack place{near_s_m, 0.0};
  for (int i = 0; i < kPlaceSteps; ++i) {
    const AxisPoint axis = alignment.At(place.s_m);
    const TrackOffset offset = course.OffsetAt(place.s_m);
    const Transform world_from_track = course.WorldFromTrack(alignment, place.s_m);
    const Eigen::Vector2d ahead = world_from_track.linear().col(0).head<2>().normalized();
    const Eigen::Vector2d from_axis_m = place_m - world_from_track.translation().head<2>();
    place.d_m = ahead.x() * from_axis_m.y() - ahead.y() * from_axis_m.x();
    const double step_m =
        ahead.dot(from_axis_m) /
        std::max(kLeastStretch, 1.0 - course.CurvatureAt(alignment, place.s_m) * place.d_m);
    // The track is longer than the chainage outside of the alignment and at an angle to it.
    place.s_m += step_m * std::cos(TurnFromAlignment_rad(axis, offset)) /
                 std::max(kLeastStretch, 1.0 - axis.curvature_per_m * offset.d_m);
    if (std::abs(step_m) < kExact_m) break;
  }
  return place;
}

}  // namespace railcast
