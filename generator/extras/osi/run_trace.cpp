#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/extras/osi/sensor_view.h"
#include "core/extras/osi/trace_file.h"
#include "core/extras/ros/bag/bag.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/trace_name.h"
#include "core/io/write_file.h"
#include "generator/extras/osi/sensor_views.h"
#include "generator/run/run_extras.h"
#include "generator/run/run_plan.h"

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

/// The OSI trace of a sequence. An .osi file has its name from its begin, an MCAP file is named as
/// those of bags are.
class OsiTrace final : public SequenceTrace {
 public:
  /// @param topic Of the MCAP file's only channel.
  OsiTrace(fs::path file, std::string topic, SensorViewMaker sensor_view)
      : file_(std::move(file)), topic_(std::move(topic)), sensor_view_(std::move(sensor_view)) {}

  [[nodiscard]] std::vector<std::string> Find() override;
  std::size_t Open(std::size_t num_messages) override;
  [[nodiscard]] std::string Encode(const MadeFrame& made) const override {
    return sensor_view_(made);
  }
  void Append(std::int64_t time_ns, const std::string& message) override;
  void Close() override;

 private:
  fs::path file_;
  std::string topic_;
  SensorViewMaker sensor_view_;
  osi::TraceContent found_;
  std::optional<LineFile> single_channel_;
  std::unique_ptr<bag::BagWriter> mcap_;
  std::size_t channel_{};
};

std::vector<std::string> OsiTrace::Find() {
  found_ = {};
  try {
    if (fs::exists(file_)) {
      found_ = osi::ReadTrace(file_);
    } else if (fs::exists(UnfinishedTrace(file_))) {
      found_ = osi::ReadTrace(UnfinishedTrace(file_));
    }
  } catch (const InputError&) {
    // Of what cannot be read, nothing is there.
  }
  std::vector<std::string> hashes;
  for (const osi::TraceMessage& message : found_.messages) hashes.push_back(message.hash);
  return hashes;
}

std::size_t OsiTrace::Open(std::size_t num_messages) {
  if (file_.extension() == osi::kSingleChannel) {
    const std::uint64_t end = num_messages == 0 ? 0 : found_.messages.at(num_messages - 1).end;
    single_channel_.emplace(file_, end);
    return num_messages;
  }
  // A run may be interrupted after its last frame, before its manifest is written.
  if (fs::exists(file_)) fs::rename(file_, UnfinishedTrace(file_));
  if (num_messages == 0) fs::remove(UnfinishedTrace(file_));
  const auto trace = osi::McapTraceOf(osi::ProtobufVersion());
  constexpr auto kCompression = bag::McapCompression::kZstd;
  mcap_ = fs::exists(UnfinishedTrace(file_))
              ? bag::ContinueMcap(file_, kCompression, num_messages, trace)
              : bag::CreateMcap(file_, kCompression, trace);
  channel_ = mcap_->Add({.name = topic_,
                         .type = "osi3.SensorView",
                         .definition = osi::SensorViewDescriptors(),
                         .hash = {},
                         .is_latched = false,
                         .encoding = "protobuf"});
  return mcap_->num_commits();
}

void OsiTrace::Append(std::int64_t time_ns, const std::string& message) {
  if (single_channel_) {
    single_channel_->Append(LengthBytes(message) + message);
  } else {
    mcap_->Write({channel_, time_ns, std::as_bytes(std::span(message))});
    mcap_->Commit();
  }
}

void OsiTrace::Close() {
  if (single_channel_) return single_channel_->Sync();
  mcap_->Close();
}

void CheckTrace(const RunChoices& choices) {
  // Whether this program writes traces, and only then whether all else is right for them.
  const std::string option = "--format " + choices.format + ": ";
  AtPlace(option, [] { static_cast<void>(osi::ProtobufVersion()); });
  if (choices.fields == "all") return;
  throw InputError("--fields: OSI's are fixed, so it must be left out with --format " +
                   choices.format + " (got " + choices.fields + ")");
}

void PlanTrace(const FrameMaker& maker, std::size_t index, SensorPlan& sensor) {
  SequenceSpec& spec = sensor.spec;
  spec.trace =
      TraceName({osi::ProtobufVersion(), spec.num_frames, sensor.name, spec.files.format->trace});
  spec.make_trace = [file = spec.directory / spec.trace,
                     topic = (sensor.name.empty() ? "lidar" : sensor.name) + ".SensorView",
                     sensor_view = MakeSensorViews(maker, sensor.scenario, index)] {
    return std::make_unique<OsiTrace>(file, topic, sensor_view);
  };
}

}  // namespace

void AddOsi(RunExtras& extras) {
  extras.check_trace = CheckTrace;
  extras.plan_trace = PlanTrace;
}

}  // namespace railcast
