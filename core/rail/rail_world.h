#pragma once

#include <memory>
#include <string>

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
///
/// Immutable. A world that differs in what commands change is made from one that is there, and
/// shares all else with it: its chunks are the same.
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

  /// This world for times from `from_ns` on, in which the vehicle changes its speed: at a constant
  /// acceleration to `speed_mps`, which it then keeps; its direction stays.
  /// @pre from_ns >= 0 and not before an earlier change, speed_mps >= 0, acceleration_mps2 > 0
  /// (also
  ///   to slow down).
  [[nodiscard]] std::shared_ptr<const RailWorld> WithVehicleSpeed(std::int64_t from_ns,
                                                                  double speed_mps,
                                                                  double acceleration_mps2) const;
  /// This world for times from `from_ns` on, with one object more. Its motion's time 0 is
  /// `from_ns`. Its instance id is one that no object of this world or of those it was made from
  /// has had; all others keep theirs.
  /// @throws InputError as a scenario with that object would give, "/object/track: rule (got
  ///   value)".
  [[nodiscard]] std::shared_ptr<const RailWorld> WithObject(const ObjectSpec& object,
                                                            std::int64_t from_ns) const;
  /// This world without an object of the scenario or of WithObject().
  /// @throws InputError "/name: rule (got value)" if there is none of that name.
  [[nodiscard]] std::shared_ptr<const RailWorld> WithoutObject(const std::string& name) const;

  [[nodiscard]] const Alignment& alignment() const;

  [[nodiscard]] const TrackSpec& vehicle_track() const;
  /// Whether WithVehicleSpeed() had a say in its way.
  [[nodiscard]] bool has_changed_vehicle_speed() const;
  [[nodiscard]] double VehicleSpeed_mps(std::int64_t time_ns) const;
  /// Where along its track the vehicle's origin is; beyond the track's ends too.
  [[nodiscard]] double VehicleChainage_m(std::int64_t time_ns) const;
  /// The same of objects()[object].
  [[nodiscard]] const TrackSpec& object_track(std::size_t object) const;
  [[nodiscard]] double ObjectChainage_m(std::size_t object, std::int64_t time_ns) const;

  [[nodiscard]] Transform WorldFromVehicle(std::int64_t time_ns) const override;
  [[nodiscard]] int HomeChunk(std::int64_t time_ns) const override;
  [[nodiscard]] std::vector<int> ChunksInReach(int home_chunk, double range_m) const override;
  [[nodiscard]] Transform WorldFromChunk(int chunk) const override;
  [[nodiscard]] Chunk BuildChunk(int chunk) const override;
  [[nodiscard]] const std::vector<SceneObject>& objects() const override;
  [[nodiscard]] Transform WorldFromObject(std::size_t object, std::int64_t time_ns) const override;

 private:
  struct Line;
  struct Things;
  RailWorld(std::shared_ptr<const Line> line, std::shared_ptr<const Things> things);

  std::shared_ptr<const Line> line_;
  std::shared_ptr<const Things> things_;
};

}  // namespace railcast
