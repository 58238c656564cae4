#include "core/extras/ros/recording/bag_recording.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/recording/bag_series.h"
#include "core/extras/ros/recording/cloud_message.h"
#include "core/extras/ros/recording/message_packets.h"
#include "core/extras/ros/recording/packet_messages.h"
#include "core/extras/ros/recording/tf_poses.h"
#include "core/io/recording/cloud_frame.h"
#include "core/io/recording/plausibility.h"
#include "core/scenario/ouster_metadata.h"

namespace railcast {
namespace {

std::int64_t NsOf(const ros::Time& time) {
  return time.sec * kNsPerS + time.nanosec;
}

/// Reads the metadata of an Ouster sensor, which its driver records as `metadata` beside the topic
/// of the packets.
CaptureMetadata OusterMetadataBeside(const std::string& packets, bag::BagReader& bag) {
  const std::string wanted = packets.substr(0, packets.rfind('/') + 1) + "metadata";
  const auto& topics = bag.topics();
  const auto found = std::ranges::find_if(topics, [&](const bag::BagTopic& topic) {
    return topic.name == wanted && topic.type == ros::StringMessage::kName;
  });
  if (found == topics.end()) return {};
  bag.Select({static_cast<std::size_t>(found - topics.begin())});
  const auto message = bag.Next();
  if (!message) return {};
  return AtPlace(wanted + ": ", [&]() -> CaptureMetadata {
    const auto text = ros::FromCdr<ros::StringMessage>(message->data).data;
    return {.file = wanted, .metadata = ParseOusterOfPackets(text)};
  });
}

class PacketSource : public DatagramSource {
 public:
  PacketSource(const BagSource& bag, std::size_t topic, std::string name)
      : bag_(bag::OpenBag(bag.bag)),
        packets_of_(FindPacketsOf(bag_->topics().at(topic).type)),
        name_(std::move(name)),
        series_(bag.series) {
    bag_->Select({topic});
  }

  [[nodiscard]] std::optional<CapturedDatagram> Next() override {
    while (next_ == packets_.size()) {
      const bool is_read = AtPlace(name_ + ": message " + NumberText(num_messages_++) + ": ", [&] {
        const auto message = NextOfSeries(*bag_, series_);
        if (message) packets_ = packets_of_(*message);
        return message.has_value();
      });
      if (!is_read) return std::nullopt;
      next_ = 0;
    }
    const MessagePacket& packet = packets_[next_++];
    return CapturedDatagram{
        .payload = packet.payload, .time_ns = packet.time_ns, .packet = num_packets_++};
  }

