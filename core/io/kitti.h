#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "core/base/transform.h"
#include "core/frame/frame.h"
#include "core/frame/labels.h"

namespace railcast {

/// A frame's points as a KITTI velodyne/*.bin: float32 x, y, z, remission each, only slots that
/// have a point. KITTI's clouds are free of the sensor's motion and have no time field, so points
/// are moved to the sensor's axes at the stamp (ScanMotion). Remission is the intensity as it is
/// (retroreflectors exceed 1; nothing is clamped), 0 where the rung gives none.
void EncodeKittiPoints(const Frame& frame, std::string& bytes);

/// SemanticKITTI's id for what moves of a class: 256 for 16, on-rails. The id itself if it has
/// none.
[[nodiscard]] std::uint16_t MovingSemanticKitti(std::uint16_t id);

/// Their SemanticKITTI labels/*.label: uint32 each, Label::semantic_kitti below, of an instance
/// that is in `moving` MovingSemanticKitti of that; instance above.
/// @throws InputError if an instance exceeds 65535, which the format cannot hold.
void EncodeKittiLabels(const Frame& frame,
                       const LabelTable& labels,
                       const std::set<std::uint32_t>& moving,
                       std::string& bytes);

/// A line of poses.txt: the sensor's pose in the run's first sensor frame, 3 x 4 by rows. KITTI's
/// poses are the camera's; with KittiCalibration() camera and LiDAR coincide.
[[nodiscard]] std::string KittiPoseLine(const Transform& first_from_sensor);

/// calib.txt: camera matrices of no meaning and Tr = identity.
[[nodiscard]] std::string KittiCalibration();

/// The labels under the numbers that .label files have, in their order. Several of ours may share
/// one, as grass and tree are both vegetation: it is called "grass/tree" and has the first's
/// colour. What moves is "moving wagon", in the colour of what stands.
[[nodiscard]] LabelTable SemanticKittiLabels(const LabelTable& labels);

/// semantic-kitti-railcast.yaml: names, colours (b, g, r as SemanticKITTI has them) and the
/// learning_map to the nearest of SemanticKITTI's own classes.
[[nodiscard]] std::string SemanticKittiYaml(const LabelTable& labels);

}  // namespace railcast
