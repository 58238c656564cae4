#include "core/fidelity/sample_frames.h"

#include <algorithm>
#include <cmath>

#include "core/rail/world_check.h"
#include "railcast/rail_world.h"

namespace railcast {
namespace {

bool IsOnTrack(const ScenarioSpec& scenario, const Simulator& simulator, std::uint32_t frame) {
  const auto* const world = dynamic_cast<const RailWorld*>(&simulator.world());
  const TrackSpec* const track = FindTrack(scenario.world, scenario.vehicle.track);
  // The world of a host program has no tracks.
  if (world == nullptr || track == nullptr) return true;
  const double s_m = world->VehicleChainage_m(simulator.pattern().StampNs(frame));
  return s_m >= track->start_s_m && s_m <= track->end_s_m.value_or(world->alignment().length_m());
}

}  // namespace

std::vector<std::uint32_t> SampleFrames(const ScenarioSpec& scenario,
                                        const Simulator& simulator,
                                        int num_frames,
                                        double spacing_s) {
  const auto num_steps = static_cast<std::uint32_t>(num_frames - 1);
  const double frames_apart = std::max(1.0, std::round(spacing_s * simulator.pattern().rate_hz));
  auto step = static_cast<std::uint32_t>(frames_apart);
  while (step > 1 && !IsOnTrack(scenario, simulator, num_steps * step)) step /= 2;
  std::vector<std::uint32_t> frames;
  for (std::uint32_t i = 0; i <= num_steps; ++i) frames.push_back(i * step);
  return frames;
}

}  // namespace railcast
