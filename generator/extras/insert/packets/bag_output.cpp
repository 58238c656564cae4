#include "generator/extras/insert/packets/packet_outputs.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/recording/bag_series.h"
#include "core/extras/ros/recording/cloud_message.h"
#include "core/extras/ros/recording/message_packets.h"
#include "generator/extras/insert/clouds/edit_rows.h"
#include "generator/extras/insert/inserted_frame.h"
#include "generator/extras/insert/packets/turn_editor.h"
#include "generator/extras/insert/recorded_firings.h"

namespace railcast {
namespace {

/// A message with edits, and what its points are.
struct EditedCloudMessage {
  std::vector<std::byte> data;
  /// For each of its points the slot; kNoSlot for places that belong to none.
  std::vector<std::uint32_t> slots;
};

/// Puts rows of points into an organised message, which keeps what stands between its rows.
void PutRows(const std::vector<std::uint8_t>& points, ros::PointCloud2& cloud) {
  const std::size_t row_size = std::size_t{cloud.width} * cloud.point_step;
  const std::size_t row_step = RowStepOf(cloud);
  for (std::size_t row = 0; row < cloud.height; ++row) {
    std::copy_n(points.begin() + static_cast<std::ptrdiff_t>(row * row_size), row_size,
                cloud.data.begin() + static_cast<std::ptrdiff_t>(row * row_step));
  }
}

/// Puts the edits of a frame into the message of type sensor_msgs/msg/PointCloud2 that it was read
/// from. Points that nothing touched keep their bytes. Rows and columns of an organised cloud stay,
/// with points that are absent marked; of others, points are left out and added.
/// @param data With CDR's header; so is the result, which is little-endian.
EditedCloudMessage EditCloudMessage(std::span<const std::byte> data,
                                    const RecordedFirings& firings,
                                    const InsertedFrame& inserted) {
  auto cloud = ros::FromCdr<ros::PointCloud2>(data);
  const Cloud points = MakeCloud(cloud);
  EditedRows edited = EditRows(points, firings, inserted, {});
  cloud.is_bigendian = false;
  if (points.num_points() == 0) {
    // It may not have said what points have.
    cloud.point_step = points.point_step;
    cloud.fields.clear();
    for (const CloudField& field : points.fields) {
      cloud.fields.push_back(
          {field.name, field.offset, static_cast<std::uint8_t>(field.type), field.count});
    }
  }
  const bool has_lost = std::ranges::any_of(
      inserted.edits, [](const SlotEdit& edit) { return edit.had_point && !edit.has_point; });
  if (edited.slots.size() == std::size_t{cloud.width} * cloud.height) {
    PutRows(edited.points.data, cloud);
    // Absent points are NaN.
    cloud.is_dense = cloud.is_dense && !(has_lost && cloud.height > 1);
    return {ros::ToCdr(cloud), std::move(edited.slots)};
  }
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(edited.slots.size());
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data = std::move(edited.points.data);
  return {ros::ToCdr(cloud), std::move(edited.slots)};
}

/// A message of the topic that is edited, and what becomes of it.
struct EditedMessage {
  bag::BagPlace place{};
  std::vector<std::byte> data;
  bool is_edited = false;
};

/// Puts the edits of frames into the messages of packets that they were read from.
class BagPacketEditor {
 public:
  /// @param source Names the bag in messages about errors.
  BagPacketEditor(const CaptureSensor& sensor, PacketsOfMessage packets_of, std::string source)
      : turns_(sensor, source), packets_of_(packets_of), source_(std::move(source)) {}

  /// Takes the next message of the topic.
  /// @throws InputError "bag: message 3: rule (got value)" if it is damaged.
  void Take(const bag::BagMessage& message) {
    const auto packets = AtPlace(source_ + ": message " + NumberText(num_messages_++) + ": ",
                                 [&] { return packets_of_(message); });
    HeldMessage held{
        .message = {.place = message.place, .data = {message.data.begin(), message.data.end()}},
        .first_datagram = num_datagrams_,
        .places = {}};
    for (const MessagePacket& packet : packets) {
      held.places.push_back(packet.place);
      turns_.Take({.payload = packet.payload,
                   .time_ns = packet.time_ns,
                   .packet = static_cast<std::size_t>(num_datagrams_++)});
    }
    held_.push_back(std::move(held));
  }
  /// Says that there are no further messages.
  void End() { turns_.End(); }

  /// As of TurnEditor.
  [[nodiscard]] bool Has(std::uint32_t turn) const { return turns_.Has(turn); }
  void Skip(std::uint32_t turn) { turns_.Skip(turn); }
  void Edit(const InsertedFrame& inserted) {
    for (const EditedPacket& packet : turns_.Edit(inserted)) {
      // The last message that begins at this datagram or before it, and has any.
      auto held =
          std::ranges::upper_bound(held_, packet.datagram, {}, &HeldMessage::first_datagram);
      --held;
      const std::size_t place = held->places.at(packet.datagram - held->first_datagram);
      const auto bytes = std::as_bytes(std::span(packet.after));
      std::ranges::copy(
          bytes, held->message.data.begin() + static_cast<std::ptrdiff_t>(place + packet.offset));
      held->message.is_edited = true;
    }
  }

