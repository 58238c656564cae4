#include <set>
#include <string>

#include "core/io/bag/mcap_bag.h"
#include "core/io/mcap/mcap_copy.h"
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
    const bool is_of_type = schema != index.schemas.end() && schema->second.name == topic.type;
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

}  // namespace

std::unique_ptr<BagCopy> CopyMcapBag(const std::filesystem::path& file,
                                     const std::string& name,
                                     const std::filesystem::path& copy,
                                     const BagTopic& topic) {
  return std::make_unique<McapBagCopy>(file, name, copy, topic);
}

}  // namespace railcast::bag
