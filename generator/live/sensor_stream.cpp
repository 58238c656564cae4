#include "generator/live/sensor_stream.h"

#include <utility>

#include "core/base/attempt.h"
#include "core/io/stream/stream_encoder.h"
#include "core/io/velodyne/velodyne_encoder.h"
#include "core/io/velodyne/velodyne_packet.h"
#include "core/scenario/scenario.h"

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
    sender_ = AtPlace("receivers of " + spec_.name + ": ",
                      [&] { return std::make_unique<UdpSender>(spec_.to, kVelodynePositionPort); });
  }
  if (spec_.pcap) {
    capture_ = std::make_unique<PcapWriter>(*spec_.pcap, DefaultPort(spec_.protocol),
                                            kVelodynePositionPort);
  }
}

std::unique_ptr<FrameEncoder> SensorStream::MakeEncoder(std::uint32_t run) const {
  if (spec_.protocol != "railcast") {
    return MakeVelodyneEncoder(spec_.protocol, lidar_.scan, lidar_.receiver.return_mode);
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
  if (capture_) capture_->Write(datagrams, items);
}

void SensorStream::Finish() {
  if (capture_) capture_->Finish();
}

UdpSender::Counts SensorStream::delivered() const {
  return sender_ ? sender_->counts() : UdpSender::Counts{};
}

}  // namespace railcast
