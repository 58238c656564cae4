#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/transform.h"

namespace railcast {

/// The railcast protocol, version 1: docs/stream.md describes it byte by byte.

inline constexpr std::uint16_t kStreamPort = 27400;
/// Fits into an Ethernet frame: no datagram is fragmented there.
inline constexpr std::size_t kMaxStreamDatagram = 1400;
inline constexpr std::size_t kMaxStreamFields = 64;

/// How a field's value is stored. The codes are those of pcl::PCLPointField and ROS's PointField.
enum class StreamType : std::uint8_t { kU8 = 2, kU16 = 4, kU32 = 6, kF32 = 7 };

/// The code of a C++ type; only these four have one.
template <typename T>
inline constexpr StreamType kStreamTypeOf = T::has_no_code;
template <>
inline constexpr StreamType kStreamTypeOf<std::uint8_t> = StreamType::kU8;
template <>
inline constexpr StreamType kStreamTypeOf<std::uint16_t> = StreamType::kU16;
template <>
inline constexpr StreamType kStreamTypeOf<std::uint32_t> = StreamType::kU32;
template <>
inline constexpr StreamType kStreamTypeOf<float> = StreamType::kF32;

/// In bytes; 0 if `type` is none of the codes.
[[nodiscard]] constexpr std::uint16_t SizeOf(StreamType type) {
  switch (type) {
    case StreamType::kU8:
      return 1;
    case StreamType::kU16:
      return 2;
    case StreamType::kU32:
    case StreamType::kF32:
      return 4;
  }
  return 0;
}

/// One value of every point.
struct StreamField {
  std::string name;  ///< Of the frame's table (core/frame/frame.h).
  StreamType type{};
  std::uint16_t offset{};  ///< In a point's bytes.
};

/// In whose axes points are (OutputSpec::frame).
enum class StreamAxes : std::uint8_t { kSensor = 0, kVehicle = 1, kWorld = 2 };

/// What all datagrams of a frame say alike.
struct StreamHeader {
  bool has_all_slots{};    ///< Else only the returned points are sent.
  StreamAxes axes{};       ///< Of x, y, z; the world's less OutputSpec::origin_m.
  bool is_left_handed{};   ///< y is negated.
  std::uint32_t run{};     ///< Another one: the sender began anew, and so do frame numbers.
  std::uint16_t sensor{};  ///< Of the vehicle.
  std::uint32_t frame{};
  std::int64_t stamp_ns{};      ///< Simulation time of firing 0.
  std::uint32_t duration_ns{};  ///< From the stamp to the last firing.
  std::uint32_t num_points{};   ///< Of the frame, whether or not they arrived.
  std::uint32_t rows{};
  std::uint32_t columns{};
  std::uint16_t returns{};                                  ///< Slots per firing.
  std::uint16_t point_size{};                               ///< In bytes.
  Transform world_from_sensor = Transform::Identity();      ///< At the stamp.
  Transform world_from_sensor_end = Transform::Identity();  ///< At the last firing.
  std::vector<StreamField> fields;  ///< In the order in which a point's bytes hold them.

  /// The field of that name; null if it is not sent.
  [[nodiscard]] const StreamField* Find(std::string_view name) const;
};

}  // namespace railcast
