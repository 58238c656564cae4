#include <algorithm>
#include <cerrno>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/bag/bag_metadata.h"
#include "core/extras/ros/mcap/byte_file.h"
#include "core/extras/ros/mcap/mcap_index.h"
#include "core/extras/ros/mcap/mcap_writer.h"
#include "core/extras/ros/mcap/record_scan.h"
#include "core/io/unfinished_file.h"
#include "core/io/write_file.h"

namespace railcast::bag {
namespace {

constexpr const char* kLibrary = "railcast";
constexpr const char* kQosKey = "offered_qos_profiles";
constexpr const char* kHashKey = "topic_type_hash";

std::filesystem::path UnfinishedMcap(const std::filesystem::path& target) {
  return target.string() + std::string(kUnfinishedSuffix);
}

class McapBagWriter : public BagWriter {
 public:
  McapBagWriter(const std::filesystem::path& file,
                McapCompression compression,
                const std::optional<McapTrace>& trace)
      : file_(file, 0),
        trace_(trace),
        writer_(Sink(), {trace ? "" : "ros2", kLibrary}, compression, {}) {
    // As recorders of ROS 2 do, so that also an interrupted bag says in which form its QoS are.
    WriteMetadata();
  }
  McapBagWriter(const std::filesystem::path& file,
                mcap::ScannedFile kept,
                McapCompression compression,
                const std::optional<McapTrace>& trace)
      : file_(file, kept.size),
        trace_(trace),
        num_commits_(kept.index.chunks.size()),
        writer_(Sink(), std::move(kept.index), compression, kept.size, kept.crc) {
    for (const auto& [id, schema] : writer_.index().schemas) schema_ids_.emplace(schema.name, id);
    for (const auto& [id, channel] : writer_.index().channels) topics_.push_back(TopicOf(channel));
  }

  std::size_t Add(const BagTopic& topic) override {
    const auto known = std::ranges::find(topics_, topic.name, &BagTopic::name);
    if (known != topics_.end()) return static_cast<std::size_t>(known - topics_.begin());
    const auto [schema, is_new] =
        schema_ids_.emplace(topic.type, static_cast<std::uint16_t>(schema_ids_.size() + 1));
    if (is_new) {
      writer_.Write(mcap::McapSchema{schema->second, topic.type, trace_ ? "protobuf" : "ros2msg",
                                     topic.definition});
    }
    topics_.push_back(topic);
    mcap::McapChannel channel{.id = static_cast<std::uint16_t>(topics_.size()),
                              .schema_id = schema->second,
                              .topic = topic.name,
                              .message_encoding = topic.encoding,
                              .metadata = {}};
    if (trace_) {
      channel.metadata = trace_->channel_metadata;
    } else {
      channel.metadata = {{kQosKey, QosText(topic.is_latched, MetadataVersion::kIron)},
                          {kHashKey, topic.hash}};
    }
    writer_.Write(channel);
    return topics_.size() - 1;
  }

  void Write(const BagMessage& message) override {
    Check(message.topic < topics_.size(), "the topic of a message was added to its bag");
    Check(message.time_ns >= 0, "times of messages are not negative");
    const auto time = static_cast<std::uint64_t>(message.time_ns);
    writer_.Write(mcap::McapMessage{.channel_id = static_cast<std::uint16_t>(message.topic + 1),
                                    .sequence = 0,
                                    .log_time = time,
                                    .publish_time = time,
                                    .data = message.data});
    has_messages_ = true;
  }

  void Attach(const std::string& name,
              const std::string& media_type,
              std::span<const std::byte> bytes) override {
    const std::uint64_t time = writer_.index().statistics.message_end_time;
    writer_.Write(mcap::McapAttachment{.log_time = time,
                                       .create_time = 0,
                                       .name = name,
                                       .media_type = media_type,
                                       .data = {bytes},
                                       .crc = 0});
  }

  void Commit() override {
    if (!std::exchange(has_messages_, false)) return;
    writer_.EndChunk();
    file_.Sync();
    ++num_commits_;
  }

  void Close() override {
    Commit();
    writer_.EndChunk();
    // The metadata of a trace do not change.
    if (!trace_) WriteMetadata();
    writer_.Finish();
    file_.Finish();
  }

