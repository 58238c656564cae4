#include "generator/check/check_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/text.h"
#include "core/rail/motion/speed_profile.h"
#include "core/rail/network/network.h"
#include "core/rail/network/route.h"

namespace railcast {
namespace {

constexpr double kGravity_mps2 = 9.80665;

std::string MetreText(double length_m) {
  return NumberText(std::round(length_m * 10.0) / 10.0) + " m";
}

/// What is measured along a track.
struct TrackMeasures {
  double length_m{};
  double tightest_m = std::numeric_limits<double>::infinity();
  double tightest_s_m{};
};

/// Sampled every metre of chainage or less.
TrackMeasures MeasureTrack(const Alignment& alignment, const TrackCourse& track) {
  const double range_m = track.end_s_m() - track.begin_s_m();
  const double num_steps = std::ceil(range_m);
  TrackMeasures measures;
  // Radii that are longer are straights with rounding.
  constexpr double kStraight_per_m = 1e-9;
  for (double step = 0.0; step < num_steps; ++step) {
    const double s_m = track.begin_s_m() + range_m * (step + 0.5) / num_steps;
    const TrackOffset offset = track.OffsetAt(s_m);
    measures.length_m +=
        range_m / num_steps *
        std::hypot(1.0 - alignment.At(s_m).curvature_per_m * offset.d_m, offset.slope);
    const double curvature_per_m = std::abs(track.CurvatureAt(alignment, s_m));
    if (curvature_per_m < kStraight_per_m || 1.0 / curvature_per_m >= measures.tightest_m) continue;
    measures.tightest_m = 1.0 / curvature_per_m;
    measures.tightest_s_m = s_m;
  }
  return measures;
}

std::string TurnoutText(const RailWorld& world, const TurnoutSite& turnout) {
  std::string text = "  turnout " + std::string(NameOf(turnout.type)) + " of track " +
                     Quoted(world.tracks()[turnout.branch].name) + " at s " +
                     MetreText(turnout.s_m) + ": to the " + std::string(NameOf(turnout.side)) +
                     ", opens with " + (turnout.opens_ahead() ? "rising" : "falling") +
                     " chainage, set " + std::string(NameOf(turnout.position));
  if (turnout.fouling_s_m) text += ", fouling point at s " + MetreText(*turnout.fouling_s_m);
  return text;
}

std::string DiamondText(const RailWorld& world, const DiamondSite& diamond) {
  const double n = 1.0 / std::tan(diamond.angle_rad);
  return "  crosses track " + Quoted(world.tracks()[diamond.second].name) + " at s " +
         MetreText(diamond.s_m) + ": 1:" + NumberText(std::round(n * 10.0) / 10.0) +
         ", frogs and check rails from s " + MetreText(diamond.begin_s_m) + " to " +
         MetreText(diamond.end_s_m);
}

/// In the plane of the rails, positive towards the outside of the curve.
double UnbalancedAt_mps2(const RailWorld& world, double s_m, double speed_mps) {
  const double roll_rad = world.alignment().At(s_m).cant_rad;
  const double curvature_per_m = world.vehicle_course().CurvatureAt(world.alignment(), s_m);
  // In a left curve, the roll of a canted track is negative.
  return std::copysign(1.0, curvature_per_m) *
         (speed_mps * speed_mps * curvature_per_m + kGravity_mps2 * std::sin(roll_rad));
}

}  // namespace

std::string NetworkText(const RailWorld& world) {
  const std::vector<TrackSpec>& tracks = world.tracks();
  if (tracks.size() < 2) return "";
  std::string text;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const TrackCourse& course = world.network().courses[i];
    const TrackMeasures measures = MeasureTrack(world.alignment(), course);
    text += ReportLine(i == 0 ? "tracks" : "",
                       Quoted(tracks[i].name) + ": " + MetreText(measures.length_m) + " from s " +
                           MetreText(course.begin_s_m()) + " to " + MetreText(course.end_s_m()) +
                           (std::isinf(measures.tightest_m)
                                ? ", straight"
                                : ", tightest radius " + MetreText(measures.tightest_m) + " at s " +
                                      MetreText(measures.tightest_s_m)));
    for (const TurnoutSite& turnout : world.network().turnouts) {
      if (turnout.track == i) text += ReportLine("", TurnoutText(world, turnout));
    }
    for (const DiamondSite& diamond : world.network().diamonds) {
      if (diamond.first == i) text += ReportLine("", DiamondText(world, diamond));
    }
  }
  return text;
}

std::string StartTrack(const RailWorld& world, const VehicleSpec& vehicle) {
  const std::vector<RouteSection>& sections = world.vehicle_route().sections;
  const auto section = std::ranges::find_if(sections, [&](const RouteSection& candidate) {
    return vehicle.start_s_m <= candidate.end_s_m;
  });
  return world.tracks()[section == sections.end() ? sections.back().track : section->track].name;
}

std::optional<LateralPeak> FindLateralPeak(const RailWorld& world,
                                           const VehicleSpec& vehicle,
                                           const VehicleWay& way) {
  constexpr double kStep_s = 0.02;
  constexpr double kLongest_s = 4.0 * 3600.0;
  constexpr double kSmallest_mps2 = 1e-6;
  const SpeedProfile profile(vehicle.motion, vehicle.start_s_m);
  if (!profile.moves()) return std::nullopt;
  const double profile_s = way.profile_end ? way.profile_end->time_s : 0.0;
  const double end_s =
      std::min(kLongest_s, way.track_end ? way.track_end->time_s : profile_s + 3600.0);
  LateralPeak peak;
  for (double step = 0.0; step * kStep_s <= end_s; ++step) {
    const double time_s = step * kStep_s;
    const SpeedProfile::State state = profile.At(time_s);
    const double unbalanced_mps2 = UnbalancedAt_mps2(world, state.s_m, state.speed_mps);
    if (state.speed_mps == 0.0 && time_s > profile_s) break;
    if (unbalanced_mps2 <= std::max(kSmallest_mps2, peak.acceleration_mps2)) continue;
    peak.acceleration_mps2 = unbalanced_mps2;
    peak.balanced_mps2 =
        kGravity_mps2 * std::abs(std::sin(world.alignment().At(state.s_m).cant_rad));
    peak.point = {time_s, state.s_m, state.speed_mps};
  }
  return peak.acceleration_mps2 > 0.0 ? std::optional(peak) : std::nullopt;
}

std::string RouteText(const RailWorld& world, const std::optional<LateralPeak>& peak) {
  std::string names;
  const Route& route = world.vehicle_route();
  for (const std::string& name : route.names) names += (names.empty() ? "" : ", ") + Quoted(name);
  std::string text;
  if (route.names.size() > 1) text += ReportLine("", "its route is " + names);
  if (!peak || world.tracks().size() < 2) return text;
  return text +
         ReportLine("", "has its largest lateral acceleration of " +
                            ShortText(peak->acceleration_mps2) + " m/s^2 at s " +
                            MetreText(peak->point.s_m) + " with " +
                            ShortText(peak->point.speed_mps) + " m/s, of which cant has balanced " +
                            ShortText(peak->balanced_mps2) + " m/s^2");
}

}  // namespace railcast
