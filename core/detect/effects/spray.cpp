#include "core/detect/effects/spray.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/base/vector_math.h"
#include "core/detect/clutter/added_echo.h"
#include "railcast/outcome.h"

namespace railcast {
namespace {

// Beyond so many lengths of decay a cloud has less than a hundredth of its density.
constexpr float kMostDecays = 5.0F;

float Along(const float (&axis)[3], const float (&v)[3]) {
  return axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
}

// Shortens a path to the part between two planes: `low` <= place + range x step <= `high`.
void CutSlab(float place, float step, float low, float high, SprayPath& path) {
  if (step == 0.0F) {
    if (place < low || place > high) path.end_m = path.begin_m;
    return;
  }
  const float a_m = (low - place) / step;
  const float b_m = (high - place) / step;
  path.begin_m = std::max(path.begin_m, std::min(a_m, b_m));
  path.end_m = std::min(path.end_m, std::max(a_m, b_m));
}

// The integral of the density along `back`, relative to that at the vehicle, from its rear.
float DensityIntegral_m(const SprayCloud& cloud, float back_m) {
  if (back_m <= 0.0F) return back_m;
  return cloud.decay_m * (1.0F - baseline::Exp(-back_m / cloud.decay_m));
}

constexpr double kBesideSides_m = 0.5;
constexpr double kCloudHeight_m = 3.0;
constexpr double kDecayTime_s = 1.0;

bool IsOfATrain(const SceneObject& object) {
  return object.moves && !object.is_ego && object.is_rail_vehicle;
}

void Put(const Vector3& from, float (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(from[i]);
}

}  // namespace

SprayPath PathIn(const SprayCloud& cloud, const float (&origin)[3], const float (&direction)[3]) {
  const float from_rear[3] = {origin[0] - cloud.rear[0], origin[1] - cloud.rear[1],
                              origin[2] - cloud.rear[2]};
  SprayPath path{.begin_m = 0.0F,
                 .end_m = 1e9F,
                 .back_m = Along(cloud.back, from_rear),
                 .back_per_m = Along(cloud.back, direction)};
  CutSlab(path.back_m, path.back_per_m, -cloud.body_m, kMostDecays * cloud.decay_m, path);
  CutSlab(Along(cloud.left, from_rear), Along(cloud.left, direction), -cloud.half_width_m,
          cloud.half_width_m, path);
  CutSlab(Along(cloud.up, from_rear), Along(cloud.up, direction), 0.0F, cloud.height_m, path);
  return path;
}

float ExtinctionAt_per_m(const SprayCloud& cloud, const SprayPath& path, float range_m) {
  if (range_m < path.begin_m || range_m > path.end_m) return 0.0F;
  const float back_m = path.back_m + range_m * path.back_per_m;
  return cloud.extinction_per_m * baseline::Exp(-std::max(back_m, 0.0F) / cloud.decay_m);
}

float OpticalDepth(const SprayCloud& cloud, const SprayPath& path, float range_m) {
  const float end_m = std::min(path.end_m, range_m);
  if (!(end_m > path.begin_m)) return 0.0F;
  const float length_m = end_m - path.begin_m;
  const float from_m = path.back_m + path.begin_m * path.back_per_m;
  const float change_m = length_m * path.back_per_m;
  // Over less than a thousandth of the decay the density is that in the middle, to 1e-7.
  if (std::fabs(change_m) < 1e-3F * cloud.decay_m) {
    return length_m * ExtinctionAt_per_m(cloud, path, path.begin_m + 0.5F * length_m);
  }
  return cloud.extinction_per_m *
         (DensityIntegral_m(cloud, from_m + change_m) - DensityIntegral_m(cloud, from_m)) /
         path.back_per_m;
}

double SprayExtinction_per_m(const WeatherSpec& weather, double speed_mps) {
  const double cause = std::max(WetnessOf(weather), weather.snow_cover);
  return weather.spray_extinction_per_m * cause * std::pow(speed_mps / MpsFromKmph(100.0), 2);
}

bool HasSpray(const DetectorSpec& spec) {
  return SprayExtinction_per_m(spec.weather, 1.0) > 0.0;
}

struct Spray::Passage {
  struct Part {
    const SprayCloud* cloud{};
    SprayPath path;
  };
  std::vector<Part> parts;

