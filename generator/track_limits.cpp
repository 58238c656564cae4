#include "generator/track_limits.h"

#include <string>

#include "core/base/error.h"
#include "core/base/number_text.h"

namespace railcast {
namespace {

// What stops exactly at the end of its track is still on it, whatever the last digit says.
constexpr double kTolerance_m = 1e-3;

// The first frame that something has left its track in. Nothing turns round: what has left stays
// away. @pre It has in `last_frame`.
template <typename Predicate>
std::uint32_t FirstBeyond(std::uint32_t first_frame,
                          std::uint32_t last_frame,
                          const Predicate& is_on_track) {
  while (first_frame < last_frame) {
    const std::uint32_t middle = first_frame + (last_frame - first_frame) / 2;
    if (is_on_track(middle)) {
      first_frame = middle + 1;
    } else {
      last_frame = middle;
    }
  }
  return first_frame;
}

}  // namespace

void CheckStaysOnTracks(const ScenarioSpec& scenario,
                        const RailWorld& world,
                        const ScanPattern& pattern,
                        std::uint32_t first_frame,
                        std::uint32_t last_frame) {
  ErrorList errors;
  const auto examine = [&](const std::string& place, const TrackSpec& track,
                           const auto& chainage_m) {
    const double end_s_m = track.end_s_m.value_or(world.alignment().length_m());
    const auto is_on_track = [&](std::uint32_t frame) {
      const double s_m = chainage_m(pattern.StampNs(frame) + pattern.time_ns.back());
      return s_m >= track.start_s_m - kTolerance_m && s_m <= end_s_m + kTolerance_m;
    };
    if (is_on_track(last_frame)) return;
    const std::uint32_t frame = FirstBeyond(first_frame, last_frame, is_on_track);
    errors.Add(place + " leaves track \"" + track.name + "\", from " + NumberText(track.start_s_m) +
               " to " + NumberText(end_s_m) + " m, at frame " + std::to_string(frame) + " (" +
               NumberText(static_cast<double>(pattern.StampNs(frame)) / 1e9) + " s)");
  };
  examine(world.has_changed_vehicle_speed() ? "command: the vehicle"
                                            : scenario.sources.Place("/vehicle/motion") + ":",
          world.vehicle_track(),
          [&](std::int64_t time_ns) { return world.VehicleChainage_m(time_ns); });
  const std::size_t num_of_scenario = scenario.world.objects.size();
  for (std::size_t i = 0; i < world.objects().size(); ++i) {
    const SceneObject& object = world.objects()[i];
    if (object.is_ego) continue;
    // Instance ids are those of the scenario's order, and go on from there.
    const bool is_placed = object.instance > num_of_scenario;
    examine(is_placed ? "command: object \"" + object.name + '"'
                      : scenario.sources.Place("/world/objects/" +
                                               std::to_string(object.instance - 1) + "/motion") +
                            ":",
            world.object_track(i),
            [&](std::int64_t time_ns) { return world.ObjectChainage_m(i, time_ns); });
  }
  errors.ThrowIfAny();
}

void CheckStaysOnTracks(const CommandedRun& run,
                        const ScanPattern& pattern,
                        std::uint32_t first_frame,
                        std::uint32_t last_frame) {
  // The first frame, up to the one after the last, that is stamped at that time or later.
  const auto first_at = [&](std::int64_t time_ns) {
    std::uint32_t begin = first_frame;
    std::uint32_t end = last_frame + 1;
    while (begin < end) {
      const std::uint32_t middle = begin + (end - begin) / 2;
      if (pattern.StampNs(middle) < time_ns) {
        begin = middle + 1;
      } else {
        end = middle;
      }
    }
    return begin;
  };
  const std::vector<CommandedRun::State>& states = run.states();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const std::uint32_t begin = i == 0 ? first_frame : first_at(states[i].time_ns);
    const std::uint32_t end =
        i + 1 < states.size() ? first_at(states[i + 1].time_ns) : last_frame + 1;
    if (begin >= end) continue;
    CheckStaysOnTracks(run.scenario(), *states[i].world, pattern, begin, end - 1);
  }
}

}  // namespace railcast
