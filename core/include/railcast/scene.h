#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/transform.h"

namespace railcast {

/// An indexed triangle soup. It need not be manifold, closed or consistently wound.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;                ///< m, in the frame of the owning model.
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices into `vertices`.

  /// Appends another mesh, transformed by `this_from_other`.
  void Append(const Mesh& other, const Transform& this_from_other = Transform::Identity());
};

/// Triangles that share a material and a label.
struct Part {
  Mesh mesh;
  std::uint16_t material{};  ///< Index into the material library.
  std::uint32_t label{};     ///< Id in the label table.
  bool is_wire = false;  ///< Whether the triangles are tubes around the polylines of Chunk::wires.
};

/// Geometry that may be placed many times.
struct Model {
  std::string name;
  std::vector<Part> parts;
  /// Whether it is a plant that consists mostly of many small leaves or blades. Such a model is
  /// traced faster, but a ray may pass between two triangles that share an edge.
  bool is_foliage = false;

  [[nodiscard]] std::size_t num_triangles() const;
  /// Axis-aligned bounding box in the model's own frame; empty if there are no vertices.
  [[nodiscard]] Eigen::AlignedBox3d Bounds() const;
};

/// A model of fewer and larger pieces. It replaces the finest model where, at the model's place,
/// the rays are so far apart and the beams so wide that the sensor cannot tell the two from each
/// other (docs/results/detail.md). Both limits scale with the model.
struct CoarserModel {
  /// Its parts have the surfaces of the finest model's parts, in the same order.
  std::shared_ptr<const Model> model;
  double ray_spacing_m{};  ///< Least distance between neighbouring rays.
  double beam_width_m{};   ///< Least width of beams, where they have any; 0 = any width will do.
};

/// A model placed in a chunk. The linear part may include a uniform scale.
struct Placement {
  std::shared_ptr<const Model> model;
  Eigen::Affine3d chunk_from_model = Eigen::Affine3d::Identity();
  std::uint32_t instance{};  ///< Instance id; 0 = background without instances.
  /// Height of a tree, which leans about the model's origin in the wind; 0 = it stands still.
  double sway_height_m = 0.0;
  /// Coarser forms of the model, each coarser than the one before; null = none.
  std::shared_ptr<const std::vector<CoarserModel>> coarser = nullptr;
};

/// A span of wires that the wind blows aside together.
struct WireSpan {
  std::uint32_t number{};             ///< Among all spans of the world; the same in all chunks.
  Vector3 begin_m = Vector3::Zero();  ///< At the first support, in the chunk's frame.
  Vector3 end_m = Vector3::Zero();    ///< At the second support.
  double tension_n = 0.0;             ///< Sum over its wires; 0 = it hangs still.
  double mass_kg_per_m = 0.0;         ///< Sum over its wires.
  double width_m = 0.0;               ///< Sum of the wires' diameters.
};

/// One piece of a thin conductor: a polyline with a round cross-section.
struct Wire {
  std::uint16_t material{};
  std::uint32_t label{};
  double radius_m{};
  std::vector<Vector3> points_m;  ///< In the chunk's frame; at least two.
  WireSpan span{};                ///< The span that it is part of.
};

/// A piece of the static world, in its own frame. `ground` belongs to this chunk alone;
/// `placements` are models standing on it.
struct Chunk {
  Model ground;
  std::vector<Placement> placements;
  /// The wires that `ground` also contains as tubes, in parts with `is_wire`. Ray casters see the
  /// tubes; effect thin_conductors uses the polylines.
  std::vector<Wire> wires{};
};

/// When a sensor cannot tell a chunk's coarser surfaces from the finest (docs/results/detail.md).
struct CoarserSurfaces {
  Eigen::AlignedBox2d area_m;  ///< Where in plan the chunk's surfaces lie, in its frame.
  double ray_spacing_m{};      ///< Least distance of rays at the nearest place of the area.
  double beam_width_m{};       ///< Least width of beams there, where they have any.
  double sight_angle_rad{};    ///< Greatest angle in plan between the chunk's x axis, forwards
                               ///< or backwards, and the line from its origin to the sensor.
};