  [[nodiscard]] float Depth(float range_m) const {
    float depth = 0.0F;
    for (const auto& [cloud, path] : parts) depth += OpticalDepth(*cloud, path, range_m);
    return depth;
  }
  [[nodiscard]] float Extinction_per_m(float range_m) const {
    float extinction = 0.0F;
    for (const auto& [cloud, path] : parts) extinction += ExtinctionAt_per_m(*cloud, path, range_m);
    return extinction;
  }
  /// The range at which the optical depth is reached, by bisection to less than 0.1 mm.
  [[nodiscard]] float RangeAtDepth_m(float depth, float most_m) const {
    constexpr int kNumSteps = 24;
    float near_m = 0.0F;
    float far_m = most_m;
    for (int i = 0; i < kNumSteps; ++i) {
      const float middle_m = 0.5F * (near_m + far_m);
      (Depth(middle_m) < depth ? near_m : far_m) = middle_m;
    }
    return far_m;
  }
};

Spray::Spray(const DetectorSpec& spec)
    : seed_(spec.seed),
      label_(spec.clutter_labels.spray),
      range_min_m_(static_cast<float>(spec.range_min_m)),
      range_max_m_(static_cast<float>(spec.range_max_m)),
      reflectance_m_(static_cast<float>(std::numbers::pi / 65.0 * PulseLength_m(spec.beam))) {}

void Spray::AddCloudEcho(std::size_t beam,
                         const Passage& passage,
                         const Detector& detector,
                         EchoTiles& echoes) const {
  const DetectTile& first = echoes.first;
  const bool is_blocked = first.outcome[beam] == static_cast<std::uint32_t>(Outcome::kEgo);
  const float surface_m = first.true_range_m[beam];
  const float most_m = surface_m < range_max_m_ ? surface_m : range_max_m_;  // NaN: no surface.
  const float depth = passage.Depth(most_m);
  if (is_blocked || depth <= 0.0F) return;
  const auto words = RandomWords(seed_, RandomUse::kSpray, first.frame, first.firing[beam]);
  const float scattered = UnitFloat(words[0]) * (1.0F - baseline::Exp(-2.0F * depth));
  const float range_m = passage.RangeAtDepth_m(-0.5F * baseline::Log(1.0F - scattered), most_m);
  if (range_m < range_min_m_) return;
  const float clump = -baseline::Log(1.0F - UnitFloat(words[1]));
  const float intensity = reflectance_m_ * passage.Extinction_per_m(range_m) * clump;
  const float ratio = detector.PowerRatio(intensity * (1.0F - scattered), range_m, 0.0F);
  AddEcho(beam, {label_, EchoTiles::kSprayCloud, range_m, ratio, intensity}, echoes);
}

void Spray::Apply(const RayTile& rays,
                  const std::vector<SprayCloud>& clouds,
                  const Detector& detector,
                  EchoTiles& echoes) const {
  std::vector<Passage> passages(echoes.first.num_rays);
  for (std::size_t i = 0; i < passages.size(); ++i) {
    const float direction[3] = {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]};
    for (const SprayCloud& cloud : clouds) {
      const float origin[3] = {rays.origin_x[i] - rays.shutter[i] * cloud.way[0],
                               rays.origin_y[i] - rays.shutter[i] * cloud.way[1],
                               rays.origin_z[i] - rays.shutter[i] * cloud.way[2]};
      const SprayPath path = PathIn(cloud, origin, direction);
      if (path.end_m > path.begin_m) passages[i].parts.push_back({&cloud, path});
    }
  }
  const auto weaken = [&](std::size_t beam, DetectTile& tile, std::size_t lane) {
    if (passages[beam].parts.empty()) return;
    const float depth = passages[beam].Depth(tile.true_range_m[lane]);
    tile.power_ratio[lane] *= baseline::Exp(-2.0F * depth);
  };
  const std::size_t num_more = echoes.num_more();
  for (std::size_t i = 0; i < passages.size(); ++i) weaken(i, echoes.first, i);
  for (std::size_t i = 0; i < num_more; ++i) {
    const auto [tile, lane] = echoes.more(i);
    weaken(echoes.beam_of(i), tile, lane);
  }
  for (std::size_t i = 0; i < passages.size(); ++i) {
    if (!passages[i].parts.empty()) AddCloudEcho(i, passages[i], detector, echoes);
  }
}

std::vector<SprayCloud> SprayCloudsOf(const World& world,
                                      const WeatherSpec& weather,
                                      const ScanSpan& span,
                                      const Transform& window_from_world) {
  constexpr std::int64_t kStep_ns = 10'000'000;
  std::vector<SprayCloud> clouds;
  for (std::size_t i = 0; i < world.objects().size(); ++i) {
    const SceneObject& object = world.objects()[i];
    if (!IsOfATrain(object)) continue;
    const auto at = [&](std::int64_t since_stamp_ns) -> Transform {
      return window_from_world * world.WorldFromObject(i, span.stamp_ns + since_stamp_ns);
    };
    const Transform now = at(0);
    const Vector3 way = at(kStep_ns).translation() - now.translation();
    const double speed_mps = way.norm() / SecondsFromNs(kStep_ns);
    const double extinction_per_m = SprayExtinction_per_m(weather, speed_mps);
    if (!(extinction_per_m > 0.0)) continue;
    const Eigen::AlignedBox3d box_m = object.model->Bounds();
    // The object's own x axis lies along the track; it may travel either way.
    const bool is_forwards = now.linear().col(0).dot(way) > 0.0;
    const double rear_x_m = is_forwards ? box_m.min().x() : box_m.max().x();
    const double turn = is_forwards ? 1.0 : -1.0;
    SprayCloud cloud{.body_m = static_cast<float>(box_m.sizes().x()),
                     .half_width_m = static_cast<float>(0.5 * box_m.sizes().y() + kBesideSides_m),
                     .height_m = static_cast<float>(kCloudHeight_m),
                     .decay_m = static_cast<float>(speed_mps * kDecayTime_s),
                     .extinction_per_m = static_cast<float>(extinction_per_m)};
    Put(now * Vector3(rear_x_m, box_m.center().y(), box_m.min().z()), cloud.rear);
    Put(at(span.duration_ns).translation() - now.translation(), cloud.way);
    Put(-turn * now.linear().col(0), cloud.back);
    Put(-turn * now.linear().col(1), cloud.left);
    Put(now.linear().col(2), cloud.up);
    clouds.push_back(cloud);
  }
  return clouds;
}

}  // namespace railcast
