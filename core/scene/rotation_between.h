#pragma once

#include "railcast/transform.h"

namespace railcast {

/// Returns the smallest rotation that turns one direction into another; neither need be of unit
/// length. Eigen solves opposite directions with a singular value decomposition, whose templates
/// are thus compiled once.
[[nodiscard]] Eigen::Quaterniond RotationBetween(const Vector3& from, const Vector3& to);

}  // namespace railcast
