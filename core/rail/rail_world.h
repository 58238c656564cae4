#pragma once

#include <memory>

#include "core/frame/labels.h"
#include "core/rail/line/alignment.h"
#include "core/rail/world_spec.h"
#include "core/scene/material.h"
#include "core/scene/world.h"

namespace railcast {

/// The railway world of a scenario. Chunks are kChunkLength_m of the line each, from chainage 0.
///
/// Objects have instance ids 1, 2, ... in the order of the spec; the vehicle's own boxes, if it has
/// any, are one further object "ego" after them; masts follow from kFirstMastInstance on. Beyond
/// the ends of the line everything that moves goes on straight and level.
class RailWorld final : public World {
 public:
  static constexpr double kChunkLength_m = 50.0;

  /// @throws InputError if the specs contradict each other or a mesh cannot be read. Lines read
  ///   "/world/objects/3/track: rule (got value)", pointers into the scenario.
  RailWorld(const WorldSpec& world,
            const VehicleSpec& vehicle,
            const LabelTable& labels,
            const MaterialLibrary& materials,
            std::uint64_t seed);
  ~RailWorld() override;

  [[nodiscard]] const Alignment& alignment() const;

  /// Where along its track the vehicle's origin is; beyond the track's ends too.
  [[nodiscard]] double VehicleChainage_m(std::int64_t time_ns) const;
  /// The same of objects()[object].
  [[nodiscard]] double ObjectChainage_m(std::size_t object, std::int64_t time_ns) const;

  [[nodiscard]] Transform WorldFromVehicle(std::int64_t time_ns) const override;
  [[nodiscard]] int HomeChunk(std::int64_t time_ns) const override;
  [[nodiscard]] std::vector<int> ChunksInReach(int home_chunk, double range_m) const override;
  [[nodiscard]] Transform WorldFromChunk(int chunk) const override;
  [[nodiscard]] Chunk BuildChunk(int chunk) const override;
  [[nodiscard]] const std::vector<SceneObject>& objects() const override;
  [[nodiscard]] Transform WorldFromObject(std::size_t object, std::int64_t time_ns) const override;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace railcast
