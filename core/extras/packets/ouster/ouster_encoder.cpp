#include "core/extras/packets/ouster/ouster_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/inputs.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/scan/spinning_pattern.h"

namespace railcast {
namespace {

constexpr double kGravity_mps2 = 9.80665;

constexpr std::int64_t kImuPeriod_ns = 10'000'000;

class OusterEncoder final : public FrameEncoder {
 public:
  OusterEncoder(const OusterMetadata& metadata, const SpinningSpec& pattern)
      : metadata_(metadata),
        layout_(metadata),
        rows_(RowsByElevation(pattern.channels)),
        column_ns_(1e9 / (metadata.rate_hz * metadata.columns_per_frame)),
        packet_(layout_.packet_size()) {}

  void Encode(const Frame& frame, Datagrams& datagrams) override {
    Check(frame.rows == rows_.size() && frame.columns == metadata_.num_window_columns(),
          "the frame is the scan's");
    Check(frame.returns == 1 || (layout_.is_dual() && frame.returns == 2),
          "frames have the profile's returns");
    const bool is_next = !next_frame_ || frame.index == *next_frame_;
    const bool lacks_begin = !is_next && SharesPacket();
    if (!is_next) packet_turn_.reset();
    next_frame_ = frame.index + 1;
    const PoseMotion motion(frame, metadata_.sensor_from_imu);
    next_imu_ns_ = (frame.stamp_ns + kImuPeriod_ns - 1) / kImuPeriod_ns * kImuPeriod_ns;
    for (std::uint32_t column = 0; column < frame.columns; ++column) {
      EncodeColumn(frame, column);
      const bool ends_packet =
          column + 1 == frame.columns ? !SharesPacket() : PlaceOf(column + 1) != PlaceOf(column);
      if (!ends_packet) continue;
      // The first packet may contain the end of a frame that was left out.
      const bool is_whole = !lacks_begin || PlaceOf(column) != PlaceOf(0);
      if (is_whole) AppendPacket(motion, datagrams);
      packet_turn_.reset();
    }
    const auto period_ns = static_cast<std::int64_t>(std::llround(kNsPerS / metadata_.rate_hz));
    AppendImu(motion, frame.stamp_ns + period_ns - 1, datagrams);
  }

 private:
  /// The sensor's clock at a simulation time.
  [[nodiscard]] std::uint64_t ClockAt(std::int64_t time_ns) const {
    return static_cast<std::uint64_t>(kSimulationEpoch_s * kNsPerS + clock_ahead_ns() + time_ns);
  }

  /// The turn, counted from that in which a frame begins, and the packet in it.
  using PacketPlace = std::pair<std::uint32_t, std::uint32_t>;

  [[nodiscard]] std::uint32_t first_column() const { return metadata_.column_window[0]; }
  [[nodiscard]] PacketPlace PlaceOf(std::uint32_t column) const {
    const std::uint32_t behind = first_column() + column;
    return {behind / metadata_.columns_per_frame,
            behind % metadata_.columns_per_frame / metadata_.columns_per_packet};
  }
  /// Whether the packet with a frame's last columns also has the next frame's first.
  [[nodiscard]] bool SharesPacket() const {
    const PacketPlace last = PlaceOf(metadata_.num_window_columns() - 1);
    return last == PacketPlace{1, PlaceOf(0).second};
  }

  void BeginPacket(const Frame& frame, const PacketPlace& place) {
    std::ranges::fill(packet_, '\0');
    packet_turn_ = frame.index + place.first;
    layout_.Store({.frame_id = *packet_turn_ & layout_.last_frame_id(),
                   .initialization_id = metadata_.initialization_id.value_or(0),
                   .serial_number = metadata_.serial_number.value_or(0)},
                  packet_);
    const std::uint32_t begin = place.second * metadata_.columns_per_packet;
    const std::int64_t since_first = std::int64_t{place.first} * metadata_.columns_per_frame +
                                     begin - std::int64_t{first_column()};
    for (std::uint32_t i = 0; i < metadata_.columns_per_packet; ++i) {
      const double since_stamp_ns = static_cast<double>(since_first + i) * column_ns_;
      StoreColumn(begin + i, frame.stamp_ns + std::llround(since_stamp_ns), false);
    }
  }

