#include "core/extras/osi/trace_file.h"

#include <cstring>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"

namespace railcast::osi {
namespace {

constexpr const char* kOsiVersion = "3.8.0";
/// Protobuf reads and writes none that are larger.
constexpr std::uint64_t kMaxMessage_bytes = 0x7fff'ffff;

std::string HashOf(mcap::ByteSpan bytes) {
  return ContentHash({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

bag::McapTrace McapTraceOf(const std::string& protobuf_version) {
  return {.name = "net.asam.osi.trace",
          .metadata = {{"version", kOsiVersion},
                       {"min_osi_version", kOsiVersion},
                       {"max_osi_version", kOsiVersion},
                       {"min_protobuf_version", protobuf_version},
                       {"max_protobuf_version", protobuf_version},
                       {"zero_time", "1970-01-01T00:00:00Z"}},
          .channel_metadata = {{"net.asam.osi.trace.channel.osi_version", kOsiVersion},
                               {"net.asam.osi.trace.channel.protobuf_version", protobuf_version}}};
}

SingleChannelReader::SingleChannelReader(const std::filesystem::path& file)
    : file_(file, ShownPath(file)) {}

std::optional<mcap::Bytes> SingleChannelReader::Next() {
  std::uint32_t length = 0;
  const std::uint64_t num_left = file_.size() - position_;
  if (num_left == 0) return std::nullopt;
  const std::string place = file_.name() + ": message " + NumberText(num_read_ + 1) + ": ";
  if (num_left < sizeof length) {
    throw InputError(place + "must begin with its length, 4 bytes (got " + NumberText(num_left) +
                     ")");
  }
  std::memcpy(&length, file_.Read(position_, sizeof length).data(), sizeof length);
  if (length > kMaxMessage_bytes) {
    throw InputError(place + "length: must be < 2^31" + Got(length));
  }
  if (length > num_left - sizeof length) {
    throw InputError(place + "must lie within the file (got " + NumberText(length) +
                     " bytes where it has " + NumberText(num_left - sizeof length) + " more)");
  }
  mcap::Bytes message = file_.Read(position_ + sizeof length, length);
  position_ += sizeof length + length;
  ++num_read_;
  return message;
}

TraceReader::TraceReader(const std::filesystem::path& file) {
  if (file.extension() == kSingleChannel) {
    single_channel_.emplace(file);
  } else {
    mcap_ = bag::OpenBag(file);
  }
}

std::optional<std::string> TraceReader::NextHash() {
  if (!fault_.empty()) return std::nullopt;
  try {
    if (!single_channel_) {
      const auto message = mcap_->Next();
      return message ? std::optional(HashOf(message->data)) : std::nullopt;
    }
    const auto message = single_channel_->Next();
    return message ? std::optional(HashOf(*message)) : std::nullopt;
  } catch (const InputError& error) {
    fault_ = error.what();
    return std::nullopt;
  }
}

}  // namespace railcast::osi
