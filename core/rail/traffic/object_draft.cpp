#include "core/rail/traffic/object_draft.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/rail/motion/speed_profile.h"
#include "core/rail/network/route.h"
#include "core/rail/network/turnout_place.h"
#include "core/rail/objects/mesh_object.h"
#include "core/rail/traffic/object_way.h"
#include "core/rail/traffic/trains.h"

namespace railcast {
namespace {

/// An object or vehicle on a track, moving or stationary.
struct Mover {
  std::string motion_pointer;
  std::string chainage_pointer;
  const MotionSpec& motion;
  double s_m{};
};

std::optional<SpeedProfile> DraftProfile(const Mover& mover, WorldFaults& faults) {
  const auto& points = mover.motion.profile;
  const bool is_by_chainage = !points.empty() && points.front().s_m.has_value();
  if (!faults.AreKnown({mover.motion_pointer})) return std::nullopt;
  if (is_by_chainage && !faults.AreKnown({mover.chainage_pointer})) return std::nullopt;
  return Attempt(mover.motion_pointer, faults.errors,
                 [&] { return SpeedProfile(mover.motion, mover.s_m); });
}

/// Something that follows a track or a route, and where it begins.
struct Follower {
  std::string pointer;
  const std::string& track;
  const std::vector<std::string>& route;
  const MotionSpec& motion;
  std::string chainage_pointer;
  double s_m{};
};

RouteSpec RouteOf(const Follower& follower) {
  const bool has_route = !follower.route.empty();
  return {.pointer = follower.pointer + (has_route ? "/route" : "/track"),
          .tracks = has_route ? follower.route : std::vector<std::string>{follower.track},
          .runs_back = follower.motion.reverse,
          .from_s_m = follower.s_m};
}

/// The route of a vehicle or an object. That a single track exists and that the beginning lies on
/// it is checked elsewhere (CheckWorld).
std::optional<Route> DraftRoute(const TracksOfWorld& tracks,
                                const Follower& follower,
                                WorldFaults& faults) {
  const RouteSpec spec = RouteOf(follower);
  if (!faults.AreKnown({spec.pointer})) return std::nullopt;
  std::optional<Route> route = MakeRoute(tracks.world, tracks.network, spec, faults);
  if (!route || !faults.AreKnown({follower.chainage_pointer})) return route;
  const double begin_s_m = route->course.begin_s_m();
  const double end_s_m = route->course.end_s_m();
  if (!follower.route.empty() && !(follower.s_m >= begin_s_m && follower.s_m <= end_s_m)) {
    faults.Add(follower.chainage_pointer,
               "must lie on the route, " + StretchText(begin_s_m, end_s_m),
               NumberText(follower.s_m));
  }
  if (!follower.motion.profile.empty()) {
    CheckPositions(tracks.world, tracks.network, *route, spec, faults);
  }
  return route;
}

// As CheckObject() does it for an object on a single track.
void CheckOnGround(const WorldSpec& world,
                   const ObjectSpec& object,
                   const std::string& pointer,
                   const TrackCourse& course,
                   WorldFaults& faults) {
  const double half_width_m = world.terrain.half_width_m;
  const double from_axis_m = course.OffsetWithin_m(object.s_m) + object.d_m;
  if (!faults.AreKnown({pointer + "/d_m", pointer + "/s_m", "/world/terrain/half_width_m"}) ||
      std::abs(from_axis_m) <= half_width_m) {
    return;
  }
  faults.Add(pointer + "/d_m",
             "must put it within the ground's half width of " + NumberText(half_width_m) + " m",
             NumberText(object.d_m));
}

// The entries for parts of a mesh, without what is unknown of them.
std::vector<MeshPartSpec> KnownParts(const std::vector<MeshPartSpec>& parts,
                                     const std::string& list,
                                     const WorldFaults& faults) {
  std::vector<MeshPartSpec> known = parts;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string pointer = list + "/" + std::to_string(i);
    if (!faults.AreKnown({pointer + "/material", "/materials"})) known[i].material.reset();
    if (!faults.AreKnown({pointer + "/label", "/labels"})) known[i].label.reset();
    if (!faults.AreKnown({pointer + "/of"})) return {};
  }
  return known;
}

// Adds the faults of an object. Those of its model stand in the table of models, once for all
// objects that are one.
void AddFaultsOfObject(const InputError& error, const std::string& pointer, ErrorList& errors) {
  for (const Fault& fault : error.faults()) {
    if (!fault.place.starts_with("/models/")) {
      AddAtPointer(pointer, InputError({fault}), errors);
    } else if (std::ranges::find(errors.faults(), fault) == errors.faults().end()) {
      errors.Add(fault);
    }
  }
}

}  // namespace

