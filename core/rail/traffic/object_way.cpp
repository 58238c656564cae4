#include "core/rail/traffic/object_way.h"

#include <cmath>
#include <utility>

#include "core/rail/objects/object_models.h"
#include "core/scene/rotation_between.h"

namespace railcast {
namespace {

/// Whether the bogies of a standing vehicle are where they are on straight track.
bool StandsStraight(const TrackPath& path, const Alignment& alignment) {
  constexpr double kRounding = 1e-9;
  const auto [body, front, rear] = path.WorldFromVehicleAt(alignment, path.ChainageAt(0));
  const Eigen::Matrix3d& axes = body.linear();
  return front.linear().isApprox(axes, kRounding) && rear.linear().isApprox(axes, kRounding);
}

Eigen::AlignedBox2d GroundAreaOf(const Model& model) {
  const Eigen::AlignedBox3d bounds_m = model.Bounds();
  return {bounds_m.min().head<2>(), bounds_m.max().head<2>()};
}

StandingPlace StandingPlaceOf(const TrackPath& path,
                              const Alignment& alignment,
                              double s_m,
                              const Eigen::AlignedBox2d& area_m) {
  const TrackOffset offset = path.course().OffsetAt(s_m);
  const double turn_rad = TurnFromAlignment_rad(alignment.At(s_m), offset);
  const TrackPose& pose = path.pose();
  return {.s_m = s_m - pose.d_m * std::sin(turn_rad),
          .d_m = offset.d_m + pose.d_m * std::cos(turn_rad),
          .heading_rad = pose.heading_rad + turn_rad,
          .area_m = area_m};
}

ObjectStance WalkingStance(const ObjectWay& way,
                           const TrackPath& path,
                           const Alignment& alignment,
                           std::int64_t time_ns) {
  const PathPlace place = way.walk->At(time_ns).place;
  const double heading_rad = place.heading_rad + path.pose().heading_rad;
  const double turn_rad = heading_rad - alignment.At(place.s_m).heading_rad;
  Eigen::Matrix3d world_from_object = RotationFromYawPitchRoll(heading_rad, 0.0, 0.0);
  if (way.follow == Follow::kTrack) {
    // Upright on the plane of the rails, and facing where it did.
    const Vector3 up = alignment.WorldFromTrack(place.s_m, place.d_m).linear().col(2);
    world_from_object = RotationBetween(Vector3::UnitZ(), up) * world_from_object;
  }
  const Vector3 position_m(place.position_m.x(), place.position_m.y(),
                           place.rail_height_m + path.pose().h_m);
  return {MakeTransform(world_from_object, position_m),
          place.s_m,
          {.s_m = place.s_m,
           .d_m = place.d_m,
           .heading_rad = turn_rad,
           .area_m = way.ground_area_m.value_or(Eigen::AlignedBox2d())}};
}

}  // namespace

bool RestsOnPivots(const ObjectSpec& object) {
  return IsRailVehicle(object.type) && object.follow.value_or(Follow::kTrack) == Follow::kTrack &&
         object.roll_deg == 0.0 && object.pitch_deg == 0.0;
}

bool StandsOnGround(const ObjectSpec& object) {
  if (object.h_m) return false;
  if (object.type.model && object.type.model->lies_on_rail) {
    return FollowOf(object) == Follow::kGround;
  }
  return !RestsOnPivots(object);
}

void GiveBogies(const ObjectSpec& spec,
                const TrackPath& path,
                const Alignment& alignment,
                ObjectModels& models,
                SceneObject& object) {
  constexpr double kRounding_rad = 1e-9;
  const TrackPose& pose = path.pose();
  const bool is_along = std::abs(std::sin(pose.heading_rad)) <= kRounding_rad;
  if (!(pose.pivot_distance_m > 0.0) || !is_along) return;
  if (!path.moves() && StandsStraight(path, alignment)) return;
  object.pieces = models.VehiclePiecesOf(spec);
}

ObjectWay WayOf(const ObjectSpec& object, const Model& model, ObjectPath path) {
  ObjectWay way{.path = std::move(path.track), .walk = std::move(path.walk)};
  if (StandsOnGround(object)) way.ground_area_m = GroundAreaOf(model);
  way.follow = FollowOf(object);
  if (WalksAbout(object)) {
    way.walker = std::make_shared<const WalkingPerson>(PersonBuildOf(object));
  }
  return way;
}

ObjectStance StanceOf(const ObjectWay& way,
                      const TrackPath& path,
                      const Alignment& alignment,
                      std::int64_t time_ns) {
  if (way.walk) return WalkingStance(way, path, alignment, time_ns);
  const double s_m = path.ChainageAt(time_ns);
  ObjectStance stance{path.WorldFromObjectAt(alignment, s_m), s_m, {}};
  if (way.ground_area_m) {
    stance.place = StandingPlaceOf(path, alignment, s_m, *way.ground_area_m);
  }
  return stance;
}

std::vector<Transform> LimbsOf(const ObjectWay& way, std::int64_t time_ns) {
  // Who faces against the way walks backwards.
  const double forwards = std::cos(way.path->pose().heading_rad) < 0.0 ? -1.0 : 1.0;
  if (way.walk) {
    const PathWay::State state = way.walk->At(time_ns);
    return way.walker->ObjectFromPieces(forwards * state.walked_m, state.speed_mps);
  }
  // Where on the track the stride begins is arbitrary.
  return way.walker->ObjectFromPieces(forwards * way.path->ChainageAt(time_ns),
                                      way.path->SpeedAt_mps(time_ns));
}

}  // namespace railcast