/// An object with a name, a bounding box and an instance id: wagon, person, pole, ...
struct SceneObject {
  std::string name;       ///< Unique.
  std::string type;       ///< Type as the scenario names it: "box", "open_wagon", "person", ...
  std::uint32_t label{};  ///< Label of the object as a whole; its parts may have finer labels.
  std::uint32_t instance{};
  std::shared_ptr<const Model> model;
  bool moves{};   ///< Whether World::WorldFromObject() depends on time.
  bool is_ego{};  ///< Part of the sensor's own vehicle: blocks beams but returns no points.
  bool is_rail_vehicle{};  ///< Whether its type runs on rails.
  /// The rigid pieces of an object that bends, such as limbs and bogies, placed by
  /// World::WorldFromPieces(). Together they have the parts of `model`, which shows the object at
  /// rest and whose bounds contain the pieces at all times. Empty: `model` is the only piece.
  std::vector<std::shared_ptr<const Model>> pieces{};
  /// How far apart in time its poses may be, between which they are interpolated linearly. At the
  /// default, a lateral acceleration a of 2 m/s^2 bends the path by a dt^2 / 8 = 0.6 mm.
  std::int64_t pose_step_ns = 50'000'000;
};

/// Interface between the simulator and the world it scans (examples/own_world.cpp). All results
/// depend on the arguments alone, so frames can be made in any order. All functions must be
/// thread-safe. Times are simulation times; objects are given by their index in objects().
class World {
 public:
  virtual ~World() = default;

  [[nodiscard]] virtual Transform WorldFromVehicle(std::int64_t time_ns) const = 0;

  /// The chunk that contains the vehicle at this time. Its frame serves as the window frame.
  [[nodiscard]] virtual int HomeChunk(std::int64_t time_ns) const = 0;
  /// Poses of the vehicle along the whole of `home_chunk`, at most 1 m apart; empty if they are not
  /// known, in which case no placement and no chunk is traced in a coarser form.
  [[nodiscard]] virtual std::vector<Transform> VehiclePosesIn(int /*home_chunk*/) const {
    return {};
  }
  /// The chunks within `range_m` of the vehicle's origin anywhere in `home_chunk`, ascending.
  [[nodiscard]] virtual std::vector<int> ChunksInReach(int home_chunk, double range_m) const = 0;
  [[nodiscard]] virtual Transform WorldFromChunk(int chunk) const = 0;
  /// The chunk in its finest form.
  [[nodiscard]] virtual Chunk BuildChunk(int chunk) const = 0;
  /// The conditions for tracing a chunk in its coarser forms, each coarser than the one before;
  /// empty if the chunk has one form only.
  [[nodiscard]] virtual std::vector<CoarserSurfaces> CoarserSurfacesOf(int /*chunk*/) const {
    return {};
  }
  /// The chunk with fewer triangles in its `ground`, and with the same placements and wires. Level
  /// 1 is the first of CoarserSurfacesOf().
  [[nodiscard]] virtual Chunk BuildCoarserChunk(int chunk, std::size_t /*level*/) const {
    return BuildChunk(chunk);
  }

  [[nodiscard]] virtual const std::vector<SceneObject>& objects() const = 0;
  [[nodiscard]] virtual Transform WorldFromObject(std::size_t object,
                                                  std::int64_t time_ns) const = 0;
  /// The poses of an object's SceneObject::pieces, in order; its own pose if it has no pieces.
  [[nodiscard]] virtual std::vector<Transform> WorldFromPieces(std::size_t object,
                                                               std::int64_t time_ns) const {
    return {WorldFromObject(object, time_ns)};
  }
};

}  // namespace railcast
