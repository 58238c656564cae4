#include "core/io/recording/turn_reader.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

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

bool TurnReader::TakePacket(std::span<const char> packet, std::vector<SensorTurn>& turns) {
  const auto refusal =
      std::visit([&](auto& decoder) { return decoder.Decode(packet, turns); }, sensor_.decoder);
  const bool is_damaged = refusal == kWrongChecksum;
  num_damaged_ += is_damaged ? 1 : 0;
  return !refusal || is_damaged;
}

std::size_t TurnReader::Take(const CapturedDatagram& datagram, std::deque<SensorTurn>& turns) {
  std::vector<SensorTurn> completed;
  std::span<const char> rest = datagram.payload;
  std::size_t num_packets = 0;
  while (!rest.empty()) {
    const std::size_t size = std::min(rest.size(), sensor_.packet_size);
    // A packet that the decoder refuses leaves it unchanged.
    const bool is_ours = TakePacket(rest.first(size), completed);
    if (++num_packets == 1 && !is_ours) break;
    if (size < sensor_.packet_size) {
      throw InputError(source_ + ": packet " + NumberText(datagram.packet) +
                       ": must hold whole packets of " + sensor_.name + ", of " +
                       NumberText(sensor_.packet_size) + " bytes each (got " +
                       NumberText(datagram.payload.size()) + " bytes)");
    }
    rest = rest.subspan(size);
  }
  MoveTurns(completed, turns);
  return num_packets;
}

void TurnReader::End(std::deque<SensorTurn>& turns) {
  std::vector<SensorTurn> last;
  std::visit([&](auto& decoder) { last.push_back(decoder.TakeUnfinished()); }, sensor_.decoder);
  MoveTurns(last, turns);
}

}  // namespace railcast
