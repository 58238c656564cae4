#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/units.h"
#include "tests/core/simulate/measured_velocities.h"

namespace railcast {

/// A leaf of a gate, 4 m to each side of its hinge, that stands or turns 20 m ahead.
class TurningLeaf : public World {
 public:
  static constexpr double kDistance_m = 20.0;
  static constexpr double kTurn_radps = 4.0;  // As fast as a shank swings.

  explicit TurningLeaf(bool moves = true) {
    objects_.push_back({.name = "gate",
                        .type = "mesh",
                        .label = 7,
                        .instance = 1,
                        .model = SheetModel(4.0F),
                        .moves = moves,
                        .pose_step_ns = 10'000'000});
  }
  [[nodiscard]] Transform WorldFromVehicle(std::int64_t) const override {
    return Transform::Identity();
  }
  [[nodiscard]] int HomeChunk(std::int64_t) const override { return 0; }
  [[nodiscard]] std::vector<int> ChunksInReach(int, double) const override { return {0}; }
  [[nodiscard]] Transform WorldFromChunk(int) const override { return Transform::Identity(); }
  [[nodiscard]] Chunk BuildChunk(int) const override { return {}; }
  [[nodiscard]] const std::vector<SceneObject>& objects() const override { return objects_; }
  [[nodiscard]] Transform WorldFromObject(std::size_t, std::int64_t time_ns) const override {
    const double angle_rad = objects_.front().moves ? kTurn_radps * SecondsFromNs(time_ns) : 0.0;
    return Eigen::Translation3d(kDistance_m, 0.0, 0.0) *
           Transform(Eigen::AngleAxisd(angle_rad, Vector3::UnitZ()));
  }

 protected:
  std::vector<SceneObject> objects_;
};

}  // namespace railcast
