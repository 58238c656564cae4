#include "analysis/extras/sight/sight.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/fidelity/sample_frames.h"
#include "core/rail/world/own_track.h"
#include "railcast/rail_world.h"
#include "railcast/ray_caster.h"
#include "railcast/simulator.h"

namespace railcast {
namespace {

// The face of a target is sampled by rays in as many rows as columns. Their number is odd, so that
// an edge straight across or up hides half of the rays exactly where it hides half of the face.
constexpr std::size_t kFewestRows = 5;
constexpr std::size_t kMostRows = 95;

/// Where the sensor is, and the track ahead of it.
struct Lookout {
  const OwnTrack& track;
  Vector3 eye_world_m;
  double chainage_m{};
  double ahead{};    ///< 1 if the chainage rises in the direction of travel, else -1.
  double reach_m{};  ///< How far there is track ahead.

  [[nodiscard]] Transform WorldFromTarget(double distance_m) const {
    return track.WorldFromTrack(chainage_m + ahead * distance_m);
  }
};

/// How the rays at a target fared.
struct TargetView {
  std::size_t num_rays = 0;
  std::size_t num_free = 0;
  std::map<std::uint32_t, std::size_t> hidden_by{};  ///< Rays by the label of what they meet.

  [[nodiscard]] bool is_seen() const { return 2 * num_free >= num_rays; }
  /// More rays can change the verdict only where some were free and some were not.
  [[nodiscard]] bool is_settled() const {
    return num_rays > 0 && (num_free == 0 || num_free == num_rays);
  }
};

double DistanceOfTarget_m(std::size_t target) {
  return kNearestTarget_m + kTargetStep_m * static_cast<double>(target);
}

void AddRay(const Vector3& eye_m, const Vector3& way_m, RayTile& rays) {
  const Eigen::Vector3f direction = way_m.normalized().cast<float>();
  const std::size_t ray = rays.num_rays++;
  rays.origin_x[ray] = static_cast<float>(eye_m.x());
  rays.origin_y[ray] = static_cast<float>(eye_m.y());
  rays.origin_z[ray] = static_cast<float>(eye_m.z());
  rays.direction_x[ray] = direction.x();
  rays.direction_y[ray] = direction.y();
  rays.direction_z[ray] = direction.z();
  rays.shutter[ray] = 0.0F;
  rays.range_m[ray] = static_cast<float>(way_m.norm());
  rays.surface[ray] = 0;
  rays.normal_x[ray] = rays.normal_y[ray] = rays.normal_z[ray] = 0.0F;
}

/// Counts the rays that a tile holds and empties it.
void CastRays(const SceneOfFrame& scene, RayTile& rays, TargetView& view) {
  const std::size_t num = rays.num_rays;
  if (num == 0) return;
  // Tiles hold whole packets; what fills the last one is not counted.
  while (rays.num_rays % kPacketSize != 0) AddRay(Vector3::Zero(), Vector3::UnitZ(), rays);
  scene.caster.Cast(rays);
  for (std::size_t ray = 0; ray < num; ++ray) {
    if (rays.surface[ray] == 0) {
      ++view.num_free;
    } else {
      ++view.hidden_by[scene.surfaces[rays.surface[ray]].label];
    }
  }
  rays.num_rays = 0;
}

TargetView LookAtTarget(const Lookout& lookout,
                        const SceneOfFrame& scene,
                        std::size_t target,
                        double height_m,
                        std::size_t num_rows) {
  const Transform window_from_target =
      scene.window_from_world * lookout.WorldFromTarget(DistanceOfTarget_m(target));
  const Vector3 eye_m = scene.window_from_world * lookout.eye_world_m;
  const auto num = static_cast<double>(num_rows);
  TargetView view{.num_rays = num_rows * num_rows};
  RayTile rays;
  rays.mask = kAllButWires;
  for (std::size_t i = 0; i < view.num_rays; ++i) {
    const std::size_t row = i / num_rows;
    const double across = (static_cast<double>(i % num_rows) + 0.5) / num - 0.5;
    const double up = (static_cast<double>(row) + 0.5) / num;
    const Vector3 point(0.0, across * kTargetWidth_m, up * height_m);
    AddRay(eye_m, window_from_target * point - eye_m, rays);
    if (rays.num_rays == kTileSize) CastRays(scene, rays, view);
  }
  CastRays(scene, rays, view);
  return view;
}

/// Looks more closely at all targets of one height that are not settled yet.
void LookAtTargets(const Lookout& lookout,
                   const SceneOfFrame& scene,
                   double height_m,
                   std::size_t num_rows,
                   std::vector<TargetView>& views) {
  tbb::parallel_for(std::size_t{0}, views.size(), [&](std::size_t target) {
    if (views[target].is_settled()) return;
    views[target] = LookAtTarget(lookout, scene, target, height_m, num_rows);
  });
}

std::string MostFrequentLabel(const TargetView& view, const LabelTable& labels) {
  // The label with the lower number if two are as frequent.
  const auto most =
      std::ranges::max_element(view.hidden_by, {}, [](const auto& each) { return each.second; });
  const Label* const label = most == view.hidden_by.end() ? nullptr : labels.Find(most->first);
  return label == nullptr ? "unlabeled" : label->name;
}

Sight SightOver(const std::vector<TargetView>& views,
                SightEnd end_of_views,
                const LabelTable& labels) {
  constexpr auto kMostHidden = static_cast<std::size_t>(kMostHidden_m / kTargetStep_m);
  std::size_t num_hidden = 0;
  std::size_t num_to_last_seen = 0;
  for (std::size_t i = 0; i < views.size() && num_hidden < kMostHidden; ++i) {
    num_hidden = views[i].is_seen() ? 0 : num_hidden + 1;
    if (num_hidden == 0) num_to_last_seen = i + 1;
  }
  Sight sight{
      num_to_last_seen == 0 ? 0.0 : DistanceOfTarget_m(num_to_last_seen - 1), end_of_views, {}};
  if (num_hidden == 0) return sight;
  sight.end = SightEnd::kBlocked;
  sight.blocker = MostFrequentLabel(views[num_to_last_seen], labels);
  return sight;
}

/// Looks at the targets of one height with more and more rays until the answer changes by less than
/// the targets' step.
Sight FindSight(const Lookout& lookout,
                const SceneOfFrame& scene,
                double height_m,
                SightEnd end_of_views,
                const LabelTable& labels) {
  const double beyond_m = lookout.reach_m - kNearestTarget_m;
  std::vector<TargetView> views(
      beyond_m < 0.0 ? 0 : static_cast<std::size_t>(beyond_m / kTargetStep_m) + 1);
  std::optional<double> before_m;
  for (std::size_t num_rows = kFewestRows;; num_rows = 2 * num_rows + 1) {
    LookAtTargets(lookout, scene, height_m, num_rows, views);
    Sight sight = SightOver(views, end_of_views, labels);
    const bool is_same = before_m && std::abs(sight.distance_m - *before_m) < kTargetStep_m;
    if (is_same || num_rows == kMostRows) return sight;
    before_m = sight.distance_m;
  }
}

/// Braking distance on the mean gradient of the way that it takes.
void AddBraking(const Lookout& lookout, const SightSpec& spec, SightPlace& place) {
  // The gradient changes the distance by a few per cent, and the distance the gradient by less.
  constexpr int kNumRounds = 5;
  const double to_end_m = lookout.ahead > 0.0 ? lookout.track.end_s_m() - lookout.chainage_m
                                              : lookout.chainage_m - lookout.track.begin_s_m();
  const auto height_m = [&](double distance_m) {
    return lookout.WorldFromTarget(distance_m).translation().z();
  };
  double way_m = kTargetStep_m;
  for (int i = 0; i < kNumRounds; ++i) {
    const double known_m = std::clamp(way_m, std::min(kTargetStep_m, to_end_m), to_end_m);
    place.gradient = known_m > 0.0 ? (height_m(known_m) - height_m(0.0)) / known_m : 0.0;
    way_m = StopOf(spec.braking, place.speed_mps, place.gradient).distance_m;
  }
  place.stop_m = way_m;
  place.needed_m = way_m + spec.braking.margin_m;
}

/// The frames of the way: the first, and each that is a step beyond the one before.
std::vector<std::uint32_t> FramesOfWay(const RailWorld& world,
                                       const ScanPattern& pattern,
                                       std::uint32_t last,
                                       double step_m) {
  std::vector<std::uint32_t> frames = {0};
  double before_s_m = world.VehicleChainage_m(pattern.StampNs(0));
  for (std::uint32_t frame = 1; frame <= last; ++frame) {
    const double s_m = world.VehicleChainage_m(pattern.StampNs(frame));
    if (std::abs(s_m - before_s_m) < step_m) continue;
    frames.push_back(frame);
    before_s_m = s_m;
  }
  return frames;
}

}  // namespace

std::vector<SightPlace> FollowSight(const ScenarioSpec& given,
                                    const SightSpec& spec,
                                    const std::function<void(double)>& on_progress) {
  ScenarioSpec scenario = given;
  if (spec.range_m) scenario.lidar.range_max_m = *spec.range_m;
  if (spec.speed_mps) {
    scenario.vehicle.motion.profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = *spec.speed_mps}};
  }
  const double range_m = scenario.lidar.range_max_m;
  const auto simulator = MakeSimulator(scenario, 0);
  const auto& world = dynamic_cast<const RailWorld&>(simulator->world());
  const OwnTrack track(world, scenario.world.catenary);
  const LabelTable labels(scenario.labels);
  const Transform vehicle_from_sensor = VehicleFromSensor(scenario.lidar.mount);
  const std::vector<std::uint32_t> frames = FramesOfWay(
      world, simulator->pattern(), LastFrameOfRun(scenario, *simulator, 1), spec.step_m);

  std::vector<SightPlace> places;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::uint32_t frame = frames[i];
    simulator->VisitScene(frame, [&](const SceneOfFrame& scene) {
      const Transform world_from_vehicle =
          scene.window_from_world.inverse() * scene.window_from_vehicle;
      const Vector3 eye_m = (world_from_vehicle * vehicle_from_sensor).translation();
      const VehicleTravel travel = world.VehicleTravelAt(scene.stamp_ns);
      const std::optional<PlaceByTrack> on_track = track.PlaceOf(eye_m, travel.s_m);
      // Its front may look beyond the end of the track.
      if (!on_track) return;
      Lookout lookout{track, eye_m, on_track->chainage_m, travel.runs_back ? -1.0 : 1.0, range_m};
      const double to_end_m = travel.runs_back ? lookout.chainage_m - track.begin_s_m()
                                               : track.end_s_m() - lookout.chainage_m;
      lookout.reach_m = std::min(range_m, to_end_m);
      SightPlace place{
          .frame = frame, .chainage_m = lookout.chainage_m, .speed_mps = travel.speed_mps};
      AtPlace("at " + NumberText(std::round(place.chainage_m)) + " m: ",
              [&] { AddBraking(lookout, spec, place); });
      for (const double height_m : spec.heights_m) {
        place.sights.push_back(
            FindSight(lookout, scene, height_m,
                      to_end_m < range_m ? SightEnd::kEndOfTrack : SightEnd::kRange, labels));
      }
      places.push_back(std::move(place));
    });
    on_progress(static_cast<double>(i + 1) / static_cast<double>(frames.size()));
  }
  return places;
}

}  // namespace railcast
