#include "core/scan/at128.h"

#include <endian.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <numeric>
#include <string>
#include <utility>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/inputs.h"
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

constexpr std::size_t kHashSize = 32;
using Hash = std::array<char, kHashSize>;

/// SHA-256 (FIPS 180-4, 6.2).
Hash Sha256(std::span<const char> bytes) {
  constexpr std::array<std::uint32_t, 64> kRounds = {
      0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4,
      0xab1c5ed5, 0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe,
      0x9bdc06a7, 0xc19bf174, 0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f,
      0x4a7484aa, 0x5cb0a9dc, 0x76f988da, 0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7,
      0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967, 0x27b70a85, 0x2e1b2138, 0x4d2c6dfc,
      0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85, 0xa2bfe8a1, 0xa81a664b,
      0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070, 0x19a4c116,
      0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
      0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7,
      0xc67178f2};
  std::array<std::uint32_t, 8> state = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                        0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  constexpr std::size_t kBlock = 64;
  std::vector<char> padded(bytes.begin(), bytes.end());
  padded.push_back('\x80');
  while (padded.size() % kBlock != kBlock - sizeof(std::uint64_t)) padded.push_back('\0');
  const std::uint64_t num_bits = htobe64(8 * bytes.size());
  padded.resize(padded.size() + sizeof num_bits);
  std::memcpy(padded.data() + padded.size() - sizeof num_bits, &num_bits, sizeof num_bits);
  for (std::size_t block = 0; block < padded.size(); block += kBlock) {
    std::array<std::uint32_t, 64> words{};
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (i < 16) {
        words[i] = be32toh(LoadAt<std::uint32_t>(padded.data() + block + 4 * i));
        continue;
      }
      const std::uint32_t a = words[i - 15];
      const std::uint32_t b = words[i - 2];
      words[i] = words[i - 16] + (std::rotr(a, 7) ^ std::rotr(a, 18) ^ (a >> 3U)) + words[i - 7] +
                 (std::rotr(b, 17) ^ std::rotr(b, 19) ^ (b >> 10U));
    }
    auto [a, b, c, d, e, f, g, h] = state;
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::uint32_t first = h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) +
                                  ((e & f) ^ (~e & g)) + kRounds[i] + words[i];
      const std::uint32_t second =
          (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
      h = std::exchange(g, std::exchange(f, std::exchange(e, d + first)));
      d = std::exchange(c, std::exchange(b, std::exchange(a, first + second)));
    }
    const std::array<std::uint32_t, 8> added = {a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < state.size(); ++i) state[i] += added[i];
  }
  Hash hash{};
  for (std::size_t i = 0; i < state.size(); ++i) {
    const std::uint32_t word = htobe32(state[i]);
    std::memcpy(hash.data() + 4 * i, &word, sizeof word);
  }
  return hash;
}

void CheckHash(std::span<const char> bytes) {
  const auto hash = bytes.last(kHashSize);
  if (std::ranges::equal(Sha256(bytes.first(bytes.size() - kHashSize)), hash)) return;
  throw InputError("is damaged: its last 32 bytes must be the SHA-256 of those before");
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
    // The shifts of real units are below 1 deg.
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
  const InputBytes bytes = ReadInput(file);
  return bytes->size() >= sizeof kFileFlag && LoadAt<std::uint16_t>(bytes->data()) == kFileFlag;
}

At128Correction ReadAt128Correction(const std::filesystem::path& file) {
  const InputBytes bytes = ReadInput(file);
  return AtPlace(ShownPath(file) + ": ", [&] {
    CheckFile(*bytes);
    CheckHash(*bytes);
    return At128Correction(*bytes);
  });
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
