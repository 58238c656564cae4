#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace railcast {

inline constexpr std::array<std::size_t, 11> kLasPointBytes = {20, 28, 26, 34, 57, 63,
                                                               30, 36, 38, 59, 67};

template <typename Number>
void PutNumber(std::string& bytes, std::size_t place, Number number) {
  std::memcpy(&bytes.at(place), &number, sizeof number);
}

/// A record behind the header.
inline std::string LasRecord(int id, const std::string& content) {
  std::string record(54, '\0');
  std::memcpy(&record[2], "LASF_Projection", 15);
  PutNumber(record, 18, static_cast<std::uint16_t>(id));
  PutNumber(record, 20, static_cast<std::uint16_t>(content.size()));
  return record + content;
}

/// A GeoTIFF directory of one key.
inline std::string GeoKey(std::uint16_t key, std::uint16_t value) {
  const std::array<std::uint16_t, 8> words = {1, 1, 0, 1, key, 0, 1, value};
  return {reinterpret_cast<const char*>(words.data()), sizeof words};
}

/// A file that is written as LAS says, field by field, in metres.
struct MadeLas {
  int minor_version = 2;
  int format = 0;
  std::size_t extra_bytes = 0;
  std::string records = LasRecord(34735, GeoKey(3076, 9001));  ///< Behind the header.
  std::uint32_t num_records = 1;

  [[nodiscard]] std::size_t point_bytes() const {
    return kLasPointBytes.at(static_cast<std::size_t>(format)) + extra_bytes;
  }
  [[nodiscard]] std::size_t header_bytes() const {
    return minor_version == 4 ? 375 : minor_version == 3 ? 235 : 227;
  }
  [[nodiscard]] std::size_t points_begin() const { return header_bytes() + records.size(); }

  /// Points 5 km east and 300 km north, 1 m apart: the number-th has class number, intensity
  /// 100 x number, is return number of 3, and was measured at 7 s + number x 0.05 s at -12 degrees.
  /// Each is a key point, seen while the mirror went forward.
  [[nodiscard]] std::string Bytes(std::size_t num_points, std::size_t num_stated) const {
    std::string bytes(header_bytes(), '\0');
    std::memcpy(bytes.data(), "LASF", 4);
    bytes[24] = 1;
    bytes[25] = static_cast<char>(minor_version);
    PutNumber(bytes, 94, static_cast<std::uint16_t>(header_bytes()));
    PutNumber(bytes, 96, static_cast<std::uint32_t>(points_begin()));
    PutNumber(bytes, 100, num_records);
    bytes[104] = static_cast<char>(format);
    PutNumber(bytes, 105, static_cast<std::uint16_t>(point_bytes()));
    if (minor_version == 4) {
      PutNumber(bytes, 247, std::uint64_t{num_stated});
    } else {
      PutNumber(bytes, 107, static_cast<std::uint32_t>(num_stated));
    }
    for (std::size_t axis = 0; axis < 3; ++axis) PutNumber(bytes, 131 + 8 * axis, 0.001);
    PutNumber(bytes, 155, 5000.0);
    PutNumber(bytes, 163, 300'000.0);
    bytes += records;
    for (std::size_t i = 1; i <= num_points; ++i) bytes += Point(i);
    return bytes;
  }
  [[nodiscard]] std::string Bytes(std::size_t num_points) const {
    return Bytes(num_points, num_points);
  }

 private:
  [[nodiscard]] std::string Point(std::size_t i) const {
    std::string point(point_bytes(), '\0');
    const bool is_newer = format >= 6;
    PutNumber(point, 0, static_cast<std::int32_t>(1000 * i));
    PutNumber(point, 4, static_cast<std::int32_t>(-2000 * static_cast<int>(i)));
    PutNumber(point, 8, std::int32_t{345});
    PutNumber(point, 12, static_cast<std::uint16_t>(100 * i));
    const auto number = static_cast<std::uint8_t>(i);
    if (is_newer) {
      point[14] = static_cast<char>(3U << 4U | number);
      point[15] = 0x42;
      point[16] = static_cast<char>(number);
      PutNumber(point, 18, std::int16_t{-2000});
    } else {
      point[14] = static_cast<char>(0x40U | 3U << 3U | number);
      point[15] = static_cast<char>(0x40U | number);
      point[16] = -12;
    }
    point[17] = static_cast<char>(40 + i);
    PutNumber(point, is_newer ? 20 : 18, static_cast<std::uint16_t>(7));
    const double time_s = 7.0 + 0.05 * static_cast<double>(i);
    if (is_newer) PutNumber(point, 22, time_s);
    if (format == 1 || (format >= 3 && format <= 5)) PutNumber(point, 20, time_s);
    return point;
  }
};

}  // namespace railcast
