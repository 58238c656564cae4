#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/bag/bag.h"
#include "core/io/recording/message_packets.h"
#include "generator/insert/packets/turn_editor.h"

namespace railcast {

/// A message of the topic that is edited, and what becomes of it.
struct EditedMessage {
  bag::BagPlace place{};
  std::vector<std::byte> data;
  bool is_edited = false;
};

/// Puts the edits of frames into the messages of packets that they were read from.
class BagPacketEditor {
 public:
  /// @param source Names the bag in messages about errors.
  BagPacketEditor(const CaptureSensor& sensor, PacketsOfMessage packets_of, std::string source);

  /// Takes the next message of the topic.
  /// @throws InputError "bag: message 3: rule (got value)" if it is damaged.
  void Take(const bag::BagMessage& message);
  /// Says that there are no further messages.
  void End() { turns_.End(); }

  /// As of TurnEditor.
  [[nodiscard]] bool Has(std::uint32_t turn) const { return turns_.Has(turn); }
  void Skip(std::uint32_t turn) { turns_.Skip(turn); }
  void Edit(const InsertedFrame& inserted);

  /// Returns the next message if no further edit concerns it.
  [[nodiscard]] std::optional<EditedMessage> Release();
  /// Returns the next message in any case; nothing if there is none.
  [[nodiscard]] std::optional<EditedMessage> ReleaseLast();

 private:
  struct HeldMessage {
    EditedMessage message;
    std::uint64_t first_datagram{};
    std::vector<std::size_t> places;  ///< Of its datagrams.
  };

  TurnEditor turns_;
  PacketsOfMessage packets_of_;
  std::string source_;
  std::deque<HeldMessage> held_;
  std::uint64_t num_messages_{};
  std::uint64_t num_datagrams_{};
};

}  // namespace railcast
