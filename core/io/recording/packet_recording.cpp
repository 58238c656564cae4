#include "core/io/recording/packet_recording.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/scenario/sensors.h"

namespace railcast {
namespace {

/// The datagrams of one sender.
class DatagramsOfSender final : public DatagramSource {
 public:
  DatagramsOfSender(std::unique_ptr<DatagramSource> all, const IpAddress& sender)
      : all_(std::move(all)), sender_(sender) {}

  [[nodiscard]] std::optional<CapturedDatagram> Next() override {
    while (auto datagram = all_->Next()) {
      if (datagram->source_address == sender_) return datagram;
    }
    return std::nullopt;
  }
  [[nodiscard]] std::size_t num_torn() const override { return all_->num_torn(); }

 private:
  std::unique_ptr<DatagramSource> all_;
  IpAddress sender_;
};

DatagramPlace OfSender(DatagramPlace place, const std::optional<IpAddress>& sender) {
  if (!sender) return place;
  place.open = [all = place.open, sender = *sender] {
    return std::make_unique<DatagramsOfSender>(all(), sender);
  };
  return place;
}

std::uint16_t PortOf(const CapturedDatagram& datagram, const CaptureSensor& sensor) {
  if (datagram.destination_port != 0) return datagram.destination_port;
  const bool is_ouster = std::holds_alternative<OusterDecoder>(sensor.decoder);
  return is_ouster ? kOusterLidarPort : kVelodyneDataPort;
}

}  // namespace

PacketRecording::PacketRecording(DatagramPlace place, const std::optional<IpAddress>& sender)
    : place_(OfSender(std::move(place), sender)),
      first_(FindSensor(place_)),
      source_(place_.open()),
      finder_(place_.beside) {
  FindFirstSender();
}

void PacketRecording::FindFirstSender() {
  const auto datagrams = place_.open();
  while (const auto datagram = datagrams->Next()) {
    if (!finder_.Look(datagram->payload)) continue;
    senders_.push_back({datagram->source_address, first_.packet_size});
    port_ = PortOf(*datagram, first_);
    return;
  }
}

std::size_t PacketRecording::PacketSizeOf(const CapturedDatagram& datagram) {
  const auto known = std::ranges::find(senders_, datagram.source_address, &Sender::address);
  if (known != senders_.end()) return known->packet_size;
  const auto sensor = finder_.Look(datagram.payload);
  if (!sensor) return 0;
  senders_.push_back({datagram.source_address, sensor->packet_size});
  return sensor->packet_size;
}

bool PacketRecording::Take(const CapturedDatagram& datagram, std::size_t packet_size) {
  std::vector<SensorTurn> turns;
  std::span<const char> rest = datagram.payload;
  // Reports are smaller than a packet of points, and none is as long as several of these.
  const std::size_t step = rest.size() % packet_size == 0 ? packet_size : rest.size();
  const std::uint16_t port = PortOf(datagram, first_);
  while (!rest.empty()) {
    const std::span<const char> one = rest.first(step);
    rest = rest.subspan(step);
    datagrams_.push_back({{one.begin(), one.end()}, port, datagram.time_ns});
    if (datagram.source_address != senders_.front().address) continue;
    // Of what it refuses, the decoder uses nothing.
    std::visit([&](auto& decoder) { static_cast<void>(decoder.Decode(one, turns)); },
               first_.decoder);
  }
  return std::ranges::any_of(turns, [](const SensorTurn& turn) { return turn.num_columns() > 0; });
}

std::optional<CapturedDatagram> PacketRecording::NextDatagram() {
  try {
    return source_->Next();
  } catch (const InputError&) {
    // What was captured before is returned first.
    if (datagrams_.empty()) throw;
    fault_ = std::current_exception();
    return std::nullopt;
  }
}

std::deque<RecordedDatagram> PacketRecording::NextTurn() {
  if (fault_) std::rethrow_exception(fault_);
  bool is_whole = false;
  while (!is_whole && datagrams_.size() < kMostDatagrams) {
    const auto datagram = NextDatagram();
    if (!datagram) break;
    const std::size_t packet_size = PacketSizeOf(*datagram);
    if (packet_size > 0) {
      is_whole = Take(*datagram, packet_size);
    } else {
      ++num_left_out_;
    }
  }
  return std::exchange(datagrams_, {});
}

}  // namespace railcast