 private:
  std::unique_ptr<bag::BagReader> bag_;
  PacketsOfMessage packets_of_;
  std::string name_;
  std::string series_;
  std::size_t num_messages_{};
  std::size_t num_packets_{};
  std::vector<MessagePacket> packets_;  ///< Packets of the last message.
  std::size_t next_{};
};

/// @param source As messages and RecordingInfo name the bag.
DatagramPlace PlaceOfPackets(const std::filesystem::path& source,
                             const BagSource& bag,
                             std::size_t topic,
                             bag::BagReader& reader) {
  const std::string& name = reader.topics()[topic].name;
  static_cast<void>(ReadHeaders(reader, topic, ShownPath(source) + ": ", bag.series));
  return {.open = [=] { return std::make_unique<PacketSource>(bag, topic, ShownPath(source)); },
          .source = source,
          .beside = AtPlace(ShownPath(source) + ": ",
                            [&] { return OusterMetadataBeside(name, reader); })};
}

/// A message with points.
struct CloudMessage {
  ros::Header header;
  Cloud cloud;
  /// When the first point was measured: since the stamp or, where these are nearer, as the stamp
  /// counts.
  std::optional<double> first_ns;
  /// Where the type of the message defines it, as the stamp counts.
  std::optional<std::int64_t> defined_ns{};
};

CloudMessage ReadLivox(std::span<const std::byte> data) {
  const auto message = ros::FromCdr<ros::LivoxCloud>(data);
  std::int64_t offset_ns = 0;
  Cloud cloud = MakeCloud(message, offset_ns);
  CloudMessage read{message.header, std::move(cloud), static_cast<double>(offset_ns)};
  // The time base may be on the sensor's own clock.
  constexpr std::int64_t kSameClock_ns = kNsPerS / 10;
  const std::int64_t stamp_ns = NsOf(message.header.stamp);
  const auto base_ns = static_cast<std::int64_t>(message.timebase & ~(std::uint64_t{1} << 63U));
  if (stamp_ns >= 0 && std::abs(base_ns - stamp_ns) <= kSameClock_ns) {
    read.defined_ns = base_ns + offset_ns;
  }
  return read;
}

CloudMessage ReadCloud2(std::span<const std::byte> data) {
  auto message = ros::FromCdr<ros::PointCloud2>(data);
  const ros::Header header = message.header;
  Cloud cloud = MakeCloud(std::move(message));
  const auto first_ns = FirstTimeIn_ns(cloud);
  return {header, std::move(cloud), first_ns};
}

/// Gives the frame the time of its first point, or leaves the stamp, with a remark.
void FillStamp(const CloudMessage& message, RecordedFrame& recorded) {
  Frame& frame = recorded.frame;
  const std::int64_t stamp_ns = NsOf(message.header.stamp);
  frame.stamp_ns = message.defined_ns.value_or(stamp_ns);
  if (!message.first_ns || message.defined_ns) return;
  const FirstPointTime first = FirstPointTimeOf(stamp_ns, *message.first_ns, frame.duration_ns);
  if (first.is_certain) {
    frame.stamp_ns += std::llround(first.since_stamp_ns);
    return;
  }
  AddRemark({.kind = RemarkKind::kTimesRelative,
             .place = recorded.name,
             .detail = "the first time is " + ShortText(first.since_stamp_ns / kNsPerS) +
                       " s from the stamp"},
            recorded.remarks);
}

/// Why there is no pose for a scan, if it is worth a word.
std::optional<Remark> WhyNoPose(const TfPoses& poses, const Frame& frame) {
  if (!poses.is_clock_known()) {
    return Remark{.kind = RemarkKind::kClocksDiffer, .place = {}, .detail = poses.other_clock()};
  }
  constexpr std::int64_t kOtherClock_ns = 60 * kNsPerS;
  const std::int64_t beyond_ns = poses.Beyond_ns(frame.stamp_ns);
  if (beyond_ns <= kOtherClock_ns) return std::nullopt;
  return Remark{.kind = RemarkKind::kClocksDiffer,
                .place = {},
                .detail = ShortText(double(beyond_ns) / kNsPerS) + " s from them"};
}

/// Gives the frame its poses, if they are known for the whole scan.
void FillPoses(const TfPoses& poses, RecordedFrame& recorded) {
  Frame& frame = recorded.frame;
  const std::int64_t end_ns = frame.stamp_ns + frame.duration_ns;
  const auto remark = [&](RemarkKind kind, const std::string& detail) {
    AddRemark({.kind = kind, .place = recorded.name, .detail = detail}, recorded.remarks);
  };
  const auto begin = poses.At(frame.stamp_ns);
  const auto end = poses.At(end_ns);
  if (!begin || !end) {
    if (const auto why = WhyNoPose(poses, frame)) remark(why->kind, why->detail);
    return;
  }
  if (const std::string jump = poses.JumpWithin(frame.stamp_ns, end_ns); !jump.empty()) {
    return remark(RemarkKind::kPosesJumped, jump);
  }
  constexpr std::uint32_t kStep_ns = 20'000'000;  // As frames of ours.
  std::vector<ScanPose> between;
  for (std::uint32_t time_ns = kStep_ns; time_ns < frame.duration_ns; time_ns += kStep_ns) {
    const auto pose = poses.At(frame.stamp_ns + time_ns);
    if (!pose) return;
    between.push_back({time_ns, *pose});
  }
  frame.world_from_sensor = *begin;
  frame.world_from_sensor_end = *end;
  frame.poses_between = std::move(between);
  recorded.has_pose = true;
  if (!poses.other_clock().empty()) remark(RemarkKind::kClocksShifted, poses.other_clock());
  const std::int64_t bridged_ns =
      std::max(poses.Bridged_ns(frame.stamp_ns), poses.Bridged_ns(end_ns));
  if (bridged_ns == 0) return;
  remark(RemarkKind::kPosesBridged, ShortText(double(bridged_ns) / kNsPerS) + " s");
}

/// How the messages of a topic with clouds are read.
using ReadMessage = CloudMessage (*)(std::span<const std::byte> data);

RecordedFrame ReadCloudMessage(std::span<const std::byte> data,
                               ReadMessage read,
                               const std::string& name,
                               const std::string& frame_id,
                               const TfPoses& poses) {
  CloudMessage message = AtPlace(name + ": ", [&] { return read(data); });
  for (Remark& remark : message.cloud.remarks) remark.place = name;
  const std::string why_no_ranges =
      poses.is_fixed() ? "its frame_id " + Quoted(frame_id) +
                             " is that of a fixed frame, and where the sensor was is not known"
                       : "";
  // Raw turns are sent as of "map", too, to be shown without transforms. Points that were moved
  // form no rings of regular azimuths, but keep rows and our columns.
  const bool may_be_raw = poses.is_fixed_by_name() && message.cloud.height == 1 &&
                          message.cloud.Find("column") == nullptr;
  RecordedFrame recorded = MakeCloudFrame(message.cloud, name, may_be_raw ? "" : why_no_ranges);
  if (may_be_raw && !recorded.is_grid) {
    recorded = MakeCloudFrame(message.cloud, name, why_no_ranges);
  }
  FillStamp(message, recorded);
  RemarkOtherRanges(recorded);
  if (PlainFrame(message.header.frame_id) == frame_id) FillPoses(poses, recorded);
  return recorded;
}

class CloudTopicRecording : public Recording {
 public:
  /// @param series As NextOfSeries() takes it.
  CloudTopicRecording(const std::filesystem::path& source,
                      std::unique_ptr<bag::BagReader> bag,
                      std::size_t topic,
                      std::string series)
      : bag_(std::move(bag)),
        name_(ShownPath(source)),
        series_(std::move(series)),
        read_(IsOfLivox(bag_->topics()[topic]) ? &ReadLivox : &ReadCloud2),
        headers_(ReadHeaders(*bag_, topic, name_ + ": ", series_)),
        poses_(AtPlace(name_ + ": ",
                       [&] { return std::make_shared<const TfPoses>(*bag_, headers_); })),
        overlaps_(std::make_shared<OverlapCheck>(info_.remarks)) {
    info_.source = source;
    info_.kind = "bag of ROS 2";
    for (const Remark& remark : poses_->remarks()) info_.remarks->Add(remark);
    bag_->Select({topic});
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }

