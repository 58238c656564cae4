#include "core/scan/at128.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/scan/firing.h"
#include "core/scan/spinning_pattern.h"

namespace railcast {
namespace {

// The file: EE FF, version 1.5, u8 each the numbers of lasers, mirrors and fields, 8 bytes, u8 the
// resolution; then, in steps of the resolution / 25600 deg, u32 the start and u32 the end of each
// field, i32 the azimuth and i32 the elevation of each laser; then, in steps of the resolution /
// 100 deg, 180 x i8 the shifts of each laser's azimuth and 180 x i8 of its elevation; SHA-256
// (HesaiLidar_SDK_2.0, udp4_3_parser.cc; a cloud of tier4/nebula agrees).
constexpr std::uint16_t kFileFlag = 0xFFEE;
constexpr std::size_t kCorrectionHead = 16;
constexpr std::size_t kFileSize = 47'176;
constexpr double kShiftsPerDeg = 100.0;
constexpr double kShiftStep_deg = 2.0;

void CheckFile(std::span<const char> bytes) {
  if (bytes.size() != kFileSize) {
    throw InputError("must be 47176 bytes" + Got(bytes.size()));
  }
  if (LoadAt<std::uint16_t>(bytes.data()) != kFileFlag) {
    throw InputError("must begin with EE FF" + Got(LoadAt<std::uint16_t>(bytes.data())));
  }
  const auto check = [&](std::size_t place, std::uint8_t expected, const std::string& what) {
    const auto got = LoadAt<std::uint8_t>(bytes.data() + place);
    if (got != expected) throw InputError(what + " must be " + NumberText(expected) + Got(got));
  };
  check(3, 5, "minor version");
  check(4, kAt128Lasers, "number of lasers");
  check(6, 3, "number of fields");
  if (LoadAt<std::uint8_t>(bytes.data() + 15) == 0) {
    throw InputError("resolution must be > 0 (got 0)");
  }
}

double InTurn(double angle_deg) {
  return angle_deg - 360.0 * std::floor(angle_deg / 360.0);
}

constexpr double kSweepTurn_deg = 60.0;

double StepOfBlocks_deg(double rate_hz) {
  return At128Correction::kFieldTurn_deg * rate_hz * kAt128Block_us * 1e-6;
}

FiringGrid SweepOf(const At128Correction& correction, double rate_hz, std::uint32_t frame) {
  const std::vector<ChannelSpec> channels = At128Channels(correction);
  const std::vector<std::uint16_t> rows = RowsByElevation(channels);
  FiringGrid grid{.rows = kAt128Lasers, .columns = At128Columns(rate_hz), .firings = {}};
  grid.firings.reserve(std::size_t{grid.rows} * grid.columns);
  for (std::uint32_t column = 0; column < grid.columns; ++column) {
    const double block_deg =
        At128Azimuth(correction, rate_hz, frame, column) / At128Correction::kStepsPerDeg;
    const std::size_t field = correction.FieldAt(block_deg);
    const double block_us = column * kAt128Block_us;
    for (std::size_t laser = 0; laser < kAt128Lasers; ++laser) {
      const auto [azimuth_deg, elevation_deg] = correction.At(block_deg, field, laser);
      grid.firings.push_back({.azimuth_rad = -RadFromDeg(std::remainder(azimuth_deg, 360.0)),
                              .elevation_rad = RadFromDeg(elevation_deg),
                              .time_ns = std::llround(1e3 * (block_us + channels[laser].time_us)),
                              .row = rows[laser],
                              .column = column});
    }
  }
  return grid;
}

}  // namespace

At128Correction::At128Correction(std::span<const char> bytes) {
  CheckFile(bytes);
  const auto resolution = LoadAt<std::uint8_t>(bytes.data() + 15);
  const double step_deg = resolution / At128Correction::kStepsPerDeg;
  resolution_ = resolution;
  const char* place = bytes.data() + kCorrectionHead;
  for (double& start_deg : start_deg_) {
    start_deg = LoadAt<std::uint32_t>(place) * step_deg;
    if (start_deg >= 360.0) throw InputError("a field must start before 360 deg" + Got(start_deg));
    place += sizeof(std::uint32_t);
  }
  CheckStarts();
  place += kFields * sizeof(std::uint32_t);
  for (auto* angles : {&azimuth_deg_, &elevation_deg_}) {
    for (double& angle_deg : *angles) {
      angle_deg = LoadAt<std::int32_t>(place) * step_deg;
      if (!(std::abs(angle_deg) <= 90.0)) {
        throw InputError("angles of lasers must be within 90 deg" + Got(angle_deg));
      }
      place += sizeof(std::int32_t);
    }
  }
  for (Shifts* shifts : {&azimuth_shifts_, &elevation_shifts_}) {
    shifts->resize(kAt128Lasers * kShifts);
    std::copy_n(place, shifts->size(), shifts->begin());
    // Those of real units are below 1 deg.
    constexpr int kMost_deg = 5;
    for (const auto shift : *shifts) {
      const int size = std::abs(static_cast<int>(shift));
      if (resolution * size <= kMost_deg * static_cast<int>(kShiftsPerDeg)) continue;
      throw InputError("shifts of lasers must be within 5 deg" +
                       Got(resolution * shift / kShiftsPerDeg));
    }
    place += shifts->size();
  }
}

void At128Correction::CheckStarts() {
  constexpr double kMost_deg = 5.0;
  std::array<double, kFields> beyond_deg{};
  for (std::uint32_t i = 0; i < kFields; ++i) beyond_deg[i] = start_deg_[i] - kFieldTurn_deg * i;
  mean_start_deg_ = std::reduce(beyond_deg.begin(), beyond_deg.end()) / kFields;
  for (std::size_t i = 0; i < kFields; ++i) {
    if (std::abs(beyond_deg[i] - mean_start_deg_) <= kMost_deg) continue;
    throw InputError("fields must start 120 deg apart, to 5 deg" + Got(start_deg_[i]));
  }
}

std::size_t At128Correction::FieldAt(double block_deg) const {
  const auto next = std::ranges::upper_bound(start_deg_, block_deg);
  // What lies before the first start belongs to the last field.
  return next == start_deg_.begin() ? kFields - 1
                                    : static_cast<std::size_t>(next - start_deg_.begin()) - 1;
}

double At128Correction::Shift_deg(const Shifts& shifts, double block_deg, std::size_t laser) const {
  const double place = block_deg / kShiftStep_deg;
  const auto index = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(index);
  const std::int8_t* const own = shifts.data() + laser * kShifts;
  const double between = (1.0 - share) * own[index % kShifts] + share * own[(index + 1) % kShifts];
  return std::round(resolution_ * between) / kShiftsPerDeg;
}

At128Correction::Direction At128Correction::At(double block_deg,
                                               std::size_t field,
                                               std::size_t laser) const {
  // A mirror turns a beam by twice its own turn. The maker counts azimuths from 90 deg to the left.
  const double swept_deg = 2.0 * InTurn(block_deg - start_deg_[field]);
  return {.azimuth_deg = InTurn(swept_deg - azimuth_deg_[laser] +
                                Shift_deg(azimuth_shifts_, block_deg, laser) - 90.0),
          .elevation_deg = elevation_deg_[laser] + Shift_deg(elevation_shifts_, block_deg, laser)};
}

bool IsAt128File(const std::filesystem::path& file) {
  std::array<char, sizeof kFileFlag> flag{};
  OpenInput(file).read(flag.data(), flag.size());
  return LoadAt<std::uint16_t>(flag.data()) == kFileFlag;
}

At128Correction ReadAt128Correction(const std::filesystem::path& file) {
  const std::string bytes = ReadFileWhole(file);
  return AtPlace(ShownPath(file) + ": ", [&] { return At128Correction(bytes); });
}

std::vector<ChannelSpec> At128Channels(const At128Correction& correction) {
  std::vector<ChannelSpec> channels;
  for (std::size_t laser = 0; laser < kAt128Lasers; ++laser) {
    channels.push_back({.elevation_deg = correction.elevation_deg(laser),
                        .time_us = 1e-3 * kAt128Firing_ns[laser]});
  }
  return channels;
}

std::uint32_t At128Columns(double rate_hz) {
  return 2 * static_cast<std::uint32_t>(kSweepTurn_deg / 2.0 / StepOfBlocks_deg(rate_hz));
}

std::uint32_t At128Azimuth(const At128Correction& correction,
                           double rate_hz,
                           std::uint32_t frame,
                           std::uint32_t column) {
  // A mirror looks forward 45 deg of the rotor behind the start of its field.
  constexpr double kForward_deg = 45.0;
  const double from_middle = column - (At128Columns(rate_hz) - 1) / 2.0;
  const double azimuth_deg = correction.mean_start_deg() + kForward_deg +
                             At128Correction::kFieldTurn_deg * (frame % At128Correction::kFields) +
                             StepOfBlocks_deg(rate_hz) * from_middle;
  return static_cast<std::uint32_t>(std::lround(azimuth_deg * At128Correction::kStepsPerDeg) %
                                    std::lround(360.0 * At128Correction::kStepsPerDeg));
}

FramesOfFirings At128Firings(const FiringTableSpec& spec, double rate_hz, ErrorList& errors) {
  if (spec.frames != At128Correction::kFields) {
    errors.Add(FaultOf("/pattern/frames", "must be 3, the mirrors of an AT128", spec.frames));
  }
  const bool is_rate = rate_hz >= 0.01 && rate_hz <= 1e6;  // Others are told for all patterns.
  if (is_rate && !(rate_hz >= 1.0 && rate_hz <= 100.0)) {
    errors.Add(FaultOf("/rate_hz", "must be >= 1 and <= 100 with an AT128's file", rate_hz));
  }
  const auto correction = Attempt("/pattern/file: ", errors, [&] {
    return std::make_shared<const At128Correction>(ReadAt128Correction(spec.file));
  });
  if (!errors.empty()) return {};
  const auto of_frame = [rate_hz, file = *correction](std::uint32_t frame_index, std::int64_t) {
    return SweepOf(*file, rate_hz, frame_index);
  };
  return {of_frame(0, 0), std::make_shared<const MovingFigure>(MovingFigure{of_frame})};
}

}  // namespace railcast
