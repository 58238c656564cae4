#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "railcast/alignment.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/objects.h"
#include "railcast/rigid_motion.h"
#include "railcast/scene.h"
#include "railcast/world_spec.h"

namespace railcast {

class TrackCourse;
struct LineKey;
struct Network;
struct Route;
struct WorldDraft;

/// How the sensor's vehicle runs along its route at an instant, and how it got there.
struct VehicleTravel {
  double s_m{};                ///< Chainage of its origin.
  double speed_mps{};          ///< Rate of change of the chainage; >= 0, also in reverse.
  double acceleration_mps2{};  ///< In the direction of travel.
  double speeding_up_m{};      ///< Change of chainage since time 0 while the speed rose; >= 0.
  double slowing_down_m{};     ///< Change of chainage since time 0 while the speed fell; >= 0.
  bool runs_back{};            ///< Whether the chainage falls.
};

/// A cache of what worlds made one after another have in common: lines, which are shared by worlds
/// whose specs differ only in objects, trains and plants, and the models of plants. Keeps those
/// used last. Thread-safe.
class SharedLines {
 public:
  SharedLines();
  ~SharedLines();

 private:
  friend class RailWorld;
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// The railway world of a scenario, which MakeWorld() makes. The line is divided into chunks of
/// kChunkLength_m each, from chainage 0.
///
/// Objects have instance ids 1, 2, ... in the order of the spec, followed by the vehicles of the
/// trains, one train after the other, each from front to rear. After them come those of the
/// sensor's own train: "ego" carries the sensor, and the others are "ego/1", "ego/2", ... by their
/// places; ego boxes, if there are any, form a single "ego" instead. Moving barriers are two more
/// for each level crossing, "NAME/right" and "NAME/left" after the side of the track from which
/// road traffic approaches them. Masts have ids from 20,000 on (kFirstMastInstance). Moving
/// objects continue straight and level beyond the ends of the line.
///
/// Immutable. WithVehicleSpeed(), WithObject() and WithoutObject() return a modified world that
/// shares everything else, including its chunks, with this one. Worlds made with the same
/// SharedLines share what they have in common.
class RailWorld final : public World {
 public:
  static constexpr double kChunkLength_m = 50.0;

  /// @throws InputError if the specs contradict each other or a mesh cannot be read. Each line
  ///   reads "/world/objects/3/track: rule (got value)", with pointers into the scenario.
  /// @param shared Cache to use; it takes files of the same name to be unchanged. Null: none.
  RailWorld(const WorldSpec& world,
            const VehicleSpec& vehicle,
            const LabelTable& labels,
            const MaterialLibrary& materials,
            std::uint64_t seed,
            SharedLines* shared = nullptr);
  ~RailWorld() override;

  /// Makes the models of the plants now, which the first BuildChunk() would otherwise do.
  void PreparePlants() const;

  /// Returns this world as it is from `from_ns` on if the vehicle changes its speed: it accelerates
  /// at a constant rate to `speed_mps` and then keeps that speed. Its direction does not change.
  /// @pre from_ns >= 0 and not before an earlier change, speed_mps >= 0, acceleration_mps2 > 0
  ///   (also for slowing down).
  [[nodiscard]] std::shared_ptr<const RailWorld> WithVehicleSpeed(std::int64_t from_ns,
                                                                  double speed_mps,
                                                                  double acceleration_mps2) const;
  /// Returns this world as it is from `from_ns` on with one more object. Time 0 of the object's
  /// motion is `from_ns`. The object gets an instance id that no object of this world, or of those
  /// it was made from, has ever had; all others keep theirs.
  /// @throws InputError under the same rules as an object in a scenario; lines read "/object/track:
  ///   rule (got value)".
  [[nodiscard]] std::shared_ptr<const RailWorld> WithObject(const ObjectSpec& object,
                                                            std::int64_t from_ns) const;
  /// Returns this world without one object of the scenario or of WithObject().
  /// @throws InputError "/name: rule (got value)" if there is no object of that name.
  [[nodiscard]] std::shared_ptr<const RailWorld> WithoutObject(const std::string& name) const;

  [[nodiscard]] const Alignment& alignment() const;
  /// The courses of all tracks, and the turnouts (core/rail/network/network.h).
  [[nodiscard]] const Network& network() const;

