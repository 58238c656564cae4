#include "generator/extras/insert/plan/standing_things.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/base/text.h"
#include "core/rail/line/line_place.h"
#include "core/rail/traffic/object_way.h"

namespace railcast {
namespace {

/// Where an object stands at a time, at the height of the rails.
struct ObjectFoot {
  std::int64_t time_ns{};
  Vector3 place_m = Vector3::Zero();
};

/// The times at which frames begin, and those between them, at most 0.2 s apart but in the
/// recording's gaps; the first alone of what does not move.
std::vector<std::int64_t> TimesOf(const RailWorld& things,
                                  std::size_t object,
                                  const RecordedWay& way) {
  constexpr std::int64_t kStep_ns = 200'000'000;
  constexpr std::int64_t kMostSteps = 100;
  std::vector<std::int64_t> times_ns = {0};
  if (!things.objects()[object].moves) return times_ns;
  for (const std::int64_t next_ns : way.frame_times_ns) {
    const std::int64_t gap_ns = next_ns - times_ns.back();
    const std::int64_t num_steps = std::min((gap_ns + kStep_ns - 1) / kStep_ns, kMostSteps);
    const std::int64_t from_ns = times_ns.back();
    for (std::int64_t i = 1; i <= num_steps; ++i) {
      times_ns.push_back(i == num_steps ? next_ns : from_ns + gap_ns / num_steps * i);
    }
  }
  return times_ns;
}

/// Where an object is during the recording, at times at which it has moved on: at most 100 places,
/// so that their points fit into memory.
std::vector<ObjectFoot> FeetOf(const RailWorld& things,
                               std::size_t object,
                               const RecordedWay& way) {
  constexpr double kSpacing_m = 1.0;
  constexpr double kStill_m = 0.01;
  std::vector<ObjectFoot> feet;
  std::optional<ObjectFoot> waiting;  // Where it has stood since the last foot.
  for (const std::int64_t time_ns : TimesOf(things, object, way)) {
    const ObjectFoot now{time_ns, things.WorldFromObject(object, time_ns).translation()};
    if (!feet.empty()) {
      const double moved_m = (now.place_m - feet.back().place_m).head<2>().norm();
      if (moved_m < kStill_m) waiting = now;
      if (moved_m < kSpacing_m) continue;
    }
    if (waiting) feet.push_back(*std::exchange(waiting, std::nullopt));
    feet.push_back(now);
  }
  constexpr std::size_t kMostFeet = 100;
  const std::size_t num_feet = std::min(feet.size(), kMostFeet);
  for (std::size_t i = 0; i < num_feet; ++i) feet[i] = feet[i * feet.size() / num_feet];
  feet.resize(num_feet);
  const Alignment& alignment = things.alignment();
  for (ObjectFoot& foot : feet) {
    const double near_s_m = things.ObjectChainage_m(object, foot.time_ns);
    const PlaceBesideLine place = PlaceOnLine(alignment, foot.place_m, near_s_m);
    foot.place_m.z() = alignment.At(place.s_m).position_m.z();
  }
  return feet;
}

/// The ground along an object's way; where it was not found, that of the nearest place where it
/// was.
std::vector<GroundAtTime> GroundAlong(const std::vector<ObjectFoot>& feet,
                                      const std::vector<RecordedGround>& found) {
  std::vector<GroundAtTime> ground;
  for (std::size_t i = 0; i < feet.size(); ++i) {
    if (found[i].is_found()) {
      ground.push_back({feet[i].time_ns, found[i].height_m, found[i].up});
    }
  }
  if (!ground.empty()) return ground;
  for (const ObjectFoot& foot : feet) {
    ground.push_back({foot.time_ns, foot.place_m.z(), Vector3::UnitZ()});
  }
  return ground;
}

std::string GroundRemark(const std::string& name,
                         const std::vector<ObjectFoot>& feet,
                         const std::vector<RecordedGround>& found) {
  const auto num_found = std::ranges::count_if(found, &RecordedGround::is_found);
  const std::string object = Quoted(name) + ": ";
  if (num_found == 0) {
    return object +
           "no recorded ground was found within 3 m of it; it stands in the plane of the "
           "rails";
  }
  const auto first = std::ranges::find_if(found, &RecordedGround::is_found);
  const double above_m =
      first->height_m - feet[static_cast<std::size_t>(first - found.begin())].place_m.z();
  const auto residual_m = std::ranges::max_element(found, {}, &RecordedGround::residual_m);
  std::string remark = object + "stands on recorded ground " + ShortText(std::abs(above_m)) +
                       " m " + (above_m < 0.0 ? "below" : "above") + " the rails, a plane of " +
                       NumberText(first->num_points) + " points within " +
                       NumberText(first->radius_m) + " m with a residual of " +
                       ShortText(residual_m->residual_m) + " m";
  if (feet.size() > 1) {
    remark += "; found at " + NumberText(num_found) + " of " + NumberText(feet.size()) +
              " places along its way";
  }
  return remark;
}

}  // namespace

std::vector<StandOnRecording> LetGoOfGround(ScenarioSpec& plan) {
  std::vector<StandOnRecording> stands;
  for (ObjectSpec& object : plan.world.objects) {
    StandOnRecording stand;
    stand.is_on_ground = StandsOnGround(object);
    stand.follows_slope = stand.is_on_ground && FollowOf(object) == Follow::kGround;
    if (stand.follows_slope) object.follow = Follow::kUpright;
    stands.push_back(stand);
  }
  return stands;
}

// NOLINTNEXTLINE(readability-function-size): adds to what is known of each
void StandOnGround(const std::filesystem::path& recording,
                   const RecordedWay& way,
                   const ScenarioSpec& plan,
                   const RailWorld& things,
                   std::vector<StandOnRecording>& stands,
                   std::vector<PlacedThing>& places,
                   std::vector<std::string>& remarks) {
  std::vector<std::vector<ObjectFoot>> feet(stands.size());
  std::vector<Vector3> places_m;
  for (std::size_t i = 0; i < stands.size(); ++i) {
    if (stands[i].is_on_ground) feet[i] = FeetOf(things, i, way);
    for (const ObjectFoot& foot : feet[i]) places_m.push_back(foot.place_m);
  }
  const std::vector<RecordedGround> found = FindGround(
      recording, way, VehicleFromSensor(plan.lidar.mount) * NominalFromTrue(plan.lidar.mount_error),
      places_m);
  auto next = found.begin();
  for (std::size_t i = 0; i < stands.size(); ++i) {
    if (feet[i].empty()) continue;
    const auto end = next + static_cast<std::ptrdiff_t>(feet[i].size());
    const std::vector<RecordedGround> below(next, end);
    next = end;
    stands[i].ground = GroundAlong(feet[i], below);
    places[i].is_on_ground = true;
    for (const RecordedGround& ground : below) {
      if (!ground.is_found()) continue;
      places[i].has_ground = true;
      places[i].ground_residual_m = std::max(places[i].ground_residual_m, ground.residual_m);
    }
    remarks.push_back(GroundRemark(things.objects()[i].name, feet[i], below));
  }
}

}  // namespace railcast
