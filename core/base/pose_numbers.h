#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "railcast/transform.h"

namespace railcast {

/// Whether a quaternion is a rotation, to what files round.
[[nodiscard]] inline bool IsUnit(const Eigen::Quaterniond& rotation) {
  constexpr double kTolerance = 1e-3;
  return std::abs(rotation.norm() - 1.0) <= kTolerance;
}

/// Makes a pose of seven numbers of a file, of any format: x y z qx qy qz qw.
/// @throws InputError "place: rule" unless there are seven finite numbers and the quaternion has
///   length 1.
[[nodiscard]] inline Transform MakePose(const std::vector<double>& numbers,
                                        const std::string& place) {
  if (numbers.size() != 7) {
    throw InputError(place + ": a pose must have seven numbers" + Got(numbers.size()));
  }
  for (const double number : numbers) {
    if (!std::isfinite(number)) throw InputError(place + ": a pose must be finite");
  }
  const Eigen::Quaterniond turn(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (!IsUnit(turn)) {
    throw InputError(place + ": a quaternion must have length 1" + Got(turn.norm()));
  }
  return MakeTransform(turn.normalized().toRotationMatrix(),
                       Vector3(numbers[0], numbers[1], numbers[2]));
}

}  // namespace railcast
