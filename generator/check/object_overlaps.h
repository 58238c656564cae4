#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "railcast/scene.h"

namespace railcast {

/// Two objects that occupy the same space, as indices into World::objects().
struct ObjectOverlap {
  std::size_t one{};
  std::size_t other{};
  bool is_inside{};  ///< Set if `one` is enclosed by `other` and their surfaces do not meet.

  bool operator==(const ObjectOverlap&) const = default;
};

/// Finds the objects of the world, including the own vehicle, that overlap at one moment: either
/// their surfaces cut each other by more than about 5 mm, or one is enclosed by the other on all
/// sides. Objects that only touch, such as a crate on a flat wagon, do not overlap.
/// @return By index, each pair once.
[[nodiscard]] std::vector<ObjectOverlap> FindOverlaps(const World& world, std::int64_t time_ns);

}  // namespace railcast
