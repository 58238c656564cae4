#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/io/endpoint.h"
#include "railcast/transform.h"

namespace railcast {

/// Constants of the railcast protocol, version 1. docs/stream.md describes it byte by byte.

inline constexpr std::uint16_t kStreamPort = 27400;
/// Fits into an Ethernet frame, so datagrams are not fragmented there.
inline constexpr std::size_t kMaxStreamDatagram = 1400;
inline constexpr std::size_t kMaxStreamFields = 64;

/// Storage type of a field. The codes are those of pcl::PCLPointField and ROS's PointField.
enum class StreamType : std::uint8_t { kU8 = 2, kU16 = 4, kU32 = 6, kF32 = 7 };

/// The code of a C++ type; defined for these four only.
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

/// Size in bytes; 0 if `type` is not a valid code.
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

/// One field of every point.
struct StreamField {
  std::string name;  ///< Name as in the frame's table (ForEachField() in railcast/frame.h).
  StreamType type{};
  std::uint16_t offset{};  ///< Byte offset within a point.
};

/// Axes of the points (OutputSpec::frame).
enum class StreamAxes : std::uint8_t { kSensor = 0, kVehicle = 1, kWorld = 2 };

/// Contents that all datagrams of a frame share.
struct StreamHeader {
  bool has_all_slots{};  ///< If false, only returned points are sent.
  StreamAxes axes{};     ///< Axes of x, y, z; for kWorld, OutputSpec::origin_m has been subtracted.
  bool is_left_handed{};   ///< y is negated.
  std::uint32_t run{};     ///< Changes when the sender restarts; frame numbers then start over.
  std::uint16_t sensor{};  ///< Number of the sensor on the vehicle.
  std::uint32_t frame{};
  std::int64_t stamp_ns{};      ///< Simulation time of firing 0.
  std::uint32_t duration_ns{};  ///< From the stamp to the last firing.
  std::uint32_t num_points{};   ///< Points in the frame, whether or not they arrived.
  std::uint32_t rows{};
  std::uint32_t columns{};
  std::uint16_t returns{};                                  ///< Slots per firing.
  std::uint16_t point_size{};                               ///< In bytes.
  Transform world_from_sensor = Transform::Identity();      ///< Pose at the stamp.
  Transform world_from_sensor_end = Transform::Identity();  ///< Pose at the last firing.
  std::vector<StreamField> fields;  ///< In the order in which they are stored in a point.

  /// The field of that name; null if it is not sent.
  [[nodiscard]] const StreamField* Find(std::string_view name) const;
};

/// The indices [first, first + count).
struct IndexRange {
  std::uint32_t first{};
  std::uint32_t count{};
  bool operator==(const IndexRange&) const = default;
};

/// The part of a frame that arrived, and a record of what did not.
struct ReceivedFrame {
  StreamHeader header;
  std::uint32_t num_packets{};  ///< Packets of the frame, whether or not they arrived.
  /// When the first and the last of its packets were taken from the socket, by this machine's time
  /// of day: ns since 1970-01-01 00:00:00 UTC.
  std::int64_t first_arrival_ns{};
  std::int64_t last_arrival_ns{};
  std::vector<char> points;  ///< Points that arrived: point_size bytes each, in firing order.
  std::vector<IndexRange> lost_packets;
  std::vector<IndexRange> lost_points;  ///< Ranges within the frame's header.num_points.

  [[nodiscard]] bool is_complete() const { return lost_packets.empty(); }
  /// Number of points that arrived.
  [[nodiscard]] std::size_t num_points() const { return points.size() / header.point_size; }
  [[nodiscard]] std::uint32_t num_lost_packets() const;

