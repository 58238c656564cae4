#include "core/io/bag/bag_reader.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/io/mcap/compression.h"

namespace railcast::bag {
namespace {

/// A part of a bag, with the message of it that comes next.
struct BagPart {
  std::unique_ptr<BagReader> reader;
  std::size_t number{};             ///< As BagPlace counts them.
  std::vector<std::size_t> topics;  ///< Index in the whole bag by index in the part.
  std::optional<std::int64_t> start_ns;
  std::optional<BagMessage> next;
  bool is_begun = false;  ///< Not before its start is reached, so that few parts are in memory.
};

class MergedReader : public BagReader {
 public:
  explicit MergedReader(std::vector<std::unique_ptr<BagReader>> parts) {
    for (auto& reader : parts) {
      BagPart part{.reader = std::move(reader),
                   .number = parts_.size(),
                   .topics = {},
                   .start_ns = {},
                   .next = {}};
      part.start_ns = part.reader->FindStart_ns();
      for (const BagTopic& topic : part.reader->topics()) part.topics.push_back(IndexOf(topic));
      parts_.push_back(std::move(part));
    }
    std::ranges::stable_sort(parts_, {}, &BagPart::start_ns);
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }

  [[nodiscard]] std::optional<std::int64_t> FindStart_ns() override {
    // Parts without messages come first.
    const auto first =
        std::ranges::find_if(parts_, [](const BagPart& part) { return part.start_ns.has_value(); });
    return first == parts_.end() ? std::nullopt : first->start_ns;
  }

  void Select(const std::vector<std::size_t>& wanted) override {
    for (BagPart& part : parts_) {
      std::vector<std::size_t> in_part;
      for (std::size_t i = 0; i < part.topics.size(); ++i) {
        if (std::ranges::find(wanted, part.topics[i]) != wanted.end()) in_part.push_back(i);
      }
      part.reader->Select(in_part);
      part.is_begun = false;
    }
    last_ = nullptr;
  }

  [[nodiscard]] std::optional<BagMessage> Next() override {
    if (last_ != nullptr) last_->next = last_->reader->Next();
    BagPart* first = nullptr;
    for (BagPart& part : parts_) {
      const bool is_later = first != nullptr && part.start_ns > first->next->time_ns;
      if (is_later && !part.is_begun) continue;
      if (!std::exchange(part.is_begun, true)) part.next = part.reader->Next();
      if (!part.next) continue;
      if (first == nullptr || part.next->time_ns < first->next->time_ns) first = &part;
    }
    last_ = first;
    if (first == nullptr) return std::nullopt;
    return BagMessage{first->topics[first->next->topic],
                      first->next->time_ns,
                      first->next->data,
                      {.part = first->number, .in_part = first->next->place.in_part}};
  }

  [[nodiscard]] std::vector<BagAttachment> ReadAttachments() override {
    std::vector<BagAttachment> all;
    for (const BagPart& part : parts_) {
      for (BagAttachment& attachment : part.reader->ReadAttachments()) {
        all.push_back(std::move(attachment));
      }
    }
    return all;
  }

 private:
  std::size_t IndexOf(const BagTopic& topic) {
    const auto known = std::ranges::find_if(topics_, [&](const BagTopic& other) {
      return other.name == topic.name && other.type == topic.type &&
             other.encoding == topic.encoding;
    });
    const auto index = static_cast<std::size_t>(known - topics_.begin());
    if (known == topics_.end()) topics_.push_back(topic);
    return index;
  }

  std::vector<BagPart> parts_;
  std::vector<BagTopic> topics_;
  BagPart* last_ = nullptr;  ///< The part of which the last message was returned.
};

class UncompressingReader : public BagReader {
 public:
  UncompressingReader(std::unique_ptr<BagReader> bag, std::string name)
      : bag_(std::move(bag)), name_(std::move(name)) {}

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return bag_->topics(); }
  [[nodiscard]] std::optional<std::int64_t> FindStart_ns() override { return bag_->FindStart_ns(); }
  void Select(const std::vector<std::size_t>& wanted) override { bag_->Select(wanted); }

  [[nodiscard]] std::optional<BagMessage> Next() override {
    auto message = bag_->Next();
    if (!message) return std::nullopt;
    data_ = AtPlace(name_ + ": message: ", [&] {
      return mcap::Uncompressed(message->data, McapCompression::kZstd,
                                mcap::kMaxUncompressed_bytes);
    });
    message->data = data_;
    return message;
  }

  [[nodiscard]] std::vector<BagAttachment> ReadAttachments() override {
    return bag_->ReadAttachments();
  }

 private:
  std::unique_ptr<BagReader> bag_;
  std::string name_;
  mcap::Bytes data_;
};

}  // namespace

std::unique_ptr<BagReader> Merged(std::vector<std::unique_ptr<BagReader>> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  return std::make_unique<MergedReader>(std::move(parts));
}

std::unique_ptr<BagReader> WithUncompressedMessages(std::unique_ptr<BagReader> bag,
                                                    std::string name) {
  return std::make_unique<UncompressingReader>(std::move(bag), std::move(name));
}

}  // namespace railcast::bag