std::optional<TrackPath> DraftVehiclePath(const VehicleSpec& vehicle,
                                          const TracksOfWorld& tracks,
                                          WorldFaults& faults) {
  auto profile = DraftProfile(
      {"/vehicle/motion", "/vehicle/start_s_m", vehicle.motion, vehicle.start_s_m}, faults);
  std::optional<Route> route = DraftRoute(tracks,
                                          {"/vehicle", vehicle.track, vehicle.route, vehicle.motion,
                                           "/vehicle/start_s_m", vehicle.start_s_m},
                                          faults);
  if (!profile || !route) return std::nullopt;
  // A vehicle faces the way it travels.
  const double heading_rad = vehicle.motion.reverse ? std::numbers::pi : 0.0;
  const bool is_train_known = faults.AreKnown({"/vehicle/consist", "/vehicle/sensor_vehicle"});
  const double pivot_distance_m =
      is_train_known ? PivotDistance_m(vehicle) : vehicle.pivot_distance_m;
  return TrackPath(std::move(*route), {0.0, 0.0, heading_rad, false, pivot_distance_m},
                   std::move(*profile));
}

std::optional<TrackPath> DraftPath(const TracksOfWorld& tracks,
                                   const ObjectSpec& object,
                                   const std::string& pointer,
                                   std::int64_t begin_ns,
                                   WorldFaults& faults) {
  const MotionSpec motion = object.motion.value_or(MotionSpec{});
  auto profile = DraftProfile({pointer + "/motion", pointer + "/s_m", motion, object.s_m}, faults);
  std::optional<Route> route = DraftRoute(
      tracks, {pointer, object.track, object.route, motion, pointer + "/s_m", object.s_m}, faults);
  if (!profile || !route) return std::nullopt;
  if (!object.route.empty()) CheckOnGround(tracks.world, object, pointer, route->course, faults);
  TrackPose pose{object.d_m, object.h_m.value_or(0.0), RadFromDeg(object.heading_deg),
                 FollowOf(object) != Follow::kTrack};
  if (RestsOnPivots(object)) {
    pose.pivot_distance_m = MeasuresOf(object.type).pivot_distance_m;
    pose.is_midway = true;
  }
  return TrackPath(std::move(*route), pose, std::move(*profile), begin_ns);
}

ObjectPath DraftObjectPath(const PathGround& ground,
                           const DraftedObject& drafted,
                           TrackPath track,
                           WorldFaults& faults) {
  ObjectPath path;
  if (drafted.spec.motion && drafted.spec.motion->path) {
    const Eigen::AlignedBox3d bounds_m = drafted.object.model->Bounds();
    path.walk =
        DraftPathWay(ground, drafted.spec, track,
                     {bounds_m.isEmpty() ? 0.0 : bounds_m.sizes().x(), drafted.pointer}, faults);
  }
  path.track = std::move(track);
  return path;
}

std::optional<SceneObject> DraftObject(const ObjectSpec& object,
                                       const std::string& pointer,
                                       const ObjectTables& tables,
                                       WorldFaults& faults) {
  ObjectSpec known = object;
  if (!faults.AreKnown({pointer + "/type", pointer + "/size_m", pointer + "/file", pointer + "/up",
                        pointer + "/unit_m", pointer + "/origin"})) {
    return std::nullopt;
  }
  known.parts = KnownParts(object.parts, pointer + "/parts", faults);
  if (!faults.AreKnown({pointer + "/label", "/labels"})) known.label.reset();
  if (!faults.AreKnown({pointer + "/material", "/materials"})) known.material.reset();
  try {
    return SceneObject{.name = known.name,
                       .type = std::string(NameOf(known.type)),
                       .label = ObjectLabel(known, tables.surfaces, tables.labels),
                       .model = tables.models.Of(known),
                       .is_rail_vehicle = IsRailVehicle(known.type)};
  } catch (const InputError& error) {
    AddFaultsOfObject(error, pointer, faults.errors);
    return std::nullopt;
  }
}

}  // namespace railcast