  /// Returns the value of a field of the `i`th point that arrived.
  /// @pre `field` is one of this frame's header, and `T` matches its type.
  template <typename T>
  [[nodiscard]] T At(const StreamField& field, std::size_t i) const {
    T value;
    std::memcpy(&value, &points[i * header.point_size + field.offset], sizeof value);
    return value;
  }
};

/// Reasons for rejecting a datagram.
enum class StreamFault : std::uint8_t {
  /// Shorter than a header, longer than 1400 bytes, or inconsistent with its own length field.
  kSize,
  kMagic,      ///< Not of this protocol.
  kVersion,    ///< Unknown version, or flags that version 1 does not define.
  kChecksum,   ///< Checksum mismatch: the datagram is damaged.
  kFields,     ///< Invalid field list: types, names or sizes.
  kCounts,     ///< Contradictory numbers of points and packets.
  kPose,       ///< Pose not finite, or not a rotation.
  kDisagrees,  ///< Contradicts the frame's first datagram.
};

inline constexpr std::array<std::string_view, 8> kStreamFaultNames = {
    "size", "magic", "version", "checksum", "fields", "counts", "pose", "disagrees"};

/// Statistics of a receiver. Packets are datagrams of the protocol.
struct StreamCounts {
  std::uint64_t complete_frames{};
  std::uint64_t incomplete_frames{};  ///< Delivered with some packets lost.
  std::uint64_t missing_frames{};     ///< Never seen, although later and earlier frames were.
  /// Valid packets, including the duplicate, late and reordered ones below.
  std::uint64_t received_packets{};
  std::uint64_t duplicate_packets{};
  /// Packets of frames that had already been delivered without them.
  std::uint64_t late_packets{};
  /// Packets that were overtaken by others sent later, but arrived in time.
  std::uint64_t reordered_packets{};
  /// Packets missing from incomplete frames; those of missing frames are unknown.
  std::uint64_t lost_packets{};
  /// Valid packets of another run or sensor, or of a frame long past.
  std::uint64_t stray_packets{};
  std::uint64_t other_sender_packets{};  ///< Packets of senders other than the one being followed.
  std::uint64_t restarts{};              ///< Number of times that frame numbers started over.
  std::array<std::uint64_t, kStreamFaultNames.size()> refused{};  ///< By StreamFault.
  /// The sensor, other than the one being received, that was heard last.
  std::optional<std::uint16_t> other_sensor{};
  std::optional<Endpoint> other_sender{};  ///< Sender of the last of `other_sender_packets`.

  [[nodiscard]] std::uint64_t num_refused() const;
};

/// Selects one stream among all that arrive at a port.
struct WantedStream {
  /// Number of the sensor on the vehicle; absent: the first one heard.
  std::optional<std::uint16_t> sensor{};
  /// Senders that this endpoint covers; absent: the first one heard.
  std::optional<Endpoint> from{};
};

/// Receives a stream in the railcast protocol on a thread of its own.
///
/// If the consumer is too slow, the oldest frames are dropped; memory stays bounded. After one
/// second without a datagram, frames that are still incomplete are delivered as they are.
///
///     StreamReceiver receiver(ParseEndpoint("0.0.0.0", kStreamPort));
///     while (const auto frame = receiver.Next(/*timeout_ms=*/5000)) {
///       // Use frame->header, frame->points ...
///     }
class StreamReceiver {
 public:
  static constexpr std::size_t kMaxWaitingFrames = 4;

  /// @throws InputError if the port cannot be opened.
  explicit StreamReceiver(const Endpoint& at, const WantedStream& wanted = {});
  ~StreamReceiver();
  StreamReceiver(const StreamReceiver&) = delete;
  StreamReceiver& operator=(const StreamReceiver&) = delete;

  [[nodiscard]] const Endpoint& at() const;

  /// Waits for the next frame. Returns nothing if none arrives within `timeout_ms`, or once the
  /// receiver is stopped and all waiting frames have been taken.
  [[nodiscard]] std::optional<ReceivedFrame> Next(int timeout_ms);
  /// Stops receiving and frees the port. Frames that are still incomplete can be taken as they are.
  /// Thread-safe.
  void Stop();

  struct Counts {
    StreamCounts stream;
    std::uint64_t dropped_frames{};  ///< Frames dropped because the consumer was too slow.
  };
  /// Thread-safe.
  [[nodiscard]] Counts counts() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace railcast
