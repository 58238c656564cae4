#include "viewer/composition/compose_distances.h"

#include <array>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include "core/io/cloud/nearest_points.h"
#include "viewer/composition/coloring.h"
#include "viewer/frames/field_values.h"

namespace railcast {

namespace {

pcl::PointCloud<pcl::PointXYZ>::Ptr CloudOf(const ShownFrame& shown, const Transform& to_from_own) {
  auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  cloud->reserve(shown.num_points());
  for (std::size_t i = 0; i < shown.num_points(); ++i) {
    const float* const own_m = shown.positions_m.data() + 3 * i;
    const Vector3 point_m = to_from_own * Eigen::Map<const Eigen::Vector3f>(own_m).cast<double>();
    const Eigen::Vector3f rounded_m = point_m.cast<float>();
    cloud->emplace_back(rounded_m.x(), rounded_m.y(), rounded_m.z());
  }
  return cloud;
}

std::array<double, 2> FitDistances_m(const FieldValues& distances) {
  return {0.0, FitScale(distances)[1]};
}

FieldValues DistancesField(const ShownFrame& of, const ShownFrame& other) {
  const std::vector<float> distances_m = DistancesToNearest_m(of, other);
  return {.kind = FieldValues::Kind::kAmount,
          .title = "to the other's nearest point [m]",
          .values = {distances_m.begin(), distances_m.end()}};
}

}  // namespace

std::optional<Transform> FirstFromSecond(const ShownFrame& first, const ShownFrame& second) {
  if (!first.recorded->has_pose || !second.recorded->has_pose) {
    const Vector3 apart_m = second.recorded->origin_m - first.recorded->origin_m;
    if (apart_m.isZero(0.0)) return std::nullopt;
    return Transform(Eigen::Translation3d(apart_m));
  }
  return first.frame().world_from_sensor.inverse() * second.frame().world_from_sensor;
}

std::vector<float> DistancesToNearest_m(const ShownFrame& of, const ShownFrame& other) {
  if (of.num_points() == 0 || other.num_points() == 0) {
    return std::vector<float>(of.num_points(), std::numeric_limits<float>::quiet_NaN());
  }
  const NearestSearch search(CloudOf(other, Transform::Identity()));
  const Transform other_from_of = FirstFromSecond(other, of).value_or(Transform::Identity());
  return search.Of(*CloudOf(of, other_from_of)).distance_m;
}

Composition ComposeDistances(const std::shared_ptr<const ShownFrame>& a,
                             const std::shared_ptr<const ShownFrame>& b,
                             const Choices& choices) {
  Composition composition;
  const FieldValues of_a = DistancesField(*a, *b);
  const FieldValues of_b = DistancesField(*b, *a);
  const ColorMap map = choices.map.value_or(ColorMap::kViridis);
  const auto ends_m = choices.distance_ends_m ? *choices.distance_ends_m : FitDistances_m(of_a);
  composition.coloring = ColorByScale(of_a, map, ends_m);
  composition.clouds.push_back({.shown = a,
                                .view_from_sensor = Transform::Identity(),
                                .colors = std::move(composition.coloring.colors),
                                .is_faint = FaintPoints(*a, choices.labels)});
  composition.clouds.push_back(
      {.shown = b,
       .view_from_sensor = FirstFromSecond(*a, *b).value_or(Transform::Identity()),
       .colors = ColorByScale(of_b, map, ends_m).colors,
       .is_faint = FaintPoints(*b, choices.labels)});
  return composition;
}

}  // namespace railcast
