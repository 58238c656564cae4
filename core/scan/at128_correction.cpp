#include "core/scan/at128_correction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"

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
    for (const int shift : *shifts) {
      if (resolution * std::abs(shift) <= kMost_deg * static_cast<int>(kShiftsPerDeg)) continue;
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

}  // namespace railcast
