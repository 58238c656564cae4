#include "viewer/plan/plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rail/network/network.h"
#include "core/rail/network/route.h"
#include "viewer/overlays/overlays.h"

namespace railcast {

namespace {

constexpr Rgb kPaperRgb{110, 110, 115};
constexpr Rgb kRouteRgb{255, 255, 255};
constexpr Rgb kObjectRgb{250, 190, 250};
constexpr double kRouteWidth_px = 9.0;
constexpr float kRouteOpacity = 0.3F;
constexpr double kTrackWidth_px = 2.0;
// The chainage ticks reach this share of the stretch beyond the outermost tracks.
constexpr double kTickShare = 1.0 / 60.0;
constexpr double kMostTicks = 12.0;

PlanStretch ExtentOf(const TrackCourse& course) {
  return {.from_s_m = course.begin_s_m(), .to_s_m = course.end_s_m()};
}

Eigen::Vector2d OnTrack(const PlanScene& scene, const TrackCourse& course, double s_m) {
  return scene.frame.At(course.WorldFromTrack(scene.world.alignment(), s_m).translation());
}

/// The chainages across all tracks, with their words beyond the leftmost one.
void AddTicks(const PlanScene& scene, Plan& plan) {
  const Alignment& alignment = scene.world.alignment();
  const double beyond_m = kTickShare * scene.stretch.length_m();
  const TrackCourse axis(scene.stretch.from_s_m, scene.stretch.to_s_m, 0.0);
  plan.lines.push_back({.points_m = PlanPoints(scene, axis, scene.stretch, 0.0), .rgb = kPaperRgb});
  for (const double s_m : WholeChainages_m(scene.stretch.from_s_m, scene.stretch.to_s_m,
                                           RoundUp125(scene.stretch.length_m() / kMostTicks))) {
    double least_d_m = 0.0;
    double most_d_m = 0.0;
    for (const TrackCourse& course : scene.world.network().courses) {
      if (!ExtentOf(course).Holds(s_m)) continue;
      least_d_m = std::min(least_d_m, course.OffsetAt(s_m).d_m);
      most_d_m = std::max(most_d_m, course.OffsetAt(s_m).d_m);
    }
    const auto at = [&](double d_m) {
      return scene.frame.At(alignment.WorldFromTrack(s_m, d_m).translation());
    };
    const Eigen::Vector2d left_m = at(most_d_m + beyond_m);
    plan.lines.push_back({.points_m = {at(least_d_m - beyond_m), left_m}, .rgb = kPaperRgb});
    plan.words.push_back({left_m, ChainageText(s_m), {225, 225, 225}, true});
  }
}

void AddRoute(const PlanScene& scene, Plan& plan) {
  const TrackCourse& course = scene.world.vehicle_course();
  std::vector<Eigen::Vector2d> points_m = PlanPoints(scene, course, ExtentOf(course), 0.0);
  if (points_m.empty()) return;
  plan.lines.push_back({std::move(points_m), kRouteRgb, kRouteWidth_px, kRouteOpacity});
  plan.entries.push_back({"route of the vehicle", kRouteRgb, Plan::Sample::kBand});
}

/// Whether a track ends in another one, where a name would stand on that.
bool EndsInTurnout(const Network& network, std::size_t track) {
  return std::ranges::any_of(network.turnouts, [&](const TurnoutSite& turnout) {
    return turnout.branch == track && !turnout.opens_ahead();
  });
}

void AddTracks(const PlanScene& scene, Plan& plan) {
  const Network& network = scene.world.network();
  for (std::size_t i = 0; i < network.courses.size(); ++i) {
    const TrackCourse& course = network.courses[i];
    std::vector<Eigen::Vector2d> points_m = PlanPoints(scene, course, ExtentOf(course), 0.0);
    if (points_m.empty()) continue;
    const std::string& name = scene.world.tracks()[i].name;
    const Rgb rgb = PlanTrackRgb(i);
    if (!EndsInTurnout(network, i)) plan.words.push_back({points_m.back(), name, rgb, false});
    plan.lines.push_back({std::move(points_m), rgb, kTrackWidth_px});
    plan.entries.push_back({name, rgb, Plan::Sample::kLine});
  }
}

void AddTurnouts(const PlanScene& scene, Plan& plan) {
  std::array<bool, 2> are_there{};
  for (const TurnoutSite& turnout : scene.world.network().turnouts) {
    if (!scene.stretch.Holds(turnout.s_m)) continue;
    const TrackCourse& course = scene.world.network().courses[turnout.track];
    const bool is_diverging = turnout.position == TurnoutPosition::kDiverging;
    const Eigen::Vector2d tip_m = OnTrack(scene, course, turnout.s_m);
    plan.marks.push_back({tip_m, (OnTrack(scene, course, turnout.end_s_m) - tip_m).normalized(),
                          is_diverging ? kPlanDivergingRgb : kPlanStraightRgb});
    are_there[is_diverging ? 1 : 0] = true;
  }
  if (are_there[0]) {
    plan.entries.push_back({"turnout set straight", kPlanStraightRgb, Plan::Sample::kTriangle});
  }
  if (are_there[1]) {
    plan.entries.push_back({"turnout set diverging", kPlanDivergingRgb, Plan::Sample::kTriangle});
  }
}

/// Objects at time 0: the outlines of their boxes, and squares that are also seen on small scales.
void AddObjects(const PlanScene& scene, Plan& plan) {
  bool is_any = false;
  const auto& objects = scene.world.objects();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].is_ego || !scene.stretch.Holds(scene.world.ObjectChainage_m(i, 0))) continue;
    const Transform world_from_object = scene.world.WorldFromObject(i, 0);
    const Eigen::AlignedBox3d box = objects[i].model->Bounds();
    const auto corner = [&](double x_m, double y_m) {
      return scene.frame.At(world_from_object * Vector3(x_m, y_m, 0.0));
    };
    plan.lines.push_back(
        {.points_m = {corner(box.min().x(), box.min().y()), corner(box.max().x(), box.min().y()),
                      corner(box.max().x(), box.max().y()), corner(box.min().x(), box.max().y()),
                      corner(box.min().x(), box.min().y())},
         .rgb = kObjectRgb});
    plan.marks.push_back(
        {corner(box.center().x(), box.center().y()), Eigen::Vector2d::Zero(), kObjectRgb});
    is_any = true;
  }
  if (is_any) plan.entries.push_back({"object", kObjectRgb, Plan::Sample::kSquare});
}

}  // namespace

