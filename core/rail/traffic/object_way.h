#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/rail/motion/path_way.h"
#include "core/rail/motion/track_path.h"
#include "core/rail/objects/object_models.h"
#include "core/rail/objects/person.h"
#include "core/rail/structures/standing_height.h"
#include "core/rail/structures/structures.h"
#include "railcast/alignment.h"
#include "railcast/objects.h"
#include "railcast/scene.h"

namespace railcast {

/// Whether an object rests on the track with two pivots: a rail vehicle that does not lean.
[[nodiscard]] bool RestsOnPivots(const ObjectSpec& object);

/// Whether an object stands on the ground below it: rail vehicles stand on the rails unless they
/// have left them, and drag shoes lie there.
[[nodiscard]] bool StandsOnGround(const ObjectSpec& object);

/// Gives a rail vehicle its pieces, body, front bogie and rear bogie, if the bogies turn against
/// the body: if it moves or stands where the track is bent. A vehicle that stands turned against
/// its track has left it, and is rigid.
void GiveBogies(const ObjectSpec& spec,
                const TrackPath& path,
                const Alignment& alignment,
                ObjectModels& models,
                SceneObject& object);

/// Motion and standing place of an object. What carries the sensor moves with the vehicle and has
/// none of this.
struct ObjectWay {
  std::optional<TrackPath> path{};  ///< Its motion along its track, or its place there.
  std::optional<PathWay> walk{};    ///< Its motion across the tracks, if it has any.
  /// The object's footprint on the ground; absent if its height is given.
  std::optional<Eigen::AlignedBox2d> ground_area_m{};
  Follow follow = Follow::kUpright;
  std::optional<MovingBoom> boom{};
  std::shared_ptr<const WalkingPerson> walker{};  ///< Moves the limbs of a person who walks.
  bool is_in_train = false;  ///< Whether it is a vehicle of one of the world's trains.
};

/// What an object follows.
struct ObjectPath {
  std::optional<TrackPath> track;
  std::optional<PathWay> walk;

  [[nodiscard]] bool moves() const { return walk.has_value() || (track && track->moves()); }
};

/// What the z axis of the object is normal to.
[[nodiscard]] inline Follow FollowOf(const ObjectSpec& object) {
  return object.follow.value_or(IsRailVehicle(object.type) ? Follow::kTrack : Follow::kUpright);
}

/// @param model The object's, at rest.
[[nodiscard]] ObjectWay WayOf(const ObjectSpec& object, const Model& model, ObjectPath path);

/// An object at one time, before it is put on the ground.
struct ObjectStance {
  Transform world_from_object;
  double s_m{};         ///< Chainage beside it.
  StandingPlace place;  ///< If it stands on the ground.
};

/// @param path Where the object is unless it walks: its own path, or that of the vehicle.
[[nodiscard]] ObjectStance StanceOf(const ObjectWay& way,
                                    const TrackPath& path,
                                    const Alignment& alignment,
                                    std::int64_t time_ns);

/// The poses of a walker's limbs in the object's frame (WalkingPerson).
/// @pre The way has a walker and a path.
[[nodiscard]] std::vector<Transform> LimbsOf(const ObjectWay& way, std::int64_t time_ns);

}  // namespace railcast
