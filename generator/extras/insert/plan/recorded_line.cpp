#include "generator/extras/insert/plan/recorded_line.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rail/line/line_place.h"

namespace railcast {
namespace {

/// The spacing of the spline's points: at 5 m an error of 1 cm would turn the line by 0.1 deg.
constexpr double kSpacing_m = 10.0;

Eigen::Vector2d InPlan(const Vector3& place_m) {
  return place_m.head<2>();
}

std::string FrameText(const std::string& source, std::size_t frame) {
  return source + ": frame " + NumberText(frame);
}

/// Whether the vehicle moves the way it faces, as it does for most of its way.
bool RunsForwards(const RecordedWay& way, const std::string& source) {
  double ahead_m = 0.0;
  double along_m = 0.0;
  double length_m = 0.0;
  for (std::size_t i = 1; i < way.at_frames.size(); ++i) {
    const Transform& before = way.at_frames[i - 1];
    const Vector3 step_m = way.at_frames[i].translation() - before.translation();
    const double step_ahead_m = step_m.dot(before.linear().col(0));
    ahead_m += step_ahead_m;
    along_m += std::abs(step_ahead_m);
    length_m += step_m.norm();
  }
  constexpr double kLeastWay_m = 20.0;
  constexpr double kLeastShare = 0.7;  // A vehicle that moves at 45 deg to the way it faces.
  if (length_m >= kLeastWay_m && along_m < kLeastShare * length_m) {
    throw InputError(source + ": the vehicle must move along its x axis (got " +
                     ShortText(std::round(along_m)) + " m of " + ShortText(length_m) +
                     " m): its axes are x forward, y left, z up, and lidar.mount says where the "
                     "sensor is in them");
  }
  return ahead_m >= 0.0;
}

/// The places of the vehicle so far apart, in the order of rising chainage.
std::vector<Vector3> SpacedPlaces(const RecordedWay& way,
                                  bool is_forwards,
                                  const std::string& source) {
  std::vector<Vector3> places;
  const std::size_t num_frames = way.at_frames.size();
  for (std::size_t i = 0; i < num_frames; ++i) {
    const std::size_t frame = is_forwards ? i : num_frames - 1 - i;
    const Vector3 place = way.at_frames[frame].translation();
    if (places.empty()) {
      places.push_back(place);
      continue;
    }
    const Eigen::Vector2d step_m = InPlan(place - places.back());
    const bool is_last = i + 1 == num_frames;
    if (is_last && places.size() > 1 && step_m.norm() < 0.5 * kSpacing_m) places.back() = place;
    if (step_m.norm() < (is_last ? 0.5 * kSpacing_m : kSpacing_m)) continue;
    if (places.size() > 1) {
      const Eigen::Vector2d last_m = InPlan(places.back() - places[places.size() - 2]);
      if (step_m.dot(last_m) <= 0.0) {
        throw InputError(FrameText(source, frame) +
                         ": the vehicle must not turn back on its way; the plan must give the line "
                         "as /world/recording/alignment");
      }
    }
    places.push_back(place);
  }
  return places;
}

/// A direction in plan, and its rise per metre.
struct LineDirection {
  Eigen::Vector2d plan;
  double gradient{};
};

LineDirection LineDirectionOf(const Vector3& step_m) {
  const double length_m = InPlan(step_m).norm();
  return {InPlan(step_m) / length_m, step_m.z() / length_m};
}

/// The tangent at the end of places on a circle, of which the last two steps are chords.
/// @param end The last place, and those before it.
LineDirection TangentAt(const Vector3& end,
                        const Vector3& before,
                        const std::optional<Vector3>& first) {
  LineDirection direction = LineDirectionOf(end - before);
  if (!first) return direction;
  const Eigen::Vector2d last = direction.plan;
  const Eigen::Vector2d earlier = LineDirectionOf(before - *first).plan;
  const double turn_rad =
      std::atan2(earlier.x() * last.y() - earlier.y() * last.x(), earlier.dot(last));
  const double share = InPlan(end - before).norm() / InPlan(end - *first).norm();
  direction.plan = Eigen::Rotation2Dd(share * turn_rad) * last;
  return direction;
}

/// Continues the line straight from its end.
std::vector<Vector3> Continuation(const Vector3& end, const LineDirection& direction) {
  std::vector<Vector3> places;
  for (double length_m = kSpacing_m; length_m <= RecordedLine::kBeyondPath_m;
       length_m += kSpacing_m) {
    const Eigen::Vector2d plan_m = InPlan(end) + length_m * direction.plan;
    places.emplace_back(plan_m.x(), plan_m.y(), end.z() + length_m * direction.gradient);
  }
  return places;
}

/// The driven places with what is added before and behind them.
std::vector<Vector3> WithContinuations(const std::vector<Vector3>& driven, const Vector3& facing) {
  LineDirection ahead = LineDirectionOf(facing);
  LineDirection behind = LineDirectionOf(-facing);
  const std::size_t n = driven.size();
  if (n > 1) {
    const auto third = [&](std::size_t i) {
      return n > 2 ? std::optional(driven[i]) : std::nullopt;
    };
    ahead = TangentAt(driven[n - 1], driven[n - 2], third(n < 3 ? 0 : n - 3));
    behind = TangentAt(driven[0], driven[1], third(2 < n ? 2 : 0));
  }
  std::vector<Vector3> places = Continuation(driven.front(), behind);
  std::ranges::reverse(places);
  places.insert(places.end(), driven.begin(), driven.end());
  const std::vector<Vector3> after = Continuation(driven.back(), ahead);
  places.insert(places.end(), after.begin(), after.end());
  return places;
}

/// Makes the line rise from place to place.
void AddGradients(const std::vector<Vector3>& places, AlignmentSpec& alignment) {
  const Alignment level(alignment);
  double before_s_m = 0.0;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double length_m = InPlan(places[i] - places[i - 1]).norm();
    const double s_m = PlaceOnLine(level, places[i], before_s_m + length_m).s_m;
    const double rise_m = places[i].z() - places[i - 1].z();
    alignment.gradients_permil.push_back({before_s_m, 1000.0 * rise_m / (s_m - before_s_m)});
    before_s_m = s_m;
  }
}

/// Where the vehicle is in each frame.
/// @param near_s_m About where it is in the first one.
void FindVehicle(const RecordedWay& way, double near_s_m, RecordedLine& line) {
  const Alignment alignment(line.alignment);
  for (std::size_t i = 0; i < way.at_frames.size(); ++i) {
    const Transform& vehicle = way.at_frames[i];
    if (i > 0) {
      const Vector3 step_m = vehicle.translation() - way.at_frames[i - 1].translation();
      const double heading_rad = alignment.At(near_s_m).heading_rad;
      near_s_m += step_m.x() * std::cos(heading_rad) + step_m.y() * std::sin(heading_rad);
    }
    near_s_m = PlaceOnLine(alignment, vehicle.translation(), near_s_m).s_m;
    const double heading_rad = alignment.At(near_s_m).heading_rad;
    const Vector3 facing = vehicle.linear().col(0);
    line.at_frames_m.push_back(near_s_m);
    line.faces_up.push_back(
        facing.x() * std::cos(heading_rad) + facing.y() * std::sin(heading_rad) >= 0.0);
  }
}

}  // namespace

