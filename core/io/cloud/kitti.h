#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "railcast/frame.h"
#include "railcast/transform.h"

namespace railcast {

/// Encodes a frame's points as a KITTI velodyne/*.bin: float32 x, y, z and remission of each slot
/// that has a point. KITTI's clouds are free of the sensor's motion and have no time field, so
/// points are moved to the sensor's axes at the stamp (ScanMotion). Remission is the intensity
/// without clamping (retroreflectors exceed 1), or 0 where the rung gives no intensity.
void EncodeKittiPoints(const Frame& frame, std::string& bytes);

/// Returns SemanticKITTI's id of the moving variant of a class, for example 256 (moving) for 16
/// (on-rails), or `id` itself if the class has no moving variant.
[[nodiscard]] std::uint16_t MovingSemanticKitti(std::uint16_t id);

/// Whether an object counts as moving, by its velocity in a frame.
[[nodiscard]] bool IsMoving(const Vector3& velocity_mps);

/// Encodes the labels of the same points as a SemanticKITTI labels/*.label, one uint32 each: the
/// lower half holds Label::semantic_kitti, or MovingSemanticKitti of it for an instance in
/// `moving`; the upper half holds the instance.
/// @throws InputError if an instance exceeds 65535, which the format cannot hold.
void EncodeKittiLabels(const Frame& frame,
                       const LabelTable& labels,
                       const std::set<std::uint32_t>& moving,
                       std::string& bytes);

/// Returns a line of poses.txt: the sensor's pose in the run's first sensor frame, as a 3 x 4
/// matrix by rows. KITTI's poses are those of the camera; with KittiCalibration() camera and LiDAR
/// coincide.
[[nodiscard]] std::string KittiPoseLine(const Transform& first_from_sensor);

/// Returns calib.txt: placeholder camera matrices and Tr = identity.
[[nodiscard]] std::string KittiCalibration();

/// Returns the labels under the numbers that .label files use, in rising order. Several of our
/// labels may share one number: grass and tree are both vegetation, and that entry is called
/// "grass/tree" and has the colour of the first. The moving variant is called "moving wagon" and
/// has the colour of the standing one.
[[nodiscard]] LabelTable SemanticKittiLabels(const LabelTable& labels);

/// Returns semantic-kitti-railcast.yaml, with the keys that semantic-kitti-api reads: names,
/// colours (b, g, r), shares of points (0: not counted yet), the learning_map to the classes of
/// training 0 to N and back, which of them to ignore, the split of a single sequence; and
/// nearest_map, to the nearest of SemanticKITTI's own ids.
[[nodiscard]] std::string SemanticKittiYaml(const LabelTable& labels);

}  // namespace railcast
