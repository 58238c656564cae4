#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/io/net/udp_receiver.h"
#include "core/scenario/command.h"

namespace railcast {

/// A command that a peer wants done.
struct CommandRequest {
  Endpoint from;
  CommandTag tag;
  Command command;
};

/// Hears commands on a UDP port, one JSON object a line, and answers each with a line of its own.
///
/// Datagrams get lost and come twice. Whoever gives a command a session and an id may therefore
/// send the same line again until it is answered: it is done once, and answered each time. Another
/// line with the same session and id is a fault: no answer is ever that to another command. The
/// channel remembers the last kMaxAnswers ids of all peers' ports.
///
/// Answers are never read as commands, whoever sends them back: two ports that answer each other,
/// or one that answers itself, since somebody forged a sender, would never end.
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
  /// Lines that are answers, dropped without one.
  [[nodiscard]] std::uint64_t num_answers() const;

 private:
  struct Answer {
    Endpoint to;
    CommandTag tag;
    std::string line;                 ///< That is answered.
    std::optional<std::string> text;  ///< Absent while the command waits.
  };

  void Listen();
  void HearDatagram(std::string_view text, const Endpoint& from);
  void Hear(std::string_view text, const CommandLine& line, const Endpoint& from);
  /// Whether the peer sent this tag before; then it is answered as it was, or that the line is
  /// another one.
  [[nodiscard]] bool IsRepeated(std::string_view text, const CommandTag& tag, const Endpoint& from);
  [[nodiscard]] std::deque<Answer>::iterator Find(const Endpoint& to, const CommandTag& tag);
  /// Answers a command that waited.
  void Send(const CommandRequest& request, const std::string& text);
  void Remember(Answer answer);

  UdpReceiver receiver_;
  Endpoint peer_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<CommandRequest> requests_;
  std::deque<Answer> answers_;
  std::uint64_t num_strangers_ = 0;
  std::uint64_t num_answers_ = 0;
  std::thread thread_;
};

}  // namespace railcast
