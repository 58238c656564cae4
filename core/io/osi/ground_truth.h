#pragma once

#include <osi_sensor_view.pb.h>
#include "core/io/osi/sensor_view.h"

namespace railcast::osi {

void Set(const Vector3& vector, osi3::Vector3d& message);

/// As rotations about z, the new y and the new x axis.
void Set(const Eigen::Matrix3d& rotation, osi3::Orientation3d& message);

/// OSI 3.8.0.
void SetVersion(osi3::InterfaceVersion& message);

void SetTime(std::int64_t time_ns, osi3::Timestamp& message);

/// Fills in objects and weather at the frame's stamp.
void SetGroundTruth(const FrameOfView& view, osi3::GroundTruth& truth);

}  // namespace railcast::osi
