#include "core/scenario/track_limits.h"

#include <algorithm>
#include <functional>
#include <iomanip>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/route.h"
#include "core/rail/traffic/trains.h"
#include "core/scene/object_contacts.h"

namespace railcast {
namespace {

std::string DepthText(double gap_m) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << -gap_m << " m";
  return text.str();
}

// A vehicle that stops exactly at the end of its track is still on it, whatever the rounding.
constexpr double kTolerance_m = 1e-3;

/// A moving object, the track that it may be on, and its position.
struct Traveller {
  /// The beginning of an error line about it; rarely needed, so computed on demand.
  std::function<std::string()> place;
  const Route& route;
  std::function<double(std::int64_t)> chainage_m;
  double least_s_m{};  ///< Least chainage at which all of it is on the track.
  double most_s_m{};   ///< Greatest.

  [[nodiscard]] bool IsOnTrack(std::int64_t time_ns) const {
    const double s_m = chainage_m(time_ns);
    return s_m >= least_s_m - kTolerance_m && s_m <= most_s_m + kTolerance_m;
  }
  [[nodiscard]] std::string Leaves(const std::string& when) const {
    return place() + " leaves " + WayText(route) + ", from " +
           NumberText(route.course.begin_s_m()) + " to " + NumberText(route.course.end_s_m()) +
           " m, at " + when;
  }
};

/// A train whose foremost buffers reach its track's end before the point does whose chainage is
/// known.
struct TrainFront {
  double ahead_m{};  ///< Distance of that point, measured along the track.
  bool runs_back{};
};

// Asked for every frame of a run: measures no more of the track than the last metres. Beside a
// curve they may be longer or shorter than their chainage, but not by a factor of four.
void KeepOnTrack(const TrainFront& front, const Alignment& alignment, Traveller& traveller) {
  const TrackCourse& course = traveller.route.course;
  const double begin_s_m = course.begin_s_m();
  const double end_s_m = course.end_s_m();
  const double reach_m = std::min(4.0 * front.ahead_m, end_s_m - begin_s_m);
  if (front.runs_back) {
    const TrackLength length(alignment, course, begin_s_m, begin_s_m + reach_m);
    traveller.least_s_m = length.MovedFrom(begin_s_m, front.ahead_m);
  } else {
    const TrackLength length(alignment, course, end_s_m - reach_m, end_s_m);
    traveller.most_s_m = length.MovedFrom(end_s_m, -front.ahead_m);
  }
}

std::vector<Traveller> TravellersOf(const ScenarioSpec& scenario, const RailWorld& world) {
  std::vector<Traveller> travellers;
  const auto add = [&](auto place, const Route& route, auto chainage_m) {
    travellers.push_back({std::move(place), route, std::move(chainage_m), route.course.begin_s_m(),
                          route.course.end_s_m()});
  };
  add(
      [&scenario, &world] {
        return world.has_changed_vehicle_speed() ? "command: the vehicle"
                                                 : scenario.sources.Place("/vehicle/motion") + ":";
      },
      world.vehicle_route(),
      [&world](std::int64_t time_ns) { return world.VehicleChainage_m(time_ns); });
  if (!scenario.vehicle.consist.empty()) {
    KeepOnTrack({OriginBehindFront_m(scenario.vehicle), scenario.vehicle.motion.reverse},
                world.alignment(), travellers.back());
  }
  for (std::size_t i = 0; i < world.objects().size(); ++i) {
    const SceneObject& object = world.objects()[i];
    const auto of_train = VehicleWithInstance(scenario.world, object.instance);
    // Where the first vehicle of a train is, the others follow.
    if (object.is_ego || (of_train && of_train->vehicle > 0)) continue;
    const auto place = [&scenario, &object, of_train] {
      // Instance ids follow the scenario's order; those of objects that commands added come after.
      if (of_train) {
        return scenario.sources.Place("/world/trains/" + std::to_string(of_train->train) +
                                      "/motion") +
               ":";
      }
      if (object.instance > scenario.world.objects.size()) {
        return "command: object \"" + ShownText(object.name) + '"';
      }
      return scenario.sources.Place("/world/objects/" + std::to_string(object.instance - 1) +
                                    "/motion") +
             ":";
    };
    add(place, world.object_route(i),
        [&world, i](std::int64_t time_ns) { return world.ObjectChainage_m(i, time_ns); });
    if (of_train) {
      const TrainSpec& train = scenario.world.trains[of_train->train];
      KeepOnTrack({MiddleBehindFront_m(train.vehicles, 0), RunsBack(train)}, world.alignment(),
                  travellers.back());
    }
  }
  return travellers;
}

}  // namespace

