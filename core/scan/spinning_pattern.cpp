#include "core/scan/spinning_pattern.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "core/base/units.h"
#include "core/scan/firing.h"

namespace railcast {
namespace {

constexpr double kFullTurn_deg = 360.0;
constexpr double kUsPerS = 1e6;
/// Relative tolerance for cycles that fill the period exactly: 1800 x 55.5555556 us is slightly
/// more than 100 ms.
constexpr double kFullPeriodTolerance = 1e-6;

void CheckChannel(const ChannelSpec& channel,
                  const std::string& place,
                  double cycle_us,
                  ErrorList& errors) {
  if (!(std::abs(channel.elevation_deg) <= 90.0)) {
    errors.Add(
        FaultOf(place + "/elevation_deg", "must be >= -90 and <= 90", channel.elevation_deg));
  }
  if (!(std::abs(channel.azimuth_deg) <= kFullTurn_deg)) {
    errors.Add(FaultOf(place + "/azimuth_deg", "must be >= -360 and <= 360", channel.azimuth_deg));
  }
  if (!(channel.time_us >= 0.0 && channel.time_us < cycle_us)) {
    errors.Add(FaultOf(place + "/time_us", "must be >= 0 and < cycle_us", channel.time_us));
  }
}

void CheckChannels(const std::vector<ChannelSpec>& channels, double cycle_us, ErrorList& errors) {
  if (channels.empty()) {
    errors.Add({"/pattern/channels", "must have at least one channel", "0"});
    return;
  }
  for (std::size_t i = 0; i < channels.size(); ++i) {
    CheckChannel(channels[i], "/pattern/channels/" + std::to_string(i), cycle_us, errors);
  }
  const double first_us = std::ranges::min(channels, {}, &ChannelSpec::time_us).time_us;
  if (first_us > 0.0) {
    errors.Add(FaultOf("/pattern/channels", "the earliest time_us must be 0", first_us));
  }
}

void CheckBeamOrigin(const SpinningSpec& spec, ErrorList& errors) {
  if (!spec.beam_origin_m) return;
  for (std::size_t i = 0; i < spec.beam_origin_m->size(); ++i) {
    const double place_m = (*spec.beam_origin_m)[i];
    if (std::abs(place_m) <= 1.0) continue;
    errors.Add(
        FaultOf("/pattern/beam_origin_m/" + std::to_string(i), "must be >= -1 and <= 1", place_m));
  }
}

void CheckWindow(const SpinningSpec& spec, ErrorList& errors) {
  if (!spec.azimuth_window_deg) return;
  const auto& [begin_deg, end_deg] = *spec.azimuth_window_deg;
  for (std::size_t i = 0; i < 2; ++i) {
    const double end_of_window_deg = (*spec.azimuth_window_deg)[i];
    if (end_of_window_deg >= 0.0 && end_of_window_deg <= kFullTurn_deg) continue;
    errors.Add(FaultOf("/pattern/azimuth_window_deg/" + std::to_string(i),
                       "must be >= 0 and <= 360", end_of_window_deg));
  }
  if (begin_deg == end_deg) {
    errors.Add(
        FaultOf("/pattern/azimuth_window_deg", "must begin and end at two azimuths", begin_deg));
  }
}

double RotorDeg(const SpinningSpec& spec, double rate_hz, double time_us) {
  return spec.start_azimuth_deg + kFullTurn_deg * rate_hz * time_us / kUsPerS;
}

bool IsInWindow(const SpinningSpec& spec, double rotor_deg) {
  if (!spec.azimuth_window_deg) return true;
  const auto [begin_deg, end_deg] = *spec.azimuth_window_deg;
  const double width_deg = end_deg - begin_deg + (end_deg > begin_deg ? 0.0 : kFullTurn_deg);
  // So that a cycle that begins where the window does is in it, and one at its end is not.
  constexpr double kRounding_deg = 1e-6;
  const double past_deg = rotor_deg - begin_deg + kRounding_deg;
  return past_deg - kFullTurn_deg * std::floor(past_deg / kFullTurn_deg) < width_deg;
}

void CheckSpec(const SpinningSpec& spec, double rate_hz, ErrorList& errors) {
  CheckBeamOrigin(spec, errors);
  CheckWindow(spec, errors);
  if (!(std::abs(spec.start_azimuth_deg) <= kFullTurn_deg)) {
    errors.Add(FaultOf("/pattern/start_azimuth_deg", "must be >= -360 and <= 360",
                       spec.start_azimuth_deg));
  }
  CheckCycles({spec.channels, spec.cycle_us, spec.columns}, rate_hz, errors);
}

}  // namespace

void CheckCycles(const FiringCycles& cycles, double rate_hz, ErrorList& errors) {
  const auto& [channels, cycle_us, columns] = cycles;
  if (!(cycle_us > 0.0 && std::isfinite(cycle_us))) {
    errors.Add(FaultOf("/pattern/cycle_us", "must be > 0", cycle_us));
    return;
  }
  CheckChannels(channels, cycle_us, errors);
  if (columns == 0) errors.Add({"/pattern/columns", "must be > 0", "0"});
  const double scan_us = columns * cycle_us;
  if (scan_us * rate_hz > kUsPerS * (1.0 + kFullPeriodTolerance)) {
    errors.Add(FaultOf("/pattern/columns", "columns x cycle_us must be <= 1 / rate_hz", scan_us));
  }
  const double num_firings = static_cast<double>(channels.size()) * columns;
  if (num_firings > static_cast<double>(kMaxNumFirings) || channels.size() > 65536) {
    errors.Add(FaultOf("/pattern", "must have at most 16777216 firings", num_firings));
  }
}

std::vector<std::uint16_t> RowsByElevation(const std::vector<ChannelSpec>& channels) {
  std::vector<std::size_t> by_elevation(channels.size());
  std::iota(by_elevation.begin(), by_elevation.end(), std::size_t{0});
  std::ranges::stable_sort(by_elevation, {},
                           [&](std::size_t i) { return channels[i].elevation_deg; });
  std::vector<std::uint16_t> rows(channels.size());
  for (std::size_t rank = 0; rank < rows.size(); ++rank) {
    rows[by_elevation[rank]] = static_cast<std::uint16_t>(rank);
  }
  return rows;
}

std::vector<std::uint32_t> FiredCycles(const SpinningSpec& spec, double rate_hz) {
  std::vector<std::uint32_t> cycles;
  for (std::uint32_t cycle = 0; cycle < spec.columns; ++cycle) {
    if (IsInWindow(spec, RotorDeg(spec, rate_hz, cycle * spec.cycle_us))) cycles.push_back(cycle);
  }
  return cycles;
}

void AddBeamOrigins(const SpinningSpec& spec, ScanPattern& pattern) {
  const auto [out_m, up_m] = spec.beam_origin_m.value();
  const double left_positive = spec.rotation == Rotation::kClockwise ? -1.0 : 1.0;
  for (const std::uint32_t time_ns : pattern.time_ns) {
    const double turns = pattern.rate_hz * SecondsFromNs(time_ns);
    const double rotor_rad =
        left_positive * RadFromDeg(spec.start_azimuth_deg + kFullTurn_deg * turns);
    pattern.origin_x_m.push_back(static_cast<float>(out_m * std::cos(rotor_rad)));
    pattern.origin_y_m.push_back(static_cast<float>(out_m * std::sin(rotor_rad)));
    pattern.origin_z_m.push_back(static_cast<float>(up_m));
  }
}

FiringGrid SpinningFirings(const SpinningSpec& spec, double rate_hz, ErrorList& errors) {
  CheckSpec(spec, rate_hz, errors);
  if (!errors.empty()) return {};

  const std::vector<std::uint16_t> rows = RowsByElevation(spec.channels);
  const std::vector<std::uint32_t> cycles = FiredCycles(spec, rate_hz);
  if (cycles.empty()) {
    errors.Add({"/pattern/azimuth_window_deg", "must have the begin of a firing cycle", ""});
    return {};
  }
  const double left_positive = spec.rotation == Rotation::kClockwise ? -1.0 : 1.0;
  FiringGrid grid{.rows = static_cast<std::uint32_t>(rows.size()),
                  .columns = static_cast<std::uint32_t>(cycles.size()),
                  .firings = {}};
  grid.firings.reserve(rows.size() * cycles.size());
  for (std::uint32_t column = 0; column < grid.columns; ++column) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const ChannelSpec& channel = spec.channels[i];
      const double time_us = cycles[column] * spec.cycle_us + channel.time_us;
      const double rotor_deg = RotorDeg(spec, rate_hz, time_us);
      grid.firings.push_back(
          {.azimuth_rad = RadFromDeg(left_positive * (rotor_deg + channel.azimuth_deg)),
           .elevation_rad = RadFromDeg(channel.elevation_deg),
           .time_ns = std::llround(time_us * kNsPerUs),
           .row = rows[i],
           .column = column});
    }
  }
  return grid;
}

}  // namespace railcast
