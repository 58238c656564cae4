#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/io/net/udp.h"
#include "core/io/run/run_folder.h"
#include "core/scenario/command.h"
#include "generator/live/live_run.h"
#include "generator/run/frame_maker.h"
#include "railcast/io/stream.h"

namespace railcast {

/// A command that a peer asks for.
struct CommandRequest {
  Endpoint from;
  CommandTag tag;
  Command command;
};

/// Where a live run gets its commands from.
class CommandSource {
 public:
  virtual ~CommandSource() = default;

  /// Returns the next request, waiting up to `timeout_ms` for it where the source can wait; 0 does
  /// not wait.
  [[nodiscard]] virtual std::optional<CommandRequest> Next(int timeout_ms) = 0;

  /// Answers that a command took effect, and at which simulation time.
  virtual void Acknowledge(const CommandRequest& request, std::int64_t time_ns) = 0;
  /// Answers why a command was refused.
  virtual void Refuse(const CommandRequest& request, const std::vector<std::string>& faults) = 0;
};

/// Receives commands on a UDP port, one JSON object per line, and answers each with a line.
///
/// Datagrams may be lost or duplicated. A sender that gives a command a session and an id may
/// therefore send the same line again until it is answered: the command takes effect once, and
/// every copy is answered. A different line with the same session and id is a fault, so that no
/// answer can be mistaken for that to another command. The channel remembers the last kMaxAnswers
/// ids of all peers' ports.
///
/// Answers that come back are never read as commands. Otherwise two ports that answer each other,
/// or one that answers itself, would never stop once a sender address was forged.
class CommandChannel final : public CommandSource {
 public:
  static constexpr std::size_t kMaxAnswers = 256;
  /// Further requests are refused while this many are waiting.
  static constexpr std::size_t kMaxRequests = 1024;
  /// A datagram with more lines is refused as a whole, with one answer, so that it cannot occupy
  /// the channel and a forged sender address does not cause a flood of answers.
  static constexpr std::size_t kMaxLines = 64;

  /// @param peer Address whose commands are accepted, from any port if its port is 0. Datagrams
  ///   from other addresses are dropped without an answer.
  /// @param models As for ReadCommand().
  /// @throws InputError if the channel cannot listen at `at`.
  CommandChannel(const Endpoint& at, const Endpoint& peer, std::vector<ModelSpec> models = {});
  ~CommandChannel() override;
  CommandChannel(const CommandChannel&) = delete;
  CommandChannel& operator=(const CommandChannel&) = delete;

  [[nodiscard]] const Endpoint& at() const { return receiver_.at(); }

  [[nodiscard]] std::optional<CommandRequest> Next(int timeout_ms) override;
  void Acknowledge(const CommandRequest& request, std::int64_t time_ns) override;
  void Refuse(const CommandRequest& request, const std::vector<std::string>& faults) override;

  /// Number of datagrams from addresses other than the peer's.
  [[nodiscard]] std::uint64_t num_strangers() const;
  /// Number of lines that were answers and were therefore dropped.
  [[nodiscard]] std::uint64_t num_answers() const;

 private:
  struct Answer {
    Endpoint to;
    CommandTag tag;
    std::string line;                 ///< The line that is answered.
    std::optional<std::string> text;  ///< Absent while the command is waiting.
  };

  void Listen();
  void HearDatagram(std::string_view text, const Endpoint& from);
  void Hear(std::string_view text, const CommandLine& line, const Endpoint& from);
  /// Whether the peer has sent this tag before. If so, the earlier answer is repeated, or the line
  /// is refused because it differs.
  [[nodiscard]] bool IsRepeated(std::string_view text, const CommandTag& tag, const Endpoint& from);
  [[nodiscard]] std::deque<Answer>::iterator Find(const Endpoint& to, const CommandTag& tag);
  /// Answers a command that was waiting.
  void Send(const CommandRequest& request, const std::string& text);
  void Remember(Answer answer);

  UdpReceiver receiver_;
  Endpoint peer_;
  std::vector<ModelSpec> models_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<CommandRequest> requests_;
  std::deque<Answer> answers_;
  std::uint64_t num_strangers_ = 0;
  std::uint64_t num_answers_ = 0;
  std::thread thread_;
};

/// Applies the commands of all sources to a run and logs them.
class CommandLoop {
 public:
  static constexpr int kMaxPerFrame = 16;

  /// @param sources Asked in this order.
  /// @param lockstep Whether frames wait for a `step` of the first source; what the others said
  ///   before it holds for the frames that it lets come.
  /// @param log_file File for the log that `sequence --commands` replays, if any.
  /// @param scenario_xxh3 Hash of the scenario that the log is for.
  /// @throws InputError if the log already exists or cannot be written.
  CommandLoop(FrameMaker& maker,
              std::vector<CommandSource*> sources,
              bool lockstep,
              const std::optional<std::filesystem::path>& log_file,
              const std::string& scenario_xxh3);

  /// Applies waiting commands to the frames that begin at this time, at most kMaxPerFrame so that a
  /// flood of commands cannot delay them; in lockstep, waits for a step.
  [[nodiscard]] NextFrames BeginFrames(std::int64_t stamp_ns,
                                       const std::function<bool()>& is_stopped);
  /// Answers the step that made these frames.
  void EndFrames(std::int64_t stamp_ns);
  /// Refuses all waiting commands when the run has ended, and ends the log.
  void End(const std::string& reason);
  /// Why the log ends early; absent while it does not.
  [[nodiscard]] const std::optional<std::string>& log_fault() const { return log_fault_; }

 private:
  struct Waiting {
    CommandSource* source;
    CommandRequest request;
  };
  /// Returns the next request; waits for one of the first source if there is none. While a step is
  /// under way, its source is not asked.
  [[nodiscard]] std::optional<Waiting> NextOf(int timeout_ms);
  [[nodiscard]] bool IsStep(const Waiting& waiting) const;
  /// @return Whether the command was a reset.
  [[nodiscard]] bool Handle(const Waiting& waiting, std::int64_t stamp_ns);
  /// Appends to the log, which ends if that fails: the run goes on without it.
  void Log(const std::string& line);

  FrameMaker& maker_;
  std::vector<CommandSource*> sources_;
  bool lockstep_;
  std::optional<LineFile> log_;
  std::size_t num_logged_ = 0;
  std::optional<std::string> log_fault_;
  std::optional<Waiting> step_;  ///< The step under way.
};

}  // namespace railcast
