#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "railcast/scene.h"

namespace railcast {

/// A world of nothing, for scenes that a host traces itself: of it, only the motion of the vehicle
/// is used, which a derived class states in WorldFromVehicle().
class EmptyWorld : public World {
 public:
  [[nodiscard]] int HomeChunk(std::int64_t) const final { return 0; }
  [[nodiscard]] std::vector<int> ChunksInReach(int, double) const final { return {}; }
  [[nodiscard]] Transform WorldFromChunk(int) const final { return Transform::Identity(); }
  [[nodiscard]] Chunk BuildChunk(int) const final { return {}; }
  [[nodiscard]] const std::vector<SceneObject>& objects() const final { return objects_; }
  [[nodiscard]] Transform WorldFromObject(std::size_t, std::int64_t) const final {
    return Transform::Identity();
  }

 private:
  std::vector<SceneObject> objects_;
};

}  // namespace railcast