  /// The specs of all tracks, those of yards included.
  [[nodiscard]] const std::vector<TrackSpec>& tracks() const;

  /// The track on which the vehicle begins its route.
  [[nodiscard]] const TrackSpec& vehicle_track() const;
  /// The tracks that the vehicle follows (core/rail/network/route.h), and their common course
  /// (core/rail/line/track_course.h).
  [[nodiscard]] const Route& vehicle_route() const;
  [[nodiscard]] const TrackCourse& vehicle_course() const;
  /// Whether WithVehicleSpeed() made this world or one that it was made from.
  [[nodiscard]] bool has_changed_vehicle_speed() const;
  [[nodiscard]] double VehicleSpeed_mps(std::int64_t time_ns) const;
  [[nodiscard]] VehicleTravel VehicleTravelAt(std::int64_t time_ns) const;
  /// The motion of the vehicle frame, with cant and ride. Speed and acceleration along the track
  /// are exact, and where the acceleration jumps, they are those after the jump; all else is
  /// differentiated numerically (core/rail/motion/track_path.h).
  [[nodiscard]] RigidMotion VehicleMotion(std::int64_t time_ns) const;
  /// Chainage of the vehicle's origin along its route; may lie beyond the ends of the route.
  [[nodiscard]] double VehicleChainage_m(std::int64_t time_ns) const;
  /// The track on which objects()[object] begins its route, the route, its course, and the
  /// chainage.
  [[nodiscard]] const TrackSpec& object_track(std::size_t object) const;
  [[nodiscard]] const Route& object_route(std::size_t object) const;
  [[nodiscard]] const TrackCourse& object_course(std::size_t object) const;
  [[nodiscard]] double ObjectChainage_m(std::size_t object, std::int64_t time_ns) const;

  [[nodiscard]] Transform WorldFromVehicle(std::int64_t time_ns) const override;
  [[nodiscard]] int HomeChunk(std::int64_t time_ns) const override;
  [[nodiscard]] std::vector<Transform> VehiclePosesIn(int home_chunk) const override;
  [[nodiscard]] std::vector<int> ChunksInReach(int home_chunk, double range_m) const override;
  [[nodiscard]] Transform WorldFromChunk(int chunk) const override;
  [[nodiscard]] Chunk BuildChunk(int chunk) const override;
  [[nodiscard]] std::vector<CoarserSurfaces> CoarserSurfacesOf(int chunk) const override;
  [[nodiscard]] Chunk BuildCoarserChunk(int chunk, std::size_t level) const override;
  /// Identity of the line without plants: worlds with the same one have the same BuildBareChunk().
  /// Null if no earlier world had this line, which is then likely to occur only once.
  [[nodiscard]] std::shared_ptr<const void> bare_line() const;
  /// A chunk as BuildCoarserChunk() makes it, but without PlantsOf(). @param level 0 = finest.
  [[nodiscard]] Chunk BuildBareChunk(int chunk, std::size_t level) const;
  [[nodiscard]] std::vector<Placement> PlantsOf(int chunk) const;
  [[nodiscard]] const std::vector<SceneObject>& objects() const override;
  [[nodiscard]] Transform WorldFromObject(std::size_t object, std::int64_t time_ns) const override;
  [[nodiscard]] std::vector<Transform> WorldFromPieces(std::size_t object,
                                                       std::int64_t time_ns) const override;

 private:
  friend struct SharedLines::Parts;
  struct Line;
  struct Setting;
  struct Things;
  /// @param draft Complete. What is needed is moved out of it.
  static std::shared_ptr<const Line> LayLine(WorldDraft& draft, const LineKey& key);
  /// The same world with other things.
  RailWorld(const RailWorld& like, std::shared_ptr<const Things> things);
  /// The vehicle moves on its springs, if it has any; its bogies do not.
  /// @param after_s Since `time_ns`, if its stretch of constant acceleration goes on.
  [[nodiscard]] Transform WorldFromVehicleAt(double s_m,
                                             double speed_mps,
                                             std::int64_t time_ns,
                                             double after_s) const;

  std::shared_ptr<const Line> line_;
  std::shared_ptr<const Setting> setting_;
  std::shared_ptr<const Things> things_;
};

}  // namespace railcast
