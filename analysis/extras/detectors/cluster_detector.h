#pragma once

#include <cstdint>
#include <vector>

#include "analysis/detectability/approach.h"
#include "analysis/extras/detectors/detection.h"
#include "railcast/io/recording.h"

namespace railcast {

/// The reference detector: points in the gauge of the own track ahead, put together to clusters by
/// their distances in plan (pcl::EuclideanClusterExtraction; Rusu 2009), as Autoware's
/// euclidean_cluster does it, whose defaults distance and number of points are. It knows the track
/// and its own place exactly, and classifies nothing: whatever is in the gauge is an obstacle.
struct ClusterDetectorSpec {
  /// Over top of rail. What is below is track: of rails, sleepers and ballast no point comes higher
  /// but by noise, a few centimetres of which most sensors have.
  double min_height_m = 0.1;
  /// Ahead of the sensor. What is nearer is rain and snow just before it; for nothing else that is
  /// so near could a train still stop.
  double min_distance_m = 5.0;
  double cluster_distance_m = 0.7;  ///< Points of a cluster are chained by distances up to this.
  std::uint32_t min_points = 10;    ///< Least size of a cluster.

  bool operator==(const ClusterDetectorSpec&) const = default;
};

/// Finds the clusters of a frame, the nearest first. The sensor's motion during the scan is undone
/// as far as the frame knows it.
/// @param reach_m How far ahead of the sensor points are looked for.
[[nodiscard]] std::vector<DetectedBox> FindClusters(const RecordedFrame& recorded,
                                                    const Transform& vehicle_from_sensor,
                                                    const OwnTrack& track,
                                                    const ClusterDetectorSpec& spec,
                                                    double reach_m);

}  // namespace railcast