  void StoreColumn(std::uint32_t number, std::int64_t time_ns, bool is_valid) {
    layout_.Store({.time_ns = ClockAt(time_ns),
                   .measurement_id = static_cast<std::uint16_t>(number),
                   .is_valid = is_valid},
                  number % metadata_.columns_per_packet, *packet_turn_,
                  number * (kOusterTicks / metadata_.columns_per_frame), packet_);
  }

  void EncodeColumn(const Frame& frame, std::uint32_t column) {
    if (!packet_turn_) BeginPacket(frame, PlaceOf(column));
    const std::size_t slot = std::size_t{column} * frame.returns;
    last_ns_ = frame.stamp_ns + frame.time_ns[slot];
    const std::uint32_t number = (first_column() + column) % metadata_.columns_per_frame;
    StoreColumn(number, last_ns_, true);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      OusterPixel pixel;
      for (std::size_t r = 0; r < frame.returns; ++r) {
        pixel.returns[r] = CodeReturn(frame, rows_[i] * std::size_t{frame.width()} + slot + r);
      }
      layout_.Store(pixel, number % metadata_.columns_per_packet, metadata_.beams[i].pixel,
                    packet_);
    }
  }

  [[nodiscard]] OusterReturn CodeReturn(const Frame& frame, std::size_t slot) const {
    const double unit_mm = layout_.range_unit_mm();
    const double range_mm =
        1e3 * (static_cast<double>(frame.range_m[slot]) + metadata_.range_offset_m());
    const double units = std::round(range_mm / unit_mm);
    // Written so that NaN, which means no return, is left out, too.
    if (!(units >= 1.0 && units * unit_mm <= layout_.most_range_mm())) return {};
    constexpr float kMostSignal = 65'535.0F;
    const float power_ratio = frame.power_ratio[slot];
    return {.range_mm = static_cast<std::uint32_t>(units * unit_mm),
            .reflectivity = ReflectivityByte(frame.intensity[slot]),
            .signal = static_cast<std::uint16_t>(
                power_ratio > 0.0F ? std::round(std::min(power_ratio, kMostSignal)) : 0.0F)};
  }

  void AppendPacket(const PoseMotion& motion, Datagrams& datagrams) {
    AppendImu(motion, last_ns_, datagrams);
    if (layout_.may_have_checksum()) StoreChecksum(packet_);
    datagrams.Append(packet_, {.port = DatagramPort::kData, .due_ns = last_ns_});
  }

  /// Appends the packets of motion up to a time.
  void AppendImu(const PoseMotion& motion, std::int64_t last_ns, Datagrams& datagrams) {
    for (; next_imu_ns_ <= last_ns; next_imu_ns_ += kImuPeriod_ns) {
      OusterImu imu = motion.At(next_imu_ns_);
      imu.system_time_ns = imu.acceleration_time_ns = imu.rotation_time_ns = ClockAt(next_imu_ns_);
      std::array<char, kOusterImuPacketSize> packet{};
      StoreImu(imu, packet);
      datagrams.Append(packet, {.port = DatagramPort::kPosition, .due_ns = next_imu_ns_});
    }
  }

  OusterMetadata metadata_;
  OusterLayout layout_;
  std::vector<std::uint16_t> rows_;  // Row of each beam.
  double column_ns_;                 // From one column to the next.

  // The packet under construction.
  std::vector<char> packet_;
  std::optional<std::uint32_t> packet_turn_;  // Its turn; absent between packets.
  std::int64_t last_ns_{};
  std::int64_t next_imu_ns_{};
  std::optional<std::uint32_t> next_frame_;
};

void CheckReturns(const OusterMetadata& metadata, ReturnMode mode) {
  const bool has_two = IsDualProfile(metadata.profile);
  const bool is_single =
      mode == ReturnMode::kStrongest || mode == ReturnMode::kFirst || mode == ReturnMode::kLast;
  if (has_two ? mode == ReturnMode::kDual : is_single) return;
  throw InputError("--protocol ouster: /lidar/receiver/return_mode: must be " +
                   std::string(has_two ? "\"dual\"" : "\"strongest\", \"first\" or \"last\"") +
                   " with profile " + std::string(NameOf(metadata.profile)) + " (got " +
                   Quoted(NameOf(mode)) + ")");
}

}  // namespace

