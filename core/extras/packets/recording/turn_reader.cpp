#include "core/extras/packets/recording/turn_reader.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/join.h"
#include "core/base/text.h"
#include "core/extras/packets/recording/capture_recording.h"

namespace railcast {
namespace {

void MoveTurns(std::vector<SensorTurn>& turns, std::deque<SensorTurn>& out) {
  for (SensorTurn& turn : turns) {
    if (turn.num_columns() > 0) out.push_back(std::move(turn));
  }
}

}  // namespace

TurnReader::TurnReader(CaptureSensor sensor, std::string source)
    : sensor_(std::move(sensor)), source_(std::move(source)) {}

void TurnReader::CountOther(const CapturedDatagram& datagram) {
  const bool is_of_sensor = std::ranges::any_of(sensor_.streams, [&](const SenderStream& stream) {
    return stream.from.address == datagram.source_address;
  });
  if (!is_of_sensor) return others_.Count(datagram.packet);
  CountUnknown(datagram);
}

void TurnReader::CountUnknown(const CapturedDatagram& datagram) {
  // Sizes of reports of time and position, Velodyne's and Hesai's, and of motion, Ouster's.
  constexpr auto kReports = std::to_array<std::size_t>({512, kOusterImuPacketSize});
  const std::size_t size = datagram.payload.size();
  if (std::ranges::count(kReports, size) > 0) return;
  // Packets of points that come from elsewhere are those of another sensor.
  const bool is_own = std::ranges::count(sensor_.streams, StreamOf(datagram)) > 0;
  (is_own || size < sensor_.packet_size ? unknown_ : others_).Count(datagram.packet);
}

void TurnReader::CountRefused(const CapturedDatagram& datagram, const std::string& why) {
  if (why == kWrongChecksum) return damaged_.Count(datagram.packet);
  const bool has_size = datagram.payload.size() % sensor_.packet_size == 0;
  if (has_size) return refused_.Count(datagram.packet, 1, why);
  CountUnknown(datagram);
}

void TurnReader::Take(const CapturedDatagram& datagram,
                      std::deque<SensorTurn>* turns,
                      std::deque<OrderedPacket>* decoded) {
  const std::uint64_t number = num_datagrams_++;
  const auto& streams = sensor_.streams;
  if (!streams.empty() && std::ranges::count(streams, StreamOf(datagram)) == 0) {
    return CountOther(datagram);
  }
  if (datagram.has_wrong_checksum && !sensor_.ignores_checksums) {
    return damaged_.Count(datagram.packet);
  }
  if (datagram.payload.empty()) return CountUnknown(datagram);
  const std::size_t size = datagram.payload.size();
  for (std::size_t offset = 0; offset < size; offset += sensor_.packet_size) {
    const auto packet =
        datagram.payload.subspan(offset, std::min(sensor_.packet_size, size - offset));
    const auto refusal =
        std::visit([&](const auto& decoder) { return decoder.Refuse(packet); }, sensor_.decoder);
    if (!refusal && offset == 0 && size % sensor_.packet_size != 0) {
      refused_.Count(
          datagram.packet, size / sensor_.packet_size,
          "must be whole packets of " + NumberText(sensor_.packet_size) + " bytes" + Got(size));
      break;
    }
    if (refusal) CountRefused(datagram, *refusal);
    if (refusal && offset == 0 && *refusal != kWrongChecksum) break;
    if (refusal || packet.size() < sensor_.packet_size) continue;
    ++num_taken_;
    order_.Add(
        {.bytes = {packet.begin(), packet.end()},
         .places = {{number, offset}},
         .number = datagram.packet,
         .captured_ns = datagram.time_ns},
        std::visit([&](const auto& decoder) { return decoder.MarkOf(packet); }, sensor_.decoder));
  }
  Decode(turns, decoded);
}

void TurnReader::Decode(std::deque<SensorTurn>* turns, std::deque<OrderedPacket>* decoded) {
  while (auto packet = order_.Next()) {
    if (turns == nullptr) continue;
    std::vector<SensorTurn> completed;
    std::visit([&](auto& decoder) { decoder.TakePacket(packet->bytes, completed); },
               sensor_.decoder);
    for (SensorTurn& turn : completed) turn.end_datagram = packet->places.front().datagram;
    MoveTurns(completed, *turns);
    if (const auto* const spinning = std::get_if<SpinningDecoder>(&sensor_.decoder)) {
      empty_blocks_.Count(packet->number, spinning->NumEmptyBlocks(packet->bytes));
      incomplete_.Count(packet->number, spinning->num_incomplete() - incomplete_.number,
                        "the rest of its firing cycle is missing");
    }
    if (decoded != nullptr) decoded->push_back(std::move(*packet));
  }
}

void TurnReader::End(std::deque<SensorTurn>* turns, std::deque<OrderedPacket>* decoded) {
  order_.End();
  Decode(turns, decoded);
  if (turns == nullptr) return;
  std::vector<SensorTurn> last;
  std::visit([&](auto& decoder) { last.push_back(decoder.TakeUnfinished()); }, sensor_.decoder);
  last.front().end_datagram = num_datagrams_;
  MoveTurns(last, *turns);
}

PacketTally TurnReader::lost() const {
  PacketTally lost = order_.lost();
  lost.number -= std::min(lost.number, damaged_.number + refused_.number + order_.late().number);
  return lost;
}

std::vector<Remark> TurnReader::remarks() const {
  std::vector<Remark> remarks;
  const auto add = [&](RemarkKind kind, const PacketTally& tally) {
    AddRemark({.kind = kind,
               .place = source_ + ": packet " + NumberText(tally.first),
               .number = tally.number,
               .detail = tally.detail},
              remarks);
  };
  add(RemarkKind::kPacketsLost, lost());
  add(RemarkKind::kPacketsDoubled, order_.doubled());
  add(RemarkKind::kPacketsLate, order_.late());
  add(RemarkKind::kPacketsReordered, order_.reordered());
  add(RemarkKind::kPacketsDamaged, damaged_);
  add(RemarkKind::kPacketsRefused, refused_);
  add(RemarkKind::kPacketsRefused, incomplete_);
  add(RemarkKind::kBlocksEmpty, empty_blocks_);
  add(RemarkKind::kOtherSenders, others_);
  add(RemarkKind::kDatagramsUnknown, unknown_);
  return remarks;
}

std::vector<TurnReader> CountPackets(const DatagramPlace& place) {
  std::vector<TurnReader> readers;
  for (CaptureSensor& sensor : FindSensors(place)) {
    readers.emplace_back(std::move(sensor), ShownPath(place.source));
  }
  const auto datagrams = place.open();
  while (const auto datagram = datagrams->Next()) {
    for (TurnReader& reader : readers) reader.Take(*datagram, nullptr);
  }
  for (TurnReader& reader : readers) reader.End(nullptr);
  return readers;
}

std::string PortsText(const CaptureSensor& sensor) {
  std::vector<std::uint16_t> ports;
  for (const SenderStream& stream : sensor.streams) ports.push_back(stream.to.port);
  std::ranges::sort(ports);
  const auto repeated = std::ranges::unique(ports);
  ports.erase(repeated.begin(), repeated.end());
  return Join(ports, ", ", NumberText<std::uint16_t>);
}

}  // namespace railcast