RecordedLine LineOfWay(const RecordedWay& way, const std::string& source) {
  const bool is_forwards = RunsForwards(way, source);
  const std::vector<Vector3> places = WithContinuations(SpacedPlaces(way, is_forwards, source),
                                                        way.at_frames.front().linear().col(0));
  RecordedLine line;
  // Plan points near 0, as far as the world's may be from it.
  const Vector3& origin = places.front();
  line.alignment.origin_m = {origin.x(), origin.y(), origin.z()};
  AlignmentSplineSpec spline;
  for (const Vector3& place : places) {
    spline.points_m.push_back({place.x() - origin.x(), place.y() - origin.y()});
  }
  line.alignment.course = std::move(spline);
  line.alignment.gradient_smoothing_m = kSpacing_m;
  AtPlace(source + ": the driven path: ", [&] {
    AddGradients(places, line.alignment);
    const double length_m = Alignment(line.alignment).length_m();
    FindVehicle(way,
                is_forwards ? RecordedLine::kBeyondPath_m : length_m - RecordedLine::kBeyondPath_m,
                line);
  });
  line.zero_s_m = line.at_frames_m.front();
  return line;
}

RecordedLine GivenLine(const AlignmentSpec& alignment,
                       const RecordedWay& way,
                       const std::string& source) {
  RecordedLine line{.alignment = alignment};
  const Alignment axis(alignment);
  const std::vector<PlaceBesideLine> nearest =
      NearestOnLine(axis, InPlan(way.at_frames.front().translation()));
  FindVehicle(way, nearest.front().s_m, line);
  // Half the width of a station: the vehicle may run on another track of the line.
  constexpr double kFarthest_m = 100.0;
  for (std::size_t i = 0; i < way.at_frames.size(); ++i) {
    const double s_m = line.at_frames_m[i];
    if (!(s_m >= 0.0 && s_m <= axis.length_m())) {
      throw InputError(FrameText(source, i) +
                       ": the vehicle must be beside the plan's alignment, " + "from 0 to " +
                       ShortText(axis.length_m()) + " m, in whose world the poses are (got " +
                       ShortText(s_m) + " m)");
    }
    const Eigen::Vector2d axis_m = InPlan(axis.At(s_m).position_m);
    const double distance_m = (InPlan(way.at_frames[i].translation()) - axis_m).norm();
    if (distance_m <= kFarthest_m) continue;
    throw InputError(FrameText(source, i) + ": the vehicle must be within " +
                     NumberText(kFarthest_m) +
                     " m of the plan's alignment, in whose world the poses are (got " +
                     ShortText(distance_m) + " m)");
  }
  return line;
}

}  // namespace railcast
