#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/transform.h"
#include "core/scene/mesh.h"

namespace railcast {

/// A stretch of one thin conductor: a polyline, round in section.
struct Wire {
  std::uint16_t material{};
  std::uint32_t label{};
  double radius_m{};
  std::vector<Vector3> points_m;  ///< In the frame of the chunk; at least two.
};

/// A piece of the world that never moves, in its own frame: `ground` belongs to this chunk alone,
/// `placements` stand on it.
struct Chunk {
  Model ground;
  std::vector<Placement> placements;
  /// What `ground` holds once more as tubes, in parts that are `is_wire`: casters see the tubes,
  /// effect thin_conductors the polylines.
  std::vector<Wire> wires{};
};

/// A thing with a name, a box and an instance id of its own: wagon, person, pole, ...
struct SceneObject {
  std::string name;       ///< Unique.
  std::string type;       ///< As the scenario says: "box", "open_wagon", "person", ...
  std::uint32_t label{};  ///< Of the whole object; its parts may have finer ones.
  std::uint32_t instance{};
  std::shared_ptr<const Model> model;
  bool moves{};   ///< Whether world_from_object depends on time.
  bool is_ego{};  ///< Part of the sensor's own vehicle: blocks beams, gives no points.
};

/// All that the simulator asks of a world. Everything is a function of its arguments, so that any
/// frame can be made first; all calls are thread-safe.
class World {
 public:
  virtual ~World() = default;

  [[nodiscard]] virtual Transform WorldFromVehicle(std::int64_t time_ns) const = 0;

  /// The chunk whose frame is the window's at that time: the one the vehicle is in.
  [[nodiscard]] virtual int HomeChunk(std::int64_t time_ns) const = 0;
  /// The chunks that come within `range_m` of a vehicle's origin anywhere in `home_chunk`,
  /// ascending.
  [[nodiscard]] virtual std::vector<int> ChunksInReach(int home_chunk, double range_m) const = 0;
  [[nodiscard]] virtual Transform WorldFromChunk(int chunk) const = 0;
  [[nodiscard]] virtual Chunk BuildChunk(int chunk) const = 0;

  [[nodiscard]] virtual const std::vector<SceneObject>& objects() const = 0;
  [[nodiscard]] virtual Transform WorldFromObject(std::size_t object,
                                                  std::int64_t time_ns) const = 0;
};

}  // namespace railcast
