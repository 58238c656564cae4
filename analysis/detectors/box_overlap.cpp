#include "analysis/detectors/box_overlap.h"

namespace railcast {

double OverlapOf(const OrientedBox& one, const OrientedBox& other) {
  constexpr int kSteps = 16;
  const bool is_one_smaller = one.size_m.prod() <= other.size_m.prod();
  const OrientedBox& smaller = is_one_smaller ? one : other;
  const OrientedBox& larger = is_one_smaller ? other : one;
  const Transform larger_from_smaller = larger.world_from_box.inverse() * smaller.world_from_box;
  const double reach_m = 0.5 * (smaller.size_m.norm() + larger.size_m.norm());
  if (larger_from_smaller.translation().norm() >= reach_m) return 0.0;
  const Vector3 half_m = 0.5 * larger.size_m;
  int num = 0;
  for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
    const Vector3 cell(i % kSteps, i / kSteps % kSteps, i / kSteps / kSteps);
    const Vector3 middle_m = ((cell.array() + 0.5) / kSteps - 0.5) * smaller.size_m.array();
    const Vector3 local_m = larger_from_smaller * middle_m;
    num += (local_m.cwiseAbs().array() <= half_m.array()).all() ? 1 : 0;
  }
  return static_cast<double>(num) / (kSteps * kSteps * kSteps);
}

}  // namespace railcast
