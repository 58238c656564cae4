#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/bag/bag.h"
#include "core/io/recording/cloud_frame.h"
#include "core/io/recording/cloud_message.h"
#include "core/io/recording/message_packets.h"
#include "core/io/recording/packet_messages.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/recording/tf_poses.h"
#include "core/io/ros/cdr.h"
#include "core/scenario/ouster_metadata.h"

namespace railcast {
namespace {

std::int64_t NsOf(const ros::Time& time) {
  return time.sec * kNsPerS + time.nanosec;
}

bool CanBeOpened(const bag::BagTopic& topic) {
  return topic.encoding == "cdr" &&
         (topic.type == ros::PointCloud2::kName || FindPacketsOf(topic.type) != nullptr);
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
    return {.file = wanted, .metadata = ParseOusterMetadata(text)};
  });
}

class PacketSource : public DatagramSource {
 public:
  PacketSource(const std::filesystem::path& bag, std::size_t topic, std::string name)
      : bag_(bag::OpenBag(bag)),
        packets_of_(FindPacketsOf(bag_->topics().at(topic).type)),
        name_(std::move(name)) {
    bag_->Select({topic});
  }

  [[nodiscard]] std::optional<CapturedDatagram> Next() override {
    while (next_ == packets_.size()) {
      const auto message = bag_->Next();
      if (!message) return std::nullopt;
      packets_ = AtPlace(name_ + ": message " + NumberText(num_messages_++) + ": ",
                         [&] { return packets_of_(*message); });
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
  std::size_t num_messages_{};
  std::size_t num_packets_{};
  std::vector<MessagePacket> packets_;  ///< Of the last message.
  std::size_t next_{};
};

/// @param source As messages and RecordingInfo name the bag.
DatagramPlace PlaceOfPackets(const std::filesystem::path& source,
                             const std::filesystem::path& bag,
                             std::size_t topic,
                             bag::BagReader& reader) {
  const std::string& name = reader.topics()[topic].name;
  return {.open = [=] { return std::make_unique<PacketSource>(bag, topic, ShownPath(source)); },
          .source = source,
          .beside = AtPlace(ShownPath(source) + ": ",
                            [&] { return OusterMetadataBeside(name, reader); })};
}

/// Returns when the first point was measured. Times of points count from the message's stamp, or
/// as the stamp itself does; whichever they are nearer to.
std::int64_t StampOf(const ros::Header& header, const Cloud& cloud) {
  const std::int64_t stamp_ns = NsOf(header.stamp);
  const auto first_ns = FirstTimeIn_ns(cloud);
  if (!first_ns) return stamp_ns;
  constexpr double kLongest_ns = 3600.0 * kNsPerS;
  const double since_stamp_ns = *first_ns - static_cast<double>(stamp_ns);
  const bool is_absolute = std::abs(since_stamp_ns) < std::abs(*first_ns);
  const double offset_ns = is_absolute ? since_stamp_ns : *first_ns;
  return std::abs(offset_ns) < kLongest_ns ? stamp_ns + std::llround(offset_ns) : stamp_ns;
}

/// Gives the frame its poses, if they are known for the whole scan.
void FillPoses(const TfPoses& poses, RecordedFrame& recorded) {
  Frame& frame = recorded.frame;
  const auto begin = poses.At(frame.stamp_ns);
  const auto end = poses.At(frame.stamp_ns + frame.duration_ns);
  if (!begin || !end) return;
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
}

RecordedFrame ReadCloudMessage(std::span<const std::byte> data,
                               const std::string& name,
                               const std::string& frame_id,
                               const TfPoses& poses) {
  auto message = AtPlace(name + ": ", [&] { return ros::FromCdr<ros::PointCloud2>(data); });
  const ros::Header header = message.header;
  const Cloud cloud = AtPlace(name + ": ", [&] { return MakeCloud(std::move(message)); });
  RecordedFrame recorded = MakeCloudFrame(cloud, name);
  recorded.frame.stamp_ns = StampOf(header, cloud);
  if (header.frame_id == frame_id) FillPoses(poses, recorded);
  return recorded;
}

/// Returns the frame of reference of a topic's first cloud; empty if it has none.
std::string FrameIdOf(bag::BagReader& bag, std::size_t topic, const std::string& name) {
  bag.Select({topic});
  const auto message = bag.Next();
  if (!message) return {};
  return AtPlace(name + ": message 0: ",
                 [&] { return ros::FromCdr<ros::PointCloud2>(message->data).header.frame_id; });
}

class CloudTopicRecording : public Recording {
 public:
  CloudTopicRecording(const std::filesystem::path& source,
                      std::unique_ptr<bag::BagReader> bag,
                      std::size_t topic)
      : bag_(std::move(bag)),
        name_(ShownPath(source)),
        frame_id_(FrameIdOf(*bag_, topic, name_)),
        poses_(AtPlace(name_ + ": ",
                       [&] { return std::make_shared<const TfPoses>(*bag_, frame_id_); })) {
    info_.source = source;
    info_.kind = "bag of ROS 2";
    bag_->Select({topic});
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }

  [[nodiscard]] std::optional<FrameReader> Next() override {
    const auto message = bag_->Next();
    if (!message) return std::nullopt;
    auto data =
        std::make_shared<const std::vector<std::byte>>(message->data.begin(), message->data.end());
    const std::uint32_t index = num_frames_++;
    return [data = std::move(data), index, name = name_ + ": message " + NumberText(index),
            frame_id = frame_id_, poses = poses_] {
      RecordedFrame recorded = ReadCloudMessage(*data, name, frame_id, *poses);
      recorded.frame.index = index;
      return recorded;
    };
  }

 private:
  RecordingInfo info_;
  std::unique_ptr<bag::BagReader> bag_;
  std::string name_;
  std::string frame_id_;
  std::shared_ptr<const TfPoses> poses_;
  std::uint32_t num_frames_{};
};

}  // namespace

std::size_t PickTopic(const std::vector<bag::BagTopic>& topics,
                      const std::filesystem::path& bag,
                      const std::string& name) {
  std::string names;
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (!CanBeOpened(topics[i])) continue;
    candidates.push_back(i);
    names += (names.empty() ? "" : ", ") + ShownText(topics[i].name);
    // Some recorders leave out the first slash.
    if (topics[i].name == name || '/' + topics[i].name == name) return i;
  }
  const std::string place = ShownPath(bag) + ": ";
  if (candidates.empty()) {
    throw InputError(place + "must have a topic of type " + std::string(ros::PointCloud2::kName) +
                     " or of a sensor's packets (got none)");
  }
  if (!name.empty()) {
    throw InputError(place + "--topic: must be one of " + names + " (got " + ShownText(name) + ")");
  }
  if (candidates.size() > 1) {
    throw InputError(place + "--topic: must be one of " + names + " (got none)");
  }
  return candidates.front();
}

