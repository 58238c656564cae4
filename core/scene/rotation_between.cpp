#include "core/scene/rotation_between.h"

namespace railcast {

Eigen::Quaterniond RotationBetween(const Vector3& from, const Vector3& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace railcast
