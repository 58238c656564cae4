#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "railcast/scene.h"

namespace railcast {

/// A world of one chunk for analytic scenes, with ground, objects, and a vehicle that moves at a
/// constant velocity and turns at a constant rate. `world_from_chunk` moves all of it.
class SimpleWorld final : public World {
 public:
  Model ground;  ///< In the chunk frame.
  std::vector<Placement> placements;
  std::vector<Wire> wires;  ///< Wires that `ground` holds as tubes.
  Transform world_from_chunk = Transform::Identity();
  Transform chunk_from_vehicle = Transform::Identity();  ///< At time 0.
  Vector3 velocity_chunk_mps = Vector3::Zero();
  std::vector<Transform> vehicle_poses;  ///< VehiclePosesIn().
  double yaw_rate_radps = 0.0;  ///< The vehicle's yaw rate about its own z, positive to the left.

  /// Adds an object that starts at `chunk_from_object` and stands or moves at a constant velocity.
  void AddObject(std::shared_ptr<const Model> model,
                 const Transform& chunk_from_object,
                 const Vector3& object_velocity_mps = Vector3::Zero(),
                 bool is_ego = false,
                 const std::string& type = "mesh") {
    const auto instance = static_cast<std::uint32_t>(objects_.size() + 1);
    objects_.push_back({.name = "object" + std::to_string(instance),
                        .type = type,
                        .label = model->parts.empty() ? 0 : model->parts[0].label,
                        .instance = instance,
                        .model = std::move(model),
                        .moves = !object_velocity_mps.isZero(0.0),
                        .is_ego = is_ego,
                        .is_rail_vehicle = type == "open_wagon"});
    object_places_.emplace_back(chunk_from_object, object_velocity_mps);
  }

  [[nodiscard]] Transform WorldFromVehicle(std::int64_t time_ns) const override {
    const double yaw_rad = yaw_rate_radps * SecondsFromNs(time_ns);
    const Transform turned = chunk_from_vehicle * Eigen::AngleAxisd(yaw_rad, Vector3::UnitZ());
    return Moved(turned, velocity_chunk_mps, time_ns);
  }
  [[nodiscard]] int HomeChunk(std::int64_t) const override { return 0; }
  [[nodiscard]] std::vector<Transform> VehiclePosesIn(int) const override { return vehicle_poses; }
  [[nodiscard]] std::vector<int> ChunksInReach(int, double) const override { return {0}; }
  [[nodiscard]] Transform WorldFromChunk(int) const override { return world_from_chunk; }
  [[nodiscard]] Chunk BuildChunk(int) const override { return {ground, placements, wires}; }
  [[nodiscard]] const std::vector<SceneObject>& objects() const override { return objects_; }
  [[nodiscard]] Transform WorldFromObject(std::size_t object, std::int64_t time_ns) const override {
    return Moved(object_places_[object].first, object_places_[object].second, time_ns);
  }

 private:
  [[nodiscard]] Transform Moved(Transform chunk_from_thing,
                                const Vector3& velocity_mps,
                                std::int64_t time_ns) const {
    chunk_from_thing.pretranslate(velocity_mps * SecondsFromNs(time_ns));
    return world_from_chunk * chunk_from_thing;
  }

  std::vector<SceneObject> objects_;
  std::vector<std::pair<Transform, Vector3>> object_places_;
};

/// A world of a standing vehicle, whose ground has these parts.
[[nodiscard]] inline std::shared_ptr<SimpleWorld> WorldOfParts(std::vector<Part> parts) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = std::move(parts);
  return world;
}

}  // namespace railcast
