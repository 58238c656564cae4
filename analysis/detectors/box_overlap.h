#pragma once

#include "railcast/transform.h"

namespace railcast {

/// A box anywhere in the world, turned in any way.
struct OrientedBox {
  Transform world_from_box = Transform::Identity();  ///< Its centre and axes.
  Vector3 size_m = Vector3::Zero();                  ///< Every side > 0.
};

/// The volume that two boxes share, as a share of the smaller one's: the overlap coefficient, 0 to
/// 1. Unlike the intersection over the union it does not fall where a sensor sees but the near face
/// of a long object. It counts the middles of 16 x 16 x 16 cells of the smaller box and so is exact
/// to 1/32 for each face of the other one that cuts it.
[[nodiscard]] double OverlapOf(const OrientedBox& one, const OrientedBox& other);

/// The same box with every face moved outwards.
[[nodiscard]] inline OrientedBox Grown(OrientedBox box, double by_m) {
  box.size_m.array() += 2.0 * by_m;
  return box;
}

[[nodiscard]] inline bool IsInside(const OrientedBox& box, const Vector3& world_m) {
  const Vector3 local_m = box.world_from_box.inverse() * world_m;
  return (local_m.cwiseAbs().array() <= 0.5 * box.size_m.array()).all();
}

}  // namespace railcast