  /// Returns the next message if no further edit concerns it.
  [[nodiscard]] std::optional<EditedMessage> Release() {
    if (held_.empty()) return std::nullopt;
    const HeldMessage& first = held_.front();
    const bool may_change =
        first.first_datagram + first.places.size() > turns_.first_open_datagram();
    return may_change ? std::nullopt : ReleaseLast();
  }
  /// Returns the next message in any case; nothing if there is none.
  [[nodiscard]] std::optional<EditedMessage> ReleaseLast() {
    if (held_.empty()) return std::nullopt;
    EditedMessage message = std::move(held_.front().message);
    held_.pop_front();
    return message;
  }

 private:
  struct HeldMessage {
    EditedMessage message;
    std::uint64_t first_datagram{};
    std::vector<std::size_t> places;  ///< Places of its datagrams.
  };

  TurnEditor turns_;
  PacketsOfMessage packets_of_;
  std::string source_;
  std::deque<HeldMessage> held_;
  std::uint64_t num_messages_{};
  std::uint64_t num_datagrams_{};
};

/// The messages of a series of a bag's topic, and the bag's copy.
struct TopicCopy {
  std::unique_ptr<bag::BagReader> messages;
  bag::BagTopic topic;
  std::string series;
  std::unique_ptr<bag::BagCopy> copy;

  /// Messages of other series stay as they are: the copy waits for every one of the topic.
  [[nodiscard]] std::optional<bag::BagMessage> Next() const {
    while (auto message = messages->Next()) {
      if (IsOfSeries(*messages, *message, series)) return message;
      copy->Put(message->place, std::nullopt);
    }
    return std::nullopt;
  }
};

/// Returns the index of the topic.
/// @throws InputError as CheckCanEdit().
std::size_t EditableTopic(const BagSource& source, const bag::BagReader& messages) {
  const std::size_t picked = PickTopic(messages.topics(), source.bag, source.topic);
  const std::string& type = messages.topics()[picked].type;
  if (type != ros::PointCloud2::kName && FindPacketsOf(type) == nullptr) {
    throw InputError(ShownPath(source.bag) + ": must have clouds of type " +
                     std::string(ros::PointCloud2::kName) +
                     " or packets to be inserted into (got " + ShownText(type) + ")");
  }
  return picked;
}

TopicCopy CopyTopic(const BagSource& source, const std::filesystem::path& folder) {
  auto messages = bag::OpenBag(source.bag);
  const std::size_t picked = EditableTopic(source, *messages);
  const bag::BagTopic topic = messages->topics()[picked];
  messages->Select({picked});
  // A directory may be named with a slash at its end.
  const auto path = source.bag.has_filename() ? source.bag : source.bag.parent_path();
  auto copy = bag::CopyBag(source.bag, folder / path.filename(), topic);
  return {std::move(messages), topic, source.series, std::move(copy)};
}

class BagPacketOutput : public InsertedOutput {
 public:
  BagPacketOutput(const BagSource& source, const DatagramPlace& packets, TopicCopy topic)
      : topic_(std::move(topic)),
        editor_(FindSensor(packets), FindPacketsOf(topic_.topic.type), ShownPath(source.bag)) {}

  std::optional<std::vector<std::uint32_t>> Write(const RecordedFirings&,
                                                  const InsertedFrame& inserted) override {
    if (inserted.edits.empty()) return std::nullopt;
    const std::uint32_t turn = inserted.recorded.frame.index;
    while (!editor_.Has(turn)) {
      if (const auto message = topic_.Next()) {
        editor_.Take(*message);
        editor_.Skip(turn);
      } else {
        editor_.End();
      }
      Release();
    }
    editor_.Edit(inserted);
    Release();
    return std::nullopt;
  }

  void Finish() override {
    while (const auto message = editor_.ReleaseLast()) Put(*message);
    topic_.copy->Finish();
  }

 private:
  void Release() {
    while (const auto message = editor_.Release()) Put(*message);
  }

  void Put(const EditedMessage& message) {
    std::optional<std::span<const std::byte>> data;
    if (message.is_edited) data = message.data;
    topic_.copy->Put(message.place, data);
  }

  TopicCopy topic_;
  BagPacketEditor editor_;
};

class BagCloudOutput : public InsertedOutput {
 public:
  explicit BagCloudOutput(TopicCopy topic) : topic_(std::move(topic)) {}

  std::optional<std::vector<std::uint32_t>> Write(const RecordedFirings& firings,
                                                  const InsertedFrame& inserted) override {
    if (inserted.edits.empty()) return SlotsOfEntries(firings);
    for (; next_ < inserted.recorded.frame.index; ++next_) {
      topic_.copy->Put(topic_.Next().value().place, std::nullopt);
    }
    const bag::BagMessage message = topic_.Next().value();
    ++next_;
    EditedCloudMessage edited = EditCloudMessage(message.data, firings, inserted);
    topic_.copy->Put(message.place, edited.data);
    return std::move(edited.slots);
  }

  void Finish() override { topic_.copy->Finish(); }

 private:
  TopicCopy topic_;
  std::uint32_t next_{};  ///< Number of the next message.
};

}  // namespace

void CheckCanEdit(const BagSource& source) {
  static_cast<void>(EditableTopic(source, *bag::OpenBag(source.bag)));
}

std::unique_ptr<InsertedOutput> MakeBagOutput(const BagSource& source,
                                              const std::filesystem::path& folder) {
  TopicCopy topic = CopyTopic(source, folder);
  if (const auto packets = FindBagPackets(source)) {
    return std::make_unique<BagPacketOutput>(source, *packets, std::move(topic));
  }
  return std::make_unique<BagCloudOutput>(std::move(topic));
}

}  // namespace railcast
