#include "generator/insert/packets/bag_packet_editor.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {

BagPacketEditor::BagPacketEditor(const CaptureSensor& sensor,
                                 PacketsOfMessage packets_of,
                                 std::string source)
    : turns_(sensor, source), packets_of_(packets_of), source_(std::move(source)) {}

void BagPacketEditor::Take(const bag::BagMessage& message) {
  const auto packets = AtPlace(source_ + ": message " + NumberText(num_messages_++) + ": ",
                               [&] { return packets_of_(message); });
  HeldMessage held{
      .message = {.place = message.place, .data = {message.data.begin(), message.data.end()}},
      .first_datagram = num_datagrams_,
      .places = {}};
  for (const MessagePacket& packet : packets) {
    held.places.push_back(packet.place);
    turns_.Take({.payload = packet.payload,
                 .time_ns = packet.time_ns,
                 .packet = static_cast<std::size_t>(num_datagrams_++)});
  }
  held_.push_back(std::move(held));
}

void BagPacketEditor::Edit(const InsertedFrame& inserted) {
  for (const EditedPacket& packet : turns_.Edit(inserted)) {
    // The last message that begins at this datagram or before it, and has any.
    auto held = std::ranges::upper_bound(held_, packet.datagram, {}, &HeldMessage::first_datagram);
    --held;
    const std::size_t place = held->places.at(packet.datagram - held->first_datagram);
    const auto bytes = std::as_bytes(std::span(packet.after));
    std::ranges::copy(
        bytes, held->message.data.begin() + static_cast<std::ptrdiff_t>(place + packet.offset));
    held->message.is_edited = true;
  }
}

std::optional<EditedMessage> BagPacketEditor::Release() {
  if (held_.empty()) return std::nullopt;
  const HeldMessage& first = held_.front();
  if (first.first_datagram + first.places.size() > turns_.first_open_datagram())
    return std::nullopt;
  return ReleaseLast();
}

std::optional<EditedMessage> BagPacketEditor::ReleaseLast() {
  if (held_.empty()) return std::nullopt;
  EditedMessage message = std::move(held_.front().message);
  held_.pop_front();
  return message;
}

}  // namespace railcast