  [[nodiscard]] std::optional<FrameReader> Next() override {
    const auto message = NextOfSeries(*bag_, series_);
    if (!message) return std::nullopt;
    auto data =
        std::make_shared<const std::vector<std::byte>>(message->data.begin(), message->data.end());
    const std::uint32_t index = num_frames_++;
    return [data = std::move(data), index, name = name_ + ": message " + NumberText(index),
            read = read_, frame_id = headers_.frame_id, poses = poses_, overlaps = overlaps_] {
      RecordedFrame recorded = ReadCloudMessage(*data, read, name, frame_id, *poses);
      recorded.frame.index = index;
      overlaps->Take(recorded);
      return recorded;
    };
  }

 private:
  RecordingInfo info_;
  std::unique_ptr<bag::BagReader> bag_;
  std::string name_;
  std::string series_;
  ReadMessage read_;
  CloudHeaders headers_;
  std::shared_ptr<const TfPoses> poses_;
  std::shared_ptr<OverlapCheck> overlaps_;
  std::uint32_t num_frames_{};
};

}  // namespace

FirstPointTime FirstPointTimeOf(std::int64_t stamp_ns, double first_ns, std::uint32_t duration_ns) {
  const double since_stamp_ns = first_ns - static_cast<double>(stamp_ns);
  const bool is_absolute = std::abs(since_stamp_ns) < std::abs(first_ns);
  const double offset_ns = is_absolute ? since_stamp_ns : first_ns;
  // Where the stamp is that of the last packet, its points come behind it.
  constexpr double kPacket = 0.1;
  return {offset_ns, offset_ns <= duration_ns && -offset_ns <= (1.0 + kPacket) * duration_ns};
}

std::optional<DatagramPlace> FindBagPackets(const BagSource& bag) {
  const auto reader = bag::OpenBag(bag.bag);
  const std::size_t picked = PickTopic(reader->topics(), bag.bag, bag.topic);
  if (FindPacketsOf(reader->topics()[picked].type) == nullptr) return std::nullopt;
  return PlaceOfPackets(bag.bag, bag, picked, *reader);
}

std::unique_ptr<Recording> OpenBagRecording(const std::filesystem::path& source,
                                            const BagSource& bag) {
  auto reader = bag::OpenBag(bag.bag);
  const std::size_t picked = PickTopic(reader->topics(), bag.bag, bag.topic);
  const std::vector<Remark> remarks = reader->remarks();
  std::unique_ptr<Recording> recording;
  if (FindPacketsOf(reader->topics()[picked].type) == nullptr) {
    recording =
        std::make_unique<CloudTopicRecording>(source, std::move(reader), picked, bag.series);
  } else {
    recording = OpenDatagrams(PlaceOfPackets(source, bag, picked, *reader));
  }
  for (const Remark& remark : remarks) recording->info().remarks->Add(remark);
  return recording;
}

}  // namespace railcast