PlanStretch NetworkStretch(const RailWorld& world) {
  const double line_m = world.alignment().length_m();
  PlanStretch stretch{.from_s_m = std::numeric_limits<double>::infinity(),
                      .to_s_m = -std::numeric_limits<double>::infinity()};
  const auto include = [&](double s_m) {
    stretch.from_s_m = std::min(stretch.from_s_m, s_m);
    stretch.to_s_m = std::max(stretch.to_s_m, s_m);
  };
  for (const TrackCourse& course : world.network().courses) {
    if (course.begin_s_m() <= 0.0 && course.end_s_m() >= line_m) continue;
    include(course.begin_s_m());
    include(course.end_s_m());
  }
  for (const TurnoutSite& turnout : world.network().turnouts) {
    include(turnout.s_m);
    include(turnout.end_s_m);
  }
  if (stretch.from_s_m > stretch.to_s_m) return {.from_s_m = 0.0, .to_s_m = line_m};
  return {.from_s_m = std::max(0.0, stretch.from_s_m - kPlanMargin_m),
          .to_s_m = std::min(line_m, stretch.to_s_m + kPlanMargin_m)};
}

PlanStretch ChosenStretch(const RailWorld& world,
                          const std::optional<std::array<double, 2>>& ends_m) {
  if (!ends_m) return NetworkStretch(world);
  const auto [from_s_m, to_s_m] = *ends_m;
  const double line_m = world.alignment().length_m();
  if (!(from_s_m >= 0.0 && from_s_m < to_s_m && to_s_m <= line_m)) {
    throw InputError("--stretch: must be two chainages from 0 to " + NumberText(line_m) +
                     ", the lesser first (got " + NumberText(from_s_m) + " and " +
                     NumberText(to_s_m) + ")");
  }
  return {.from_s_m = from_s_m, .to_s_m = to_s_m};
}

double RoundUp125(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * power >= value) return digit * power;
  }
  return 10.0 * power;
}

Eigen::Vector2d PlanFrame::Turned(const Eigen::Vector2d& world) const {
  return {ahead.dot(world), ahead.x() * world.y() - ahead.y() * world.x()};
}

Eigen::Vector2d PlanFrame::At(const Vector3& world_m) const {
  return Turned(world_m.head<2>() - origin_m);
}

PlanScene ScenePlanned(const ScenarioSpec& scenario,
                       const RailWorld& world,
                       const PlanStretch& stretch) {
  const AxisPoint begin = world.alignment().At(stretch.from_s_m);
  const Eigen::Vector2d chord_m =
      (world.alignment().At(stretch.to_s_m).position_m - begin.position_m).head<2>();
  // A line may end where it begins.
  constexpr double kLeastChord_m = 1e-3;
  return {.scenario = scenario,
          .world = world,
          .stretch = stretch,
          .frame = {.origin_m = begin.position_m.head<2>(),
                    .ahead = chord_m.norm() < kLeastChord_m
                                 ? Eigen::Vector2d(std::cos(begin.heading_rad),
                                                   std::sin(begin.heading_rad))
                                 : chord_m.normalized()}};
}

Rgb PlanTrackRgb(std::size_t track) {
  constexpr std::array<Rgb, 7> kTrackRgb = {kSkyBlue,       kOrange,     kBluishGreen, kYellow,
                                            kReddishPurple, kVermillion, kBlue};
  return kTrackRgb[track % kTrackRgb.size()];
}

std::vector<Eigen::Vector2d> PlanPoints(const PlanScene& scene,
                                        const TrackCourse& course,
                                        const PlanStretch& part,
                                        double d_m) {
  const double from_s_m = std::max({part.from_s_m, course.begin_s_m(), scene.stretch.from_s_m});
  const double to_s_m = std::min({part.to_s_m, course.end_s_m(), scene.stretch.to_s_m});
  std::vector<Eigen::Vector2d> points_m;
  if (!(from_s_m < to_s_m)) return points_m;
  // No picture has so many pixels that its tracks would look angular.
  const double step_m = std::max(1.0, scene.stretch.length_m() / 4000.0);
  const double num_steps = std::ceil((to_s_m - from_s_m) / step_m);
  for (double step = 0.0; step <= num_steps; ++step) {
    const double s_m = from_s_m + (to_s_m - from_s_m) * step / num_steps;
    points_m.push_back(
        scene.frame.At(course.WorldFromTrack(scene.world.alignment(), s_m, d_m).translation()));
  }
  return points_m;
}

Plan MakePlan(const ScenarioSpec& scenario, const RailWorld& world, const PlanStretch& stretch) {
  const PlanScene scene = ScenePlanned(scenario, world, stretch);
  Plan plan;
  plan.stretch = stretch;
  plan.north = scene.frame.Turned({0.0, 1.0});
  AddTicks(scene, plan);
  AddRoute(scene, plan);
  AddTracks(scene, plan);
  AddStructuresToPlan(scene, plan);
  AddTurnouts(scene, plan);
  AddObjects(scene, plan);
  return plan;
}

}  // namespace railcast
