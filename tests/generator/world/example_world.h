#pragma once

#include <memory>

#include "tests/support/simple_world.h"

namespace railcast {

inline std::shared_ptr<Model> Triangle(std::uint16_t material, std::uint32_t label) {
  auto model = std::make_shared<Model>();
  model->parts.push_back({{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, material, label});
  return model;
}

/// A chunk far from the origin with one triangle of ground, another placed at twice its size, and
/// two objects.
inline SimpleWorld ExampleWorld() {
  SimpleWorld world;
  world.world_from_chunk.translation() = Vector3(5.3e6, 6e5, 400.0);
  world.ground = *Triangle(1, 1);
  Placement large{Triangle(2, 1)};
  large.chunk_from_model = Eigen::Translation3d(10, 0, 0) * Eigen::Scaling(2.0);
  world.placements = {large};
  world.AddObject(Triangle(1, 12), MakeTransform(Eigen::Matrix3d::Identity(), Vector3(20, 0, 3)),
                  Vector3(1, 0, 0));
  world.AddObject(Triangle(1, 12), MakeTransform(Eigen::Matrix3d::Identity(), Vector3(40, 0, 0)));
  return world;
}

}  // namespace railcast
