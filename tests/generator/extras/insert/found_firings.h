#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/io/write_file.h"
#include "generator/extras/insert/recorded_firings.h"
#include "railcast/lidar.h"
#include "tests/support/sensor_file.h"

namespace railcast {

/// The scan of scenarios/sensors/NAME.json, or of one of these, which have no file of their own:
/// "os1" has channels that look past each other from 16 mm beside the axis, "at128" sees 120 deg.
inline ScanSpec SensorOfTest(const std::string& name) {
  if (name != "os1" && name != "at128") return ReadSensor(name);
  const bool is_os1 = name == "os1";
  SpinningSpec sensor{.channels = {}, .cycle_us = 97.65, .columns = 1024};
  const std::array<double, 4> os1_deg = {4.2, 1.4, -1.4, -4.2};
  for (std::size_t i = 0; i < (is_os1 ? 64U : 128U); ++i) {
    const double elevation_deg =
        is_os1 ? 16.6 - 0.53 * static_cast<double>(i) : 12.9 - 0.2 * static_cast<double>(i);
    sensor.channels.push_back({elevation_deg, is_os1 ? os1_deg.at(i % 4) : 0.0, 0.0});
  }
  if (is_os1) {
    sensor.beam_origin_m = {0.0158, 0.0362};
  } else {
    sensor.cycle_us = 41.666;
    sensor.columns = 2400;
    sensor.azimuth_window_deg = {300.0, 60.0};
  }
  return {.rate_hz = 10.0, .pattern = sensor};
}

/// The points alone, or all slots: laser by laser, or firing by firing.
enum class CloudLayout : std::uint8_t { kPoints, kByLaser, kByFiring };

inline std::string LayoutName(CloudLayout layout) {
  switch (layout) {
    case CloudLayout::kPoints:
      return "Points";
    case CloudLayout::kByLaser:
      return "Organised";
    case CloudLayout::kByFiring:
      return "OrganisedByFiring";
  }
  return "";
}

/// How a cloud is written.
struct CloudStyle {
  CloudLayout layout = CloudLayout::kPoints;
  bool has_ring = true;
  bool has_time = true;
};

/// A firing and where it met something.
struct MadeFiring {
  std::array<float, 3> direction{};
  std::array<float, 3> point_m{};
  std::uint32_t time_ns{};
  std::uint16_t row{};
  std::uint32_t column{};
  bool has_point{};
};

/// The firings of a scan in a plain with two walls under the open sky. Every tenth return is lost.
inline std::vector<MadeFiring> FireInThePlain(const ScanPattern& pattern) {
  std::vector<MadeFiring> firings;
  for (std::uint32_t i = 0; i < pattern.num_firings(); ++i) {
    const std::array<float, 3> d = {pattern.direction_x[i], pattern.direction_y[i],
                                    pattern.direction_z[i]};
    std::array<float, 3> origin_m{};
    if (!pattern.origin_x_m.empty()) {
      origin_m = {pattern.origin_x_m[i], pattern.origin_y_m[i], pattern.origin_z_m[i]};
    }
    float range_m = std::numeric_limits<float>::infinity();
    if (d[2] < 0.0F) range_m = (-2.0F - origin_m[2]) / d[2];
    for (const auto& [axis, place_m] : {std::pair{1U, 9.0F}, std::pair{0U, -25.0F}}) {
      const float wall_m = (place_m - origin_m.at(axis)) / d.at(axis);
      if (wall_m > 0.0F && origin_m[2] + wall_m * d[2] < 2.0F) range_m = std::min(range_m, wall_m);
    }
    const auto words = RandomWords(7, RandomUse::kNoise, 0, i);
    MadeFiring firing{.direction = d,
                      .time_ns = pattern.time_ns[i],
                      .row = pattern.row[i],
                      .column = pattern.column[i],
                      .has_point = range_m < 90.0F && UnitFloat(words[0]) > 0.1F};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      firing.point_m.at(axis) = origin_m.at(axis) + range_m * d.at(axis);
    }
    firings.push_back(firing);
  }
  return firings;
}

