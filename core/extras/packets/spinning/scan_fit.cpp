#include "core/extras/packets/spinning/scan_fit.h"

#include <cmath>
#include <variant>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scan/spinning_pattern.h"

namespace railcast {

ScanFit::ScanFit(std::string_view protocol)
    : prefix_("--protocol " + std::string(protocol) + ": /lidar") {}

void ScanFit::CheckPattern(const ScanSpec& scan, const PacketScan& expected) const {
  const std::string name(expected.name);
  const auto* const pattern = std::get_if<SpinningSpec>(&scan.pattern);
  if (pattern == nullptr) Fail("/scan/pattern/type", "must be \"spinning\"");
  if (pattern->rotation != Rotation::kClockwise) {
    Fail("/scan/pattern/rotation", "must be \"clockwise\"", Quoted(NameOf(pattern->rotation)));
  }
  if (pattern->channels.size() != expected.channels.size()) {
    Fail("/scan/pattern/channels",
         "must be " + NumberText(expected.channels.size()) + " as " + name + " has",
         NumberText(pattern->channels.size()));
  }
  if (!expected.has_own_angles) {
    CheckNear("/scan/pattern/cycle_us", pattern->cycle_us, expected.cycle_us, kMaxTimeOffset_us,
              name);
    CheckChannels(pattern->channels, expected);
  }
  CheckColumns(*pattern, scan.rate_hz, expected.cycles_per_block);
}

void ScanFit::Fail(const std::string& place,
                   const std::string& rule,
                   const std::string& got) const {
  throw InputError(prefix_ + place + ": " + rule + (got.empty() ? "" : " (got " + got + ")"));
}

void ScanFit::CheckNear(const std::string& place,
                        double got,
                        double expected,
                        double tolerance,
                        const std::string& name) const {
  if (std::abs(got - expected) <= tolerance) return;
  Fail(place, "must be " + NumberText(expected) + " as of " + name, NumberText(got));
}

void ScanFit::CheckChannels(const std::vector<ChannelSpec>& channels,
                            const PacketScan& expected) const {
  const std::string name(expected.name);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const std::string place = "/scan/pattern/channels/" + NumberText(i);
    const ChannelSpec& laser = expected.channels[i];
    CheckNear(place + "/elevation_deg", channels[i].elevation_deg, laser.elevation_deg,
              kMaxChannelOffset_deg, name);
    CheckNear(place + "/azimuth_deg", channels[i].azimuth_deg, laser.azimuth_deg,
              kMaxChannelOffset_deg, name);
    CheckNear(place + "/time_us", channels[i].time_us, laser.time_us, kMaxTimeOffset_us, name);
  }
}

void ScanFit::CheckColumns(const SpinningSpec& pattern,
                           double rate_hz,
                           std::size_t cycles_per_block) const {
  // The margin is for rounding: 1800 x 55.5555556 us is slightly more than 100 ms.
  const double fitting = std::floor(1e6 / (rate_hz * pattern.cycle_us) * (1.0 + 1e-6));
  const double most = fitting - std::fmod(fitting, static_cast<double>(cycles_per_block));
  if (pattern.columns == most) return;
  Fail("/scan/pattern/columns", "must be " + NumberText(most) + ", a whole turn",
       NumberText(pattern.columns));
}

std::vector<std::uint32_t> ColumnsOfCycles(const SpinningSpec& pattern, double rate_hz) {
  std::vector<std::uint32_t> columns(pattern.columns, kNotFired);
  std::uint32_t column = 0;
  for (const std::uint32_t cycle : FiredCycles(pattern, rate_hz)) columns[cycle] = column++;
  return columns;
}

std::uint16_t RotorAzimuth(double start_azimuth_deg, double turns) {
  const std::int64_t units = std::llround((start_azimuth_deg + 360.0 * turns) / kAzimuthUnit_deg);
  const std::int64_t in_turn = units % kAzimuthUnitsPerTurn;
  return static_cast<std::uint16_t>(in_turn < 0 ? in_turn + kAzimuthUnitsPerTurn : in_turn);
}

}  // namespace railcast
