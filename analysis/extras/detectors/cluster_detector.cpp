#include "analysis/extras/detectors/cluster_detector.h"

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/impl/extract_clusters.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/io/recording/recorded_motion.h"

namespace railcast {
namespace {

/// The points in the gauge ahead.
struct GaugePoints {
  std::vector<PlaceByTrack> places;
  std::vector<std::uint32_t> labels;
};

GaugePoints PointsIn(const GaugeAhead& gauge,
                     const RecordedFrame& recorded,
                     const ClusterDetectorSpec& spec) {
  const Frame& frame = recorded.frame;
  const RecordedMotion motion(recorded, Compensation::kSensor);
  GaugePoints points;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!std::isfinite(frame.x[slot])) continue;
    const auto place =
        gauge.PlaceInside(frame.world_from_sensor * motion.PointOf(slot).cast<double>());
    if (!place || place->height_m < spec.min_height_m) continue;
    if (gauge.Ahead_m(*place) < spec.min_distance_m) continue;
    points.places.push_back(*place);
    points.labels.push_back(frame.label[slot]);
  }
  return points;
}

/// Indices of the points of each cluster.
std::vector<pcl::PointIndices> ClustersOf(const std::vector<PlaceByTrack>& places,
                                          const ClusterDetectorSpec& spec) {
  const pcl::PointCloud<pcl::PointXYZ>::Ptr plan(new pcl::PointCloud<pcl::PointXYZ>());
  // Chainages may be too large for float32.
  for (const PlaceByTrack& place : places) {
    plan->push_back({static_cast<float>(place.chainage_m - places.front().chainage_m),
                     static_cast<float>(place.lateral_m), 0.0F});
  }
  std::vector<pcl::PointIndices> clusters;
  if (plan->empty()) return clusters;
  const pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>());
  tree->setInputCloud(plan);
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setClusterTolerance(spec.cluster_distance_m);
  extraction.setMinClusterSize(static_cast<pcl::uindex_t>(spec.min_points));
  extraction.setSearchMethod(tree);
  extraction.setInputCloud(plan);
  extraction.extract(clusters);
  return clusters;
}

}  // namespace

std::vector<DetectedBox> FindClusters(const RecordedFrame& recorded,
                                      const Transform& vehicle_from_sensor,
                                      const OwnTrack& track,
                                      const ClusterDetectorSpec& spec,
                                      double reach_m) {
  const Transform& world_from_sensor = recorded.frame.world_from_sensor;
  const GaugeAhead gauge(track, world_from_sensor * vehicle_from_sensor.inverse(),
                         world_from_sensor.translation(), reach_m);
  const GaugePoints points = PointsIn(gauge, recorded, spec);
  std::vector<std::pair<double, DetectedBox>> by_distance;
  for (const pcl::PointIndices& cluster : ClustersOf(points.places, spec)) {
    std::vector<PlaceByTrack> places;
    std::vector<std::uint32_t> labels;
    for (const int index : cluster.indices) {
      places.push_back(points.places[static_cast<std::size_t>(index)]);
      labels.push_back(points.labels[static_cast<std::size_t>(index)]);
    }
    DetectedBox found{
        .box = BoxOfCluster(track, places), .label = MostFrequentLabel(labels), .class_name = {}};
    const Vector3 sensor_in_box_m =
        found.box.world_from_box.inverse() * world_from_sensor.translation();
    by_distance.emplace_back(DistanceToBox(sensor_in_box_m, found.box.size_m), std::move(found));
  }
  std::ranges::stable_sort(by_distance, {}, [](const auto& each) { return each.first; });
  std::vector<DetectedBox> boxes;
  for (auto& [distance_m, found] : by_distance) boxes.push_back(std::move(found));
  return boxes;
}

}  // namespace railcast