PoseMotion::PoseMotion(const Frame& frame, const Transform& sensor_from_imu) {
  knots_.push_back({frame.stamp_ns, frame.world_from_sensor * sensor_from_imu});
  for (const ScanPose& pose : frame.poses_between) {
    knots_.push_back({frame.stamp_ns + pose.time_ns, pose.world_from_sensor * sensor_from_imu});
  }
  if (frame.duration_ns == 0) return;
  knots_.push_back(
      {frame.stamp_ns + frame.duration_ns, frame.world_from_sensor_end * sensor_from_imu});
}

OusterImu PoseMotion::At(std::int64_t time_ns) const {
  const auto later = std::ranges::upper_bound(knots_, time_ns, {}, &Knot::time_ns);
  const auto place = static_cast<std::size_t>(later - knots_.begin());
  const std::size_t num_knots = knots_.size();
  // The interval in which the time lies, or the nearest one.
  const std::size_t end =
      std::clamp<std::size_t>(place, 1, std::max<std::size_t>(num_knots, 2) - 1);
  Eigen::Matrix3d world_from_imu = knots_.front().world_from_imu.linear();
  Vector3 rotation_radps = Vector3::Zero();
  Vector3 acceleration_mps2 = Vector3::Zero();
  if (num_knots >= 2) {
    const Knot& from = knots_[end - 1];
    const Knot& to = knots_[end];
    const double length_s = SecondsFromNs(to.time_ns - from.time_ns);
    const Eigen::AngleAxisd turn(from.world_from_imu.linear().transpose() *
                                 to.world_from_imu.linear());
    rotation_radps = turn.angle() / length_s * turn.axis();
    const double share = SecondsFromNs(time_ns - from.time_ns) / length_s;
    world_from_imu = from.world_from_imu.linear() *
                     Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix();
  }
  if (num_knots >= 3) {
    const std::size_t middle = std::min(end, num_knots - 2);
    const auto velocity = [&](std::size_t i) -> Vector3 {
      return (knots_[i].world_from_imu.translation() - knots_[i - 1].world_from_imu.translation()) /
             SecondsFromNs(knots_[i].time_ns - knots_[i - 1].time_ns);
    };
    const double length_s = SecondsFromNs(knots_[middle + 1].time_ns - knots_[middle - 1].time_ns);
    acceleration_mps2 = (velocity(middle + 1) - velocity(middle)) * (2.0 / length_s);
  }
  const Vector3 felt_g =
      world_from_imu.transpose() * (acceleration_mps2 / kGravity_mps2 + Vector3::UnitZ());
  OusterImu imu;
  for (int i = 0; i < 3; ++i) {
    imu.acceleration_g[static_cast<std::size_t>(i)] = static_cast<float>(felt_g[i]);
    imu.rotation_degps[static_cast<std::size_t>(i)] =
        static_cast<float>(DegFromRad(rotation_radps[i]));
  }
  return imu;
}

std::unique_ptr<FrameEncoder> MakeOusterEncoder(const LidarSpec& lidar) {
  if (!lidar.ouster_metadata) {
    throw InputError(
        "--protocol ouster: /lidar/ouster_metadata: must name the metadata of the sensor, which "
        "its "
        "packets follow (got none)");
  }
  const InputBytes text = ReadInput(*lidar.ouster_metadata);
  const OusterMetadata metadata = AtPlace(ShownPath(*lidar.ouster_metadata) + ": ",
                                          [&] { return ParseOusterOfPackets(*text); });
  CheckReturns(metadata, lidar.receiver.return_mode);
  return std::make_unique<OusterEncoder>(metadata, std::get<SpinningSpec>(lidar.scan.pattern));
}

}  // namespace railcast
