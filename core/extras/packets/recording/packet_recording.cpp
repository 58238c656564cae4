#include "core/extras/packets/recording/packet_recording.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/scenario/sensors.h"

namespace railcast {
namespace {

std::uint16_t PortOf(const CapturedDatagram& datagram, const CaptureSensor& sensor) {
  if (datagram.destination_port != 0) return datagram.destination_port;
  const bool is_ouster = std::holds_alternative<OusterDecoder>(sensor.decoder);
  return is_ouster ? kOusterLidarPort : kVelodyneDataPort;
}

}  // namespace

PacketRecording::PacketRecording(DatagramPlace place)
    : place_(std::move(place)),
      sensors_(FindSensors(place_)),
      turn_reader_(place_.sensor ? FindSensor(place_) : sensors_.front(), source()),
      source_(place_.open()),
      finder_(place_.beside) {
  FindFirstSender();
}

bool PacketRecording::IsWanted(const CapturedDatagram& datagram) const {
  if (!place_.sensor) return true;
  const SenderStream stream = StreamOf(datagram);
  const auto& wanted = turn_reader_.sensor().streams;
  if (stream.from.address != wanted.front().from.address) return false;
  return std::ranges::count(wanted, stream) > 0 ||
         std::ranges::none_of(sensors_, [&](const CaptureSensor& sensor) {
           return std::ranges::count(sensor.streams, stream) > 0;
         });
}

void PacketRecording::FindFirstSender() {
  const auto datagrams = place_.open();
  while (const auto datagram = datagrams->Next()) {
    const CaptureSensor& first = turn_reader_.sensor();
    if (std::ranges::count(first.streams, StreamOf(*datagram)) == 0) continue;
    if (!finder_.Look(datagram->payload)) continue;
    senders_.push_back({datagram->source_address, first.packet_size});
    port_ = PortOf(*datagram, first);
    return;
  }
}

std::size_t PacketRecording::PacketSizeOf(const CapturedDatagram& datagram) {
  if (!IsWanted(datagram)) return 0;
  const auto known = std::ranges::find(senders_, datagram.source_address, &Sender::address);
  if (known != senders_.end()) return known->packet_size;
  const auto sensor = finder_.Look(datagram.payload);
  if (!sensor) return 0;
  senders_.push_back({datagram.source_address, sensor->packet_size});
  return sensor->packet_size;
}

void PacketRecording::Take(const CapturedDatagram& datagram, std::size_t packet_size) {
  std::span<const char> rest = datagram.payload;
  // Reports are smaller than a packet of points, and none is as long as several of these.
  const std::size_t step = rest.size() % packet_size == 0 ? packet_size : rest.size();
  const std::uint16_t port = PortOf(datagram, turn_reader_.sensor());
  while (!rest.empty()) {
    const std::span<const char> one = rest.first(step);
    rest = rest.subspan(step);
    datagrams_.push_back({{one.begin(), one.end()}, port, datagram.time_ns});
    CapturedDatagram captured = datagram;
    captured.payload = one;
    turn_reader_.Take(captured, &turns_);
  }
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

void PacketRecording::PublishRemarks() const {
  for (const Remark& remark : source_->remarks()) Publish(remark);
  for (const Remark& remark : turn_reader_.remarks()) {
    // Others are counted here.
    if (remark.kind != RemarkKind::kOtherSenders) Publish(remark);
  }
}

std::deque<RecordedDatagram> PacketRecording::NextTurn() {
  if (fault_ && datagrams_.empty()) std::rethrow_exception(fault_);
  while (turns_.empty() && !is_at_end_ && datagrams_.size() < kMostDatagrams) {
    const auto datagram = NextDatagram();
    if (!datagram) {
      is_at_end_ = true;
      turn_reader_.End(&turns_);
      PublishRemarks();
      break;
    }
    const std::size_t packet_size = PacketSizeOf(*datagram);
    if (packet_size > 0) {
      Take(*datagram, packet_size);
    } else {
      ++num_left_out_;
    }
  }
  std::deque<RecordedDatagram> turn;
  const bool is_known = !turns_.empty();
  const std::uint64_t end =
      is_known ? turns_.front().end_datagram : first_datagram_ + datagrams_.size();
  if (is_known) turns_.pop_front();
  for (; !datagrams_.empty() && first_datagram_ <= end; ++first_datagram_) {
    turn.push_back(std::move(datagrams_.front()));
    datagrams_.pop_front();
  }
  // One datagram may end several turns.
  return turn.empty() && is_known ? NextTurn() : turn;
}

}  // namespace railcast
