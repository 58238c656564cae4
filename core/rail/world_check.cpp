#include "core/rail/world_check.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/number_text.h"
#include "core/rail/catenary/catenary.h"

namespace railcast {
namespace {

std::string Quoted(const std::string& text) {
  return '"' + text + '"';
}

std::string Got(double value) {
  return " (got " + NumberText(value) + ")";
}

std::string Item(const char* list, std::size_t index) {
  return list + std::to_string(index);
}

void CheckTrack(const WorldSpec& world,
                std::size_t index,
                const LineMeasures& line,
                ErrorList& errors) {
  const TrackSpec& track = world.tracks[index];
  const std::string place = Item("/world/tracks/", index);
  if (FindTrack(world, track.name) != &track) {
    errors.Add(place + "/name: must be unique (got " + Quoted(track.name) + ")");
  }
  if (!(std::abs(track.offset_m) < world.terrain.half_width_m)) {
    errors.Add(place + "/offset_m: must lie within the ground's half width of " +
               NumberText(world.terrain.half_width_m) + " m" + Got(track.offset_m));
  }
  if (!(track.start_s_m >= 0.0 && track.start_s_m < line.length_m)) {
    errors.Add(place + "/start_s_m: must be >= 0 and less than the line's length of " +
               NumberText(line.length_m) + " m" + Got(track.start_s_m));
  }
  if (track.end_s_m && !(*track.end_s_m > track.start_s_m && *track.end_s_m <= line.length_m)) {
    errors.Add(place +
               "/end_s_m: must be greater than start_s_m and at most the line's length of " +
               NumberText(line.length_m) + " m" + Got(*track.end_s_m));
  }
}

/// Where something is said to be on a track.
struct TrackPlace {
  std::string track_pointer;
  std::string chainage_pointer;
  const std::string& track;
  double s_m{};
};

const TrackSpec* CheckPlace(const WorldSpec& world,
                            const TrackPlace& place,
                            const LineMeasures& line,
                            ErrorList& errors) {
  const TrackSpec* track = FindTrack(world, place.track);
  if (track == nullptr) {
    std::string names;
    for (const TrackSpec& known : world.tracks) {
      names += (names.empty() ? "" : ", ") + Quoted(known.name);
    }
    errors.Add(place.track_pointer + ": must be one of " + names + " (got " + Quoted(place.track) +
               ")");
    return nullptr;
  }
  const double end_s_m = track->end_s_m.value_or(line.length_m);
  if (!(place.s_m >= track->start_s_m && place.s_m <= end_s_m)) {
    errors.Add(place.chainage_pointer + ": must lie on track " + Quoted(track->name) + ", from " +
               NumberText(track->start_s_m) + " to " + NumberText(end_s_m) + " m" + Got(place.s_m));
  }
  return track;
}

void CheckObject(const WorldSpec& world,
                 std::size_t index,
                 const LineMeasures& line,
                 ErrorList& errors) {
  const ObjectSpec& object = world.objects[index];
  const std::string pointer = Item("/world/objects/", index);
  const TrackPlace place{pointer + "/track", pointer + "/s_m", object.track, object.s_m};
  const TrackSpec* track = CheckPlace(world, place, line, errors);
  if (track == nullptr) return;
  const double from_axis_m = std::abs(track->offset_m + object.d_m);
  if (!(from_axis_m <= world.terrain.half_width_m)) {
    errors.Add(pointer + "/d_m: must lie within the ground's half width of " +
               NumberText(world.terrain.half_width_m) + " m" + Got(object.d_m));
  }
}

void CheckNames(const WorldSpec& world, ErrorList& errors) {
  // The instance ids from there on are the masts'; one is the vehicle's own.
  constexpr std::size_t kMaxObjects = kFirstMastInstance - 2;
  if (world.objects.size() > kMaxObjects) {
    errors.Add("/world/objects: must be at most " + std::to_string(kMaxObjects) + " (got " +
               std::to_string(world.objects.size()) + ")");
  }
  std::set<std::string> names{"ego"};
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    const std::string& name = world.objects[i].name;
    if (!names.insert(name).second) {
      errors.Add(Item("/world/objects/", i) + "/name: must be unique" +
                 (name == "ego" ? ", and ego is the vehicle itself" : "") + " (got " +
                 Quoted(name) + ")");
    }
  }
}

void CheckEgoBoxes(const VehicleSpec& vehicle, ErrorList& errors) {
  for (std::size_t i = 0; i < vehicle.ego_boxes_m.size(); ++i) {
    const std::array<double, 6>& box = vehicle.ego_boxes_m[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!(box[axis] < box[axis + 3])) {
        errors.Add(Item("/vehicle/ego_boxes_m/", i) + "/" + std::to_string(axis + 3) +
                   ": must be greater than the box's least of " + NumberText(box[axis]) +
                   Got(box[axis + 3]));
      }
    }
  }
}

}  // namespace

const TrackSpec* FindTrack(const WorldSpec& world, const std::string& name) {
  const auto found = std::find_if(world.tracks.begin(), world.tracks.end(),
                                  [&](const TrackSpec& track) { return track.name == name; });
  return found == world.tracks.end() ? nullptr : &*found;
}

void CheckWorld(const WorldSpec& world,
                const VehicleSpec& vehicle,
                const LineMeasures& line,
                ErrorList& errors) {
  const double half_width_m = world.terrain.half_width_m;
  if (!(half_width_m > 0.0)) {
    errors.Add("/world/terrain/half_width_m: must be > 0" + Got(half_width_m));
  } else if (!(half_width_m < line.tightest_radius_m)) {
    errors.Add("/world/terrain/half_width_m: must be less than the line's tightest radius of " +
               NumberText(line.tightest_radius_m) + " m" + Got(half_width_m));
  }
  if (world.tracks.empty()) {
    errors.Add("/world/tracks: must have at least one track (got none)");
    return;  // Everything below would complain about its track.
  }
  for (std::size_t i = 0; i < world.tracks.size(); ++i) CheckTrack(world, i, line, errors);
  for (std::size_t i = 0; i < world.objects.size(); ++i) CheckObject(world, i, line, errors);
  CheckNames(world, errors);
  CheckPlace(world, {"/vehicle/track", "/vehicle/start_s_m", vehicle.track, vehicle.start_s_m},
             line, errors);
  CheckEgoBoxes(vehicle, errors);
}

}  // namespace railcast
