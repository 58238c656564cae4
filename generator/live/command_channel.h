#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/io/net/udp_receiver.h"
#include "core/scenario/command.h"

namespace railcast {

/// A command that a peer wants done.
struct CommandRequest {
  Endpoint from;
  std::optional<std::uint64_t> id;
  Command command;
};

/// Hears commands on a UDP port, one JSON object a line, and answers each with a line of its own.
///
/// Datagrams get lost and come twice. Whoever gives a command an id may therefore send it again
/// until it is answered: it is done once, and answered each time. The channel remembers the last
/// kMaxAnswers ids of all peers' ports.
class CommandChannel {
 public:
  static constexpr std::size_t kMaxAnswers = 256;
  /// More that wait are refused.
  static constexpr std::size_t kMaxRequests = 1024;
  /// A datagram of more lines is refused as a whole, with one answer: so it keeps nobody busy, and
  /// whoever forges its sender makes no flood of answers.
  static constexpr std::size_t kMaxLines = 64;

  /// @param peer Whose commands are heard: an address, of any port where that is 0. What others
  ///   send is dropped without an answer.
  /// @throws InputError if `at` cannot be listened at.
  CommandChannel(const Endpoint& at, const Endpoint& peer);
  ~CommandChannel();
  CommandChannel(const CommandChannel&) = delete;
  CommandChannel& operator=(const CommandChannel&) = delete;

  [[nodiscard]] const Endpoint& at() const { return receiver_.at(); }

  /// The next request, waiting for it at longest so long; 0 does not wait.
  [[nodiscard]] std::optional<CommandRequest> Next(int timeout_ms);

  /// Says that a command took effect, and at which simulation time.
  void Acknowledge(const CommandRequest& request, std::int64_t time_ns);
  /// Says why it did not.
  void Refuse(const CommandRequest& request, const std::vector<std::string>& faults);

  /// Datagrams of others than the peer.
  [[nodiscard]] std::uint64_t num_strangers() const;

 private:
  struct Answer {
    Endpoint to;
    std::uint64_t id{};
    std::optional<std::string> text;  ///< Absent while the command waits.
  };

  void Listen();
  void Hear(const CommandLine& line, const Endpoint& from);
  /// Whether the peer sent this id before; then it is answered as it was.
  [[nodiscard]] bool IsRepeated(const Endpoint& from, std::uint64_t id);
  void Send(const Endpoint& to, std::optional<std::uint64_t> id, const std::string& text);
  void Remember(const Endpoint& to, std::uint64_t id, std::optional<std::string> text);

  UdpReceiver receiver_;
  Endpoint peer_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<CommandRequest> requests_;
  std::deque<Answer> answers_;
  std::uint64_t num_strangers_ = 0;
  std::thread thread_;
};

}  // namespace railcast
