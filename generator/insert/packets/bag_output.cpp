#include "generator/insert/packets/bag_output.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/io/bag/bag.h"
#include "core/io/recording/message_packets.h"
#include "generator/insert/clouds/edit_rows.h"
#include "generator/insert/packets/bag_packet_editor.h"
#include "generator/insert/packets/cloud_message_edit.h"

namespace railcast {
namespace {

/// The messages of one topic of a bag, and the bag's copy.
struct TopicCopy {
  std::unique_ptr<bag::BagReader> messages;
  bag::BagTopic topic;
  std::unique_ptr<bag::BagCopy> copy;
};

TopicCopy CopyTopic(const BagSource& source, const std::filesystem::path& folder) {
  auto messages = bag::OpenBag(source.bag);
  const std::size_t picked = PickTopic(messages->topics(), source.bag, source.topic);
  const bag::BagTopic topic = messages->topics()[picked];
  messages->Select({picked});
  // A directory may be named with a slash at its end.
  const auto path = source.bag.has_filename() ? source.bag : source.bag.parent_path();
  auto copy = bag::CopyBag(source.bag, folder / path.filename(), topic);
  return {std::move(messages), topic, std::move(copy)};
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
      if (const auto message = topic_.messages->Next()) {
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
      topic_.copy->Put(topic_.messages->Next().value().place, std::nullopt);
    }
    const bag::BagMessage message = topic_.messages->Next().value();
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

std::unique_ptr<InsertedOutput> MakeBagOutput(const BagSource& source,
                                              const std::filesystem::path& folder) {
  TopicCopy topic = CopyTopic(source, folder);
  if (const auto packets = FindBagPackets(source.bag, source.topic)) {
    return std::make_unique<BagPacketOutput>(source, *packets, std::move(topic));
  }
  return std::make_unique<BagCloudOutput>(std::move(topic));
}

}  // namespace railcast
