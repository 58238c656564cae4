#include "generator/live/sensor_stream.h"

#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/stream/stream_encoder.h"
#include "core/io/velodyne/velodyne_encoder.h"
#include "core/scenario/sensors.h"
#include "railcast/scenario.h"

namespace railcast {

SensorStream::SensorStream(SensorStreamSpec spec,
                           const ScenarioSpec& scenario,
                           const ScanPattern& pattern,
                           std::uint32_t run)
    : spec_(std::move(spec)),
      lidar_(scenario.lidar),
      output_(scenario.output),
      pattern_(pattern),
      encoder_(MakeEncoder(run)) {
  if (!spec_.to.empty()) {
    sender_ = AtPlace("receivers of " + spec_.name + ": ", [&] {
      return std::make_unique<UdpSender>(spec_.to, kVelodynePositionPort, spec_.has_offload);
    });
  }
  if (spec_.pcap) {
    capture_ = std::make_unique<PcapWriter>(*spec_.pcap, DefaultPort(spec_.protocol),
                                            kVelodynePositionPort);
  }
}

std::unique_ptr<FrameEncoder> SensorStream::MakeEncoder(std::uint32_t run) const {
  if (spec_.protocol != Protocol::kRailcast) {
    return MakeVelodyneEncoder(NameOf(spec_.protocol), lidar_.scan, lidar_.receiver.return_mode);
  }
  return std::make_unique<StreamEncoder>(pattern_, StreamSpec{.fields = spec_.fields,
                                                              .has_all_slots = spec_.has_all_slots,
                                                              .output = output_,
                                                              .sensor = spec_.sensor,
                                                              .run = run});
}

void SensorStream::Restart(std::uint32_t run) {
  encoder_ = MakeEncoder(run);
}

void SensorStream::Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items) {
  if (sender_) sender_->Send(datagrams, items);
  UseCapture([&](PcapWriter& capture) {
    capture.Write(datagrams, items);
    num_captured_ += items.size();
  });
}

void SensorStream::Finish() {
  UseCapture([](PcapWriter& capture) { capture.Finish(); });
}

template <typename Work>
void SensorStream::UseCapture(const Work& work) {
  if (!capture_) return;
  try {
    work(*capture_);
  } catch (const InputError& error) {
    const std::lock_guard lock(mutex_);
    capture_fault_ = std::string(error.what()) + "; the capture ends after " +
                     std::to_string(num_captured_) + " datagrams, in " +
                     ShownPath(capture_->unfinished());
    capture_.reset();
  }
}

std::optional<std::string> SensorStream::capture_fault() const {
  const std::lock_guard lock(mutex_);
  return capture_fault_;
}

UdpSender::Counts SensorStream::delivered() const {
  return sender_ ? sender_->counts() : UdpSender::Counts{};
}

}  // namespace railcast
