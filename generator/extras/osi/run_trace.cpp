#include "generator/extras/osi/run_trace.h"

#include <span>

#include "core/base/error.h"
#include "core/extras/osi/sensor_view.h"
#include "core/io/write_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

fs::path UnfinishedTrace(const fs::path& file) {
  return file.string() + std::string(kUnfinishedSuffix);
}

// Little-endian, as all of this program's files.
std::string LengthBytes(const std::string& message) {
  const auto length = static_cast<std::uint32_t>(message.size());
  return {reinterpret_cast<const char*>(&length), sizeof length};
}

}  // namespace

osi::TraceContent RunTrace::Find(const fs::path& file) {
  try {
    if (fs::exists(file)) return osi::ReadTrace(file);
    if (fs::exists(UnfinishedTrace(file))) return osi::ReadTrace(UnfinishedTrace(file));
  } catch (const InputError&) {
    // Of what cannot be read, nothing is there.
  }
  return {};
}

RunTrace::RunTrace(const fs::path& file,
                   const std::string& topic,
                   const osi::TraceContent& found,
                   std::size_t num_messages)
    : num_messages_(num_messages) {
  if (file.extension() == osi::kSingleChannel) {
    const std::uint64_t end = num_messages == 0 ? 0 : found.messages.at(num_messages - 1).end;
    single_channel_.emplace(file, end);
    return;
  }
  // A run may be interrupted after its last frame, before its manifest is written.
  if (fs::exists(file)) fs::rename(file, UnfinishedTrace(file));
  if (num_messages == 0) fs::remove(UnfinishedTrace(file));
  const auto trace = osi::McapTraceOf(osi::ProtobufVersion());
  constexpr auto kCompression = bag::McapCompression::kZstd;
  mcap_ = fs::exists(UnfinishedTrace(file))
              ? bag::ContinueMcap(file, kCompression, num_messages, trace)
              : bag::CreateMcap(file, kCompression, trace);
  topic_ = mcap_->Add({.name = topic,
                       .type = "osi3.SensorView",
                       .definition = osi::SensorViewDescriptors(),
                       .hash = {},
                       .is_latched = false,
                       .encoding = "protobuf"});
  num_messages_ = mcap_->num_commits();
}

void RunTrace::Append(std::int64_t time_ns, const std::string& message) {
  if (single_channel_) {
    single_channel_->Append(LengthBytes(message) + message);
  } else {
    mcap_->Write({topic_, time_ns, std::as_bytes(std::span(message))});
    mcap_->Commit();
  }
  ++num_messages_;
}

void RunTrace::Close() {
  if (single_channel_) return single_channel_->Sync();
  mcap_->Close();
}

}  // namespace railcast
