#include "core/simulate/spray_clouds.h"

#include "core/base/units.h"

namespace railcast {
namespace {

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
