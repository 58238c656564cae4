#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/world.h"

namespace railcast {

/// Two objects that take up the same space, indices into World::objects().
struct ObjectOverlap {
  std::size_t one{};
  std::size_t other{};
  bool is_inside{};  ///< `one` is enclosed by `other`, and their surfaces do not meet.

  bool operator==(const ObjectOverlap&) const = default;
};

/// Which objects of the world, the own vehicle among them, overlap at one moment: a surface of one
/// cuts a surface of the other by more than 5 mm or so, or one is enclosed by the other on all
/// sides. What only touches does not overlap, as a crate on a flat wagon.
/// @return By index, each pair once.
[[nodiscard]] std::vector<ObjectOverlap> FindOverlaps(const World& world, std::int64_t time_ns);

}  // namespace railcast