  [[nodiscard]] std::size_t num_commits() const override { return num_commits_; }

 private:
  [[nodiscard]] mcap::McapWriter::Sink Sink() const {
    return [this](mcap::ByteSpan bytes) { file_.Append(bytes); };
  }

  [[nodiscard]] BagTopic TopicOf(const mcap::McapChannel& channel) const {
    const mcap::McapSchema& schema = writer_.index().schemas.at(channel.schema_id);
    BagTopic topic{.name = channel.topic,
                   .type = schema.name,
                   .definition = schema.data,
                   .hash = {},
                   .is_latched = false,
                   .encoding = channel.message_encoding};
    if (trace_) return topic;
    topic.hash = channel.metadata.at(kHashKey);
    topic.is_latched = IsLatchedQos(channel.metadata.at(kQosKey));
    return topic;
  }

  void WriteMetadata() {
    if (trace_) return writer_.Write(mcap::McapMetadata{trace_->name, trace_->metadata});
    const mcap::McapStatistics& statistics = writer_.index().statistics;
    BagMetadata metadata{.storage = "mcap", .file = file_.final_name(), .topics = {}};
    if (statistics.message_count > 0) {
      metadata.start_ns = static_cast<std::int64_t>(statistics.message_start_time);
      metadata.duration_ns =
          static_cast<std::int64_t>(statistics.message_end_time - statistics.message_start_time);
    }
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      const auto count = statistics.channel_message_counts.find(static_cast<std::uint16_t>(i + 1));
      const bool has_any = count != statistics.channel_message_counts.end();
      metadata.topics.push_back({topics_[i], has_any ? count->second : 0});
    }
    writer_.Write(mcap::McapMetadata{
        "rosbag2", {{"serialized_metadata", MetadataText(metadata, MetadataVersion::kIron)}}});
  }

  UnfinishedFile file_;
  std::optional<McapTrace> trace_;
  std::size_t num_commits_{};
  mcap::McapWriter writer_;
  std::vector<BagTopic> topics_;
  std::map<std::string, std::uint16_t> schema_ids_;  ///< By type.
  bool has_messages_ = false;  ///< Whether the commit that is being made has any.
};

/// Returns where the last of the first `max_commits` commits ends that is whole with its message
/// indexes; 0 if none is.
std::uint64_t EndOfCommits(const mcap::McapIndex& index, std::size_t max_commits) {
  std::uint64_t end = 0;
  for (const mcap::McapChunkIndex& chunk : index.chunks) {
    const bool is_whole = std::ranges::all_of(chunk.message_index_offsets,
                                              [](const auto& entry) { return entry.second > 0; });
    if (!is_whole || max_commits-- == 0) break;
    end = chunk.chunk_start_offset + chunk.chunk_length + chunk.message_index_length;
  }
  return end;
}

}  // namespace

std::unique_ptr<BagWriter> CreateMcap(const std::filesystem::path& file,
                                      McapCompression compression,
                                      const std::optional<McapTrace>& trace) {
  return std::make_unique<McapBagWriter>(file, compression, trace);
}

std::unique_ptr<BagWriter> ContinueMcap(const std::filesystem::path& file,
                                        McapCompression compression,
                                        std::size_t max_commits,
                                        const std::optional<McapTrace>& trace) {
  const std::filesystem::path unfinished = UnfinishedMcap(file);
  const mcap::ByteFile content(unfinished, ShownPath(unfinished));
  if (content.size() < mcap::kMagic.size()) return CreateMcap(file, compression, trace);
  const mcap::ScannedFile found = mcap::ScanUndamaged(content);
  const std::string& library = found.index.header.library;
  if (!mcap::BeginsAsMcap(content) || (!library.empty() && library != kLibrary)) {
    throw InputError(ShownPath(unfinished) + ": must be an MCAP file that railcast began" +
                     (library.empty() ? "" : " (got " + Quoted(library) + ")"));
  }
  const std::uint64_t end = EndOfCommits(found.index, max_commits);
  if (end == 0) return CreateMcap(file, compression, trace);
  mcap::ScannedFile kept = mcap::ScanWhole(content, end);
  return std::make_unique<McapBagWriter>(file, std::move(kept), compression, trace);
}

}  // namespace railcast::bag
