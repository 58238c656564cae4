#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/extras/dds/participant.h"
#include "core/io/datagrams.h"
#include "core/io/net/udp.h"

namespace railcast {

/// Appends a message for ROS 2 in the place of a datagram.
/// @param topic Less than 65536.
void AppendMessage(std::size_t topic,
                   std::span<const std::byte> cdr,
                   std::int64_t due_ns,
                   Datagrams& datagrams);

/// The topics of ROS 2 on which a program sends messages.
class RosWriters {
 public:
  /// @param topics Their indices are Datagrams::Item::topic.
  /// @throws InputError as Participant::AddWriter() does.
  RosWriters(std::unique_ptr<dds::Participant> participant,
             const std::vector<dds::TopicSpec>& topics);

  [[nodiscard]] dds::Participant& participant() { return *participant_; }
  /// Whether a reader of the topic is known.
  [[nodiscard]] bool HasReaders(std::size_t topic) const;
  /// Sends a message at once. Returns whether it was taken.
  bool Write(std::size_t topic, std::span<const std::byte> cdr);
  /// Sends what AppendMessage() appended, and counts it.
  void Send(const Datagrams& datagrams,
            std::span<const Datagrams::Item> items,
            UdpSender::Counts& counts);
  /// Waits a second at most for readers that have not received everything.
  void Finish();

 private:
  std::unique_ptr<dds::Participant> participant_;
  std::vector<std::size_t> writers_;  ///< By topic.
};

}  // namespace railcast
