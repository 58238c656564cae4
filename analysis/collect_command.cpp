#include <chrono>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "analysis/commands.h"
#include "analysis/detectors/reported_detections.h"
#include "core/io/net/udp.h"
#include "core/io/stream/arrivals.h"
#include "core/io/unfinished_file.h"
#include "core/io/write_file.h"
#include "core/program/progress_line.h"
#include "core/program/stop_signals.h"

namespace railcast {
namespace {

constexpr std::uint16_t kDetectionsPort = 27402;

struct CollectOptions {
  ListenOptions listen{.at = "127.0.0.1:" + NumberText(kDetectionsPort)};
  std::filesystem::path out;
};

std::optional<Endpoint> WantedSender(const CollectOptions& options) {
  if (!options.listen.from) return std::nullopt;
  return AtPlace("--from: ", [&] { return ParseEndpoint(*options.listen.from, 0); });
}

/// Lines are appended to the unfinished file as they come, so that they are there however the
/// program ends.
class Collecting {
 public:
  explicit Collecting(const CollectOptions& options)
      : options_(options), sender_(WantedSender(options)) {}

  /// Takes datagrams until there are enough or the time is over.
  void Run(UdpReceiver& receiver) {
    const ProgressLine progress;
    bool is_over = false;
    while (lines_.num_frames() < num_wanted_) {
      is_over = is_over || StopRequested() || std::chrono::steady_clock::now() >= end_;
      // What had arrived by then is still taken.
      const auto received = receiver.Receive(is_over ? 0 : kPatience_ms);
      if (!received && is_over) break;
      if (!received) continue;
      Take(*received);
      progress.Show(NumberText(lines_.num_frames()) + " frames");
    }
    progress.End();
  }

  /// Gives the file its name, with the lines in their order.
  void Finish() const {
    if (!file_) return;
    file_->Overwrite(0, lines_.Text());
    file_->Finish();
  }

  [[nodiscard]] std::string Summary() const {
    std::string text = lines_.Summary() + "\n";
    if (!stranger_) return text;
    return text + "datagrams of other senders: " + NumberText(num_strangers_) +
           ", dropped; the last from " + EndpointText(*stranger_) + "\n";
  }
  [[nodiscard]] bool has_lines() const { return file_.has_value(); }

 private:
  // The longest time until a run notices that it was stopped.
  static constexpr int kPatience_ms = 20;

  [[nodiscard]] static std::chrono::steady_clock::time_point EndAfter(
      std::optional<double> duration_s) {
    if (!duration_s) return std::chrono::steady_clock::time_point::max();
    return std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::nanoseconds>(
                                                  std::chrono::duration<double>(*duration_s));
  }

  void Take(const UdpReceiver::Received& received) {
    const std::chrono::nanoseconds now = std::chrono::steady_clock::now().time_since_epoch();
    const DatagramOrigin origin = {.from = received.from, .time_ns = now.count()};
    if (sender_.IsAnother(origin)) {
      ++num_strangers_;
      stranger_ = received.from;
      return;
    }
    const std::string line =
        lines_.Take({received.bytes.data(), received.bytes.size()}, EndpointText(received.from));
    static_cast<void>(sender_.Follow(origin));
    if (line.empty()) return;
    if (!file_) file_.emplace(options_.out, 0);
    file_->Append(std::as_bytes(std::span(line)));
  }

  const CollectOptions& options_;
  FollowedSender sender_;
  std::uint64_t num_wanted_ =
      options_.listen.num_frames.value_or(std::numeric_limits<std::uint64_t>::max());
  std::chrono::steady_clock::time_point end_ = EndAfter(options_.listen.duration_s);
  CollectedLines lines_;
  std::optional<UnfinishedFile> file_;  ///< From the first line on.
  std::uint64_t num_strangers_ = 0;
  std::optional<Endpoint> stranger_;  ///< The last of these.
};

// What a collection left that was killed would be lost.
void RefuseKeptLines(const std::filesystem::path& out) {
  const std::filesystem::path kept = FileToReplace(out).string() + std::string(kUnfinishedSuffix);
  if (!std::filesystem::exists(kept)) return;
  throw InputError(ShownPath(kept) +
                   ": holds the lines of a collection that was killed; move it away");
}

int RunCollect(const CollectOptions& options) {
  RefuseKeptLines(options.out);
  CheckCanWrite(options.out);
  Collecting collecting(options);
  UdpReceiver receiver(ParseEndpoint(options.listen.at, kDetectionsPort));
  CatchStopSignals();
  std::cout << "listening at " << EndpointText(receiver.at()) << std::endl;
  ErrorList faults;
  static_cast<void>(Attempt("", faults, [&] { return collecting.Run(receiver), true; }));
  collecting.Finish();
  std::cout << collecting.Summary() << std::flush;
  faults.ThrowIfAny();
  // An empty file would say that nothing was detected in any frame.
  if (!collecting.has_lines()) {
    throw InputError({{EndpointText(receiver.at()), "must be sent a line for each frame", "none"}});
  }
  return kExitSuccess;
}

}  // namespace

void AddCollect(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<CollectOptions>();
  ProgramOptions collect = app.AddCommand(
      "collect",
      "Listen to your object detector, which sends a datagram for each frame of a live stream, and "
      "write its detections as a file for evaluate; until Ctrl-C");
  AddListenOptions(collect, options->listen);
  collect
      .AddOption("--out", options->out,
                 "File to write: JSON lines (docs/evaluate.md); until the end FILE.part")
      .Required()
      .Check(NonEmpty());
  collect.WhenParsed([&command, options] {
    command = [options](const std::string&) { return RunCollect(*options); };
  });
}

}  // namespace railcast