void CheckVehicleIsClear(const ScenarioSpec& scenario,
                         const World& world,
                         const ScanPattern& pattern,
                         std::uint32_t first_frame,
                         std::uint32_t last_frame) {
  if (scenario.vehicle.may_overlap) return;
  const std::int64_t last_stamp_ns = pattern.StampNs(last_frame);
  ContactFinder finder(world);
  std::set<std::size_t> met;
  ErrorList errors;
  for (std::uint32_t frame = first_frame;; ++frame) {
    const std::int64_t stamp_ns = pattern.StampNs(frame);
    for (const ObjectContact& contact : finder.FindOfVehicle(stamp_ns)) {
      const std::size_t object = world.objects()[contact.one].is_ego ? contact.other : contact.one;
      if (!contact.is_overlap() || !met.insert(object).second) continue;
      errors.AddLine(scenario.sources.Place("/vehicle") +
                     ": must not be inside an object unless may_overlap is true (got " +
                     DepthText(contact.gap_m) + " inside " + Quoted(world.objects()[object].name) +
                     " at frame " + std::to_string(frame) + " (" + SecondsText(stamp_ns) + "))");
    }
    if (frame == last_frame || AreStillBetween(world, stamp_ns, last_stamp_ns)) break;
  }
  errors.ThrowIfAny();
}

void CheckStaysOnTracks(const ScenarioSpec& scenario,
                        const RailWorld& world,
                        const ScanPattern& pattern,
                        std::uint32_t first_frame,
                        std::uint32_t last_frame) {
  ErrorList errors;
  for (const Traveller& traveller : TravellersOf(scenario, world)) {
    const auto is_on_track = [&](std::uint32_t frame) {
      return traveller.IsOnTrack(pattern.StampNs(frame) + pattern.time_ns.back());
    };
    // Directions never reverse: an object that has left its track stays off it.
    if (is_on_track(last_frame)) continue;
    const std::uint32_t frame = FirstFrameBeyond(first_frame, last_frame, is_on_track);
    errors.AddLine(traveller.Leaves("frame " + std::to_string(frame) + " (" +
                                    SecondsText(pattern.StampNs(frame)) + ")"));
  }
  errors.ThrowIfAny();
}

std::uint32_t LastFrameOnTracks(const ScenarioSpec& scenario,
                                const RailWorld& world,
                                const ScanPattern& pattern,
                                std::uint32_t last_frame) {
  for (const Traveller& traveller : TravellersOf(scenario, world)) {
    const auto is_on_track = [&](std::uint32_t frame) {
      return traveller.IsOnTrack(pattern.StampNs(frame) + pattern.time_ns.back());
    };
    if (is_on_track(last_frame)) continue;
    const std::uint32_t beyond = FirstFrameBeyond(0, last_frame, is_on_track);
    last_frame = beyond == 0 ? 0 : beyond - 1;
  }
  return last_frame;
}

std::uint32_t FirstStampedAt(const ScanPattern& pattern,
                             std::int64_t time_ns,
                             std::uint32_t begin,
                             std::uint32_t end) {
  return FirstFrameBeyond(begin, end,
                          [&](std::uint32_t frame) { return pattern.StampNs(frame) < time_ns; });
}

std::uint32_t LastFrameBefore(const ScanPattern& pattern, std::int64_t time_ns) {
  const std::uint32_t first = FirstStampedAt(pattern, time_ns, 0, pattern.LastFrame());
  return pattern.StampNs(first) < time_ns || first == 0 ? first : first - 1;
}

}  // namespace railcast