std::unique_ptr<DatagramSource> OpenBagPackets(const std::filesystem::path& bag) {
  const std::vector<bag::BagTopic> topics = bag::OpenBag(bag)->topics();
  const std::size_t picked = PickTopic(topics, bag, "");
  if (FindPacketsOf(topics[picked].type) != nullptr) {
    return std::make_unique<PacketSource>(bag, picked, ShownPath(bag));
  }
  throw InputError(ShownPath(bag) + ": must hold packets of a sensor (got " +
                   ShownText(topics[picked].type) + ")");
}

bool HoldsPoints(const bag::BagTopic& topic) {
  return CanBeOpened(topic);
}

std::optional<DatagramPlace> FindBagPackets(const std::filesystem::path& bag,
                                            const std::string& topic) {
  const auto reader = bag::OpenBag(bag);
  const std::size_t picked = PickTopic(reader->topics(), bag, topic);
  if (FindPacketsOf(reader->topics()[picked].type) == nullptr) return std::nullopt;
  return PlaceOfPackets(bag, bag, picked, *reader);
}

std::unique_ptr<Recording> OpenBagRecording(const std::filesystem::path& source,
                                            const std::filesystem::path& bag,
                                            const std::string& topic) {
  auto reader = bag::OpenBag(bag);
  const std::size_t picked = PickTopic(reader->topics(), bag, topic);
  if (FindPacketsOf(reader->topics()[picked].type) == nullptr) {
    return std::make_unique<CloudTopicRecording>(source, std::move(reader), picked);
  }
  return OpenDatagrams(PlaceOfPackets(source, bag, picked, *reader));
}

}  // namespace railcast