/// Writes the firings that have a point as a PCD file of the kind that drivers and tools write.
inline void WriteCloudOf(const std::vector<MadeFiring>& firings,
                         const ScanPattern& pattern,
                         const CloudStyle& style,
                         const std::filesystem::path& file) {
  std::string bytes;
  const auto add = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const auto write = [&](const MadeFiring* firing) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    const bool has_point = firing != nullptr && firing->has_point;
    for (std::size_t axis = 0; axis < 3; ++axis) add(has_point ? firing->point_m.at(axis) : kNaN);
    if (style.has_ring) add(firing != nullptr ? firing->row : std::uint16_t{0});
    if (style.has_time) add(firing != nullptr ? 1e-9F * static_cast<float>(firing->time_ns) : 0.0F);
  };
  std::size_t num = 0;
  const bool is_by_firing = style.layout == CloudLayout::kByFiring;
  if (style.layout != CloudLayout::kPoints) {
    std::vector<const MadeFiring*> cells(std::size_t{pattern.rows} * pattern.columns);
    for (const MadeFiring& firing : firings) {
      const std::size_t cell = is_by_firing
                                   ? std::size_t{firing.column} * pattern.rows + firing.row
                                   : std::size_t{firing.row} * pattern.columns + firing.column;
      cells[cell] = &firing;
    }
    for (const MadeFiring* firing : cells) write(firing);
    num = cells.size();
  } else {
    for (const MadeFiring& firing : firings) {
      if (!firing.has_point) continue;
      write(&firing);
      ++num;
    }
  }
  const std::size_t width = style.layout == CloudLayout::kPoints ? num
                            : is_by_firing                       ? pattern.rows
                                                                 : pattern.columns;
  const std::size_t height = num / width;
  const std::string ring = style.has_ring ? " 1" : "";
  const std::string time = style.has_time ? " 1" : "";
  WriteFileWhole(file, std::string("VERSION 0.7\nFIELDS x y z") + (style.has_ring ? " ring" : "") +
                           (style.has_time ? " time" : "") + "\nSIZE 4 4 4" +
                           (style.has_ring ? " 2" : "") + (style.has_time ? " 4" : "") +
                           "\nTYPE F F F" + (style.has_ring ? " U" : "") +
                           (style.has_time ? " F" : "") + "\nCOUNT 1 1 1" + ring + time +
                           "\nWIDTH " + std::to_string(width) + "\nHEIGHT " +
                           std::to_string(height) + "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
                           std::to_string(num) + "\nDATA binary\n" + bytes);
}

/// How far the found firings lie from the true ones, in degrees.
struct AimErrors {
  std::vector<double> with_point_deg, without_point_deg;

  static double Share(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  }
  void Print(const std::string& what) const {
    const auto row = [](const std::vector<double>& values) {
      std::cout << values.size() << " " << Share(values, 0.5) << " " << Share(values, 0.999) << " "
                << Share(values, 1.0);
    };
    std::cout << "firings of " << what << ": with a return ";
    row(with_point_deg);
    std::cout << ", without ";
    row(without_point_deg);
    std::cout << " (number, median, 99.9 %, greatest error in deg)\n";
  }
};

/// Compares each true firing with the nearest found one of its row, or of the row beside it if both
/// have one elevation, as where a laser fires twice in a cycle.
inline AimErrors ErrorsOf(const std::vector<MadeFiring>& truth, const RecordedFirings& found) {
  const ScanPattern& pattern = found.pattern;
  struct Aim {
    double azimuth_rad{};
    std::uint32_t firing{};
  };
  std::vector<std::vector<Aim>> rows(pattern.rows);
  for (std::uint32_t i = 0; i < pattern.num_firings(); ++i) {
    rows[pattern.row[i]].push_back(
        {static_cast<double>(std::atan2(pattern.direction_y[i], pattern.direction_x[i])), i});
  }
  for (auto& row : rows) std::ranges::sort(row, {}, &Aim::azimuth_rad);
  AimErrors errors;
  for (const MadeFiring& firing : truth) {
    double least_rad = 10.0;
    const auto azimuth_rad =
        static_cast<double>(std::atan2(firing.direction[1], firing.direction[0]));
    for (const int beside : {-1, 0, 1}) {
      const int index = firing.row + beside;
      if (index < 0 || index >= static_cast<int>(rows.size())) continue;
      const auto& row = rows[static_cast<std::size_t>(index)];
      const auto after = std::ranges::lower_bound(row, azimuth_rad, {}, &Aim::azimuth_rad);
      const auto place = static_cast<std::size_t>(after - row.begin());
      for (const std::size_t near : {place + row.size() - 1, place}) {
        const std::uint32_t i = row.at(near % row.size()).firing;
        const Vector3 apart(static_cast<double>(firing.direction[0] - pattern.direction_x[i]),
                            static_cast<double>(firing.direction[1] - pattern.direction_y[i]),
                            static_cast<double>(firing.direction[2] - pattern.direction_z[i]));
        if (beside != 0 && std::abs(apart.z()) > 1e-3) continue;
        least_rad = std::min(least_rad, 2.0 * std::asin(std::min(1.0, apart.norm() / 2.0)));
      }
    }
    (firing.has_point ? errors.with_point_deg : errors.without_point_deg)
        .push_back(DegFromRad(least_rad));
  }
  return errors;
}

}  // namespace railcast
