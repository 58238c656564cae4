#include "core/extras/ros/bag/bag.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/extras/ros/bag/bag_metadata.h"
#include "core/extras/ros/mcap/mcap_copy.h"
#include "core/extras/ros/mcap/mcap_reader.h"
#include "core/extras/ros/mcap/record_codec.h"
#include "core/io/unfinished_file.h"

namespace railcast::bag {
namespace {

std::set<std::uint16_t> ChannelsOfTopic(const std::filesystem::path& file,
                                        const std::string& name,
                                        const BagTopic& topic) {
  const mcap::McapIndex index = mcap::ReadIndex(mcap::ByteFile(file, name));
  std::set<std::uint16_t> channels;
  for (const auto& [id, channel] : index.channels) {
    const auto schema = index.schemas.find(channel.schema_id);
    const bool is_of_type =
        schema != index.schemas.end() &&
        FullTypeName(schema->second.name, channel.message_encoding) == topic.type;
    if (is_of_type && channel.topic == topic.name && channel.message_encoding == topic.encoding) {
      channels.insert(id);
    }
  }
  return channels;
}

class McapBagCopy : public BagCopy {
 public:
  McapBagCopy(const std::filesystem::path& file,
              const std::string& name,
              const std::filesystem::path& copy,
              const BagTopic& topic)
      : out_(copy, 0),
        copy_(
            file,
            name,
            [this](mcap::ByteSpan bytes) { out_.Append(bytes); },
            ChannelsOfTopic(file, name, topic)) {}

  void Put(const BagPlace& place, std::optional<std::span<const std::byte>> data) override {
    std::optional<mcap::Bytes> bytes;
    if (data) bytes.emplace(data->begin(), data->end());
    copy_.Put(place.in_part, std::move(bytes));
  }

  void Finish() override {
    copy_.Finish();
    out_.Finish();
  }

 private:
  UnfinishedFile out_;
  mcap::McapCopy copy_;
};

std::string ChannelValue(const mcap::McapChannel& channel, const std::string& key) {
  const auto found = channel.metadata.find(key);
  return found == channel.metadata.end() ? std::string() : found->second;
}

class McapBagReader : public BagReader {
 public:
  McapBagReader(const std::filesystem::path& file, const std::string& name)
      : name_(name), reader_(file, name) {
    // Channels of several publishers are one topic here.
    for (const auto& [id, channel] : reader_.index().channels) {
      topic_by_channel_.emplace(id, topics_.Add(TopicOf(channel)));
    }
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_.topics(); }

  [[nodiscard]] std::optional<std::int64_t> FindStart_ns() override {
    const mcap::McapStatistics& statistics = reader_.index().statistics;
    if (statistics.message_count == 0) return std::nullopt;
    return CheckedTime_ns(statistics.message_start_time);
  }

  void Select(const std::vector<std::size_t>& wanted) override {
    const std::set<std::size_t> chosen(wanted.begin(), wanted.end());
    std::set<std::uint16_t> channels;
    for (const auto& [id, topic] : topic_by_channel_) {
      if (chosen.contains(topic)) channels.insert(id);
    }
    reader_.Select(std::move(channels));
  }

  [[nodiscard]] std::optional<BagMessage> Next() override {
    const auto message = reader_.Next();
    if (!message) return std::nullopt;
    return BagMessage{topic_by_channel_.at(message->channel_id),
                      CheckedTime_ns(message->log_time),
                      message->data,
                      {.in_part = reader_.place()},
                      message->channel_id};
  }

  [[nodiscard]] std::vector<BagAttachment> ReadAttachments() override {
    std::vector<BagAttachment> attachments;
    for (const mcap::McapAttachmentIndex& entry : reader_.index().attachments) {
      const mcap::Bytes content = reader_.ReadAttachment(entry);
      const auto record = mcap::ReadRecord<mcap::McapAttachment>(content);
      const mcap::ByteSpan bytes = record.data.bytes;
      attachments.push_back({record.name, record.media_type, {bytes.begin(), bytes.end()}});
    }
    return attachments;
  }

  [[nodiscard]] std::vector<Remark> remarks() const override {
    const auto& cut = reader_.index().cut;
    if (!cut) return {};
    if (cut->is_surplus) {
      return {
          {RemarkKind::kSurplusBytes, name_ + ": byte " + NumberText(cut->offset), cut->num_bytes}};
    }
    return {{.kind = RemarkKind::kRecordingCut,
             .place = name_ + ": record at " + NumberText(cut->offset),
             .detail = cut->num_bytes == 0 ? "its end is missing"
                                           : "the last " + NumberText(cut->num_bytes) +
                                                 " bytes are no whole record"}};
  }

 private:
  [[nodiscard]] std::int64_t CheckedTime_ns(std::uint64_t time_ns) const {
    if (time_ns <= std::uint64_t{std::numeric_limits<std::int64_t>::max()}) {
      return static_cast<std::int64_t>(time_ns);
    }
    throw InputError(name_ + ": log_time: must be < 2^63" + Got(time_ns));
  }

  [[nodiscard]] BagTopic TopicOf(const mcap::McapChannel& channel) const {
    BagTopic topic{.name = channel.topic,
                   .type = {},
                   .definition = {},
                   .hash = ChannelValue(channel, "topic_type_hash"),
                   .is_latched = IsLatchedQos(ChannelValue(channel, "offered_qos_profiles")),
                   .encoding = channel.message_encoding};
    const auto schema = reader_.index().schemas.find(channel.schema_id);
    if (schema == reader_.index().schemas.end()) return topic;
    topic.type = FullTypeName(schema->second.name, topic.encoding);
    if (schema->second.encoding == "ros2msg") topic.definition = schema->second.data;
    return topic;
  }

  std::string name_;
  mcap::McapReader reader_;
  TopicList topics_;
  std::map<std::uint16_t, std::size_t> topic_by_channel_;
};

}  // namespace

std::unique_ptr<BagReader> OpenMcapBag(const std::filesystem::path& file, const std::string& name) {
  return std::make_unique<McapBagReader>(file, name);
}

std::unique_ptr<BagCopy> CopyMcapBag(const std::filesystem::path& file,
                                     const std::string& name,
                                     const std::filesystem::path& copy,
                                     const BagTopic& topic) {
  return std::make_unique<McapBagCopy>(file, name, copy, topic);
}

}  // namespace railcast::bag
