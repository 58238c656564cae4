#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Messages to and from ROS 2 without ROS: over DDS, as encoded bytes, whatever they mean.

namespace railcast::dds {

/// The highest domain: the ports of higher ones would be above 65535.
inline constexpr std::uint32_t kMaxDomain = 232;

/// A domain and how to take part in it.
struct ParticipantSpec {
  std::uint32_t domain = 0;  ///< ROS 2's ROS_DOMAIN_ID.
  /// Name or address of the network interface through which all traffic goes, by IPv6 if the
  /// address is one; empty = loopback, without multicast.
  std::string interface {};
  /// Whether every reader has room for a whole message in the buffer of its socket (1 MiB or more),
  /// so that messages are sent at once. If not, all but the first 100 kB of a message are sent when
  /// a reader has asked for them, in bursts that a buffer of 208 KiB has room for.
  bool has_large_buffers = false;
  std::string node{};  ///< Name of the ROS node that owns the topics.
};

/// A topic and its type.
struct TopicSpec {
  std::string name;         ///< As ROS writes it: "/front/points".
  std::string type;         ///< As DDS writes it: "sensor_msgs::msg::dds_::PointCloud2_".
  std::string hash{};       ///< REP-2016's: "RIHS01_" and 64 hex digits; empty = not known.
  bool is_latched = false;  ///< Whether a reader that comes late gets the last message.
};

/// The messages that a writer or a reader of a topic keeps; of a latched one it is the last alone.
inline constexpr int kDepth = 20;
/// What a reader of ours takes of one message. The rest of a longer one is left out: the messages
/// that we read are shorter, so that it is refused when it is decoded.
inline constexpr std::size_t kMaxTaken_bytes = 65'536;

/// A participant of a domain with its writers and readers, which are reliable and speak version 1
/// of plain CDR, as ROS 2 does. Thread-safe, but for the adding of topics.
///
/// A reader that is slow, has stopped or has died never delays a writer: each writer keeps the last
/// kDepth messages, and what is older is lost to readers that have not fetched it yet.
class Participant {
 public:
  virtual ~Participant() = default;

  /// @return The writer's number, from 0.
  /// @throws InputError if it cannot be made, as with another type on the same topic.
  [[nodiscard]] virtual std::size_t AddWriter(const TopicSpec& topic) = 0;
  /// @return The reader's number, from 0.
  /// @throws InputError as AddWriter() does.
  [[nodiscard]] virtual std::size_t AddReader(const TopicSpec& topic) = 0;
  /// Tells ROS 2 which node the topics belong to; to be called once they are all added.
  virtual void Announce() = 0;

  /// Sends a message to all readers of the topic. Never waits.
  /// @param cdr With CDR's header of four bytes.
  /// @return Whether it was taken.
  [[nodiscard]] virtual bool Write(std::size_t writer, std::span<const std::byte> cdr) = 0;
  /// Returns the next message that has arrived, if any, of the last kDepth.
  [[nodiscard]] virtual std::optional<std::vector<std::byte>> Take(std::size_t reader) = 0;
  /// Waits until a message has arrived that was not taken, at most this long.
  virtual void WaitForMessage(std::size_t reader, int timeout_ms) = 0;
  /// Returns how many readers a writer has at present.
  [[nodiscard]] virtual std::size_t NumReaders(std::size_t writer) const = 0;

  /// Waits until every reader has received all messages, at most this long.
  virtual void WaitForReaders(int timeout_ms) = 0;
};

/// Joins a domain. A process joins a domain once at a time.
/// @throws InputError "rule (got value)" if this program was built without Cyclone DDS, if there is
///   no such interface, or if the domain cannot be joined.
[[nodiscard]] std::unique_ptr<Participant> Join(const ParticipantSpec& spec);

/// Whether ROS 2 accepts this as the full name of a topic: "/" and names of letters, digits and _,
/// none of which begins with a digit, with "/" between them.
[[nodiscard]] bool IsTopicName(std::string_view name);

}  // namespace railcast::dds
