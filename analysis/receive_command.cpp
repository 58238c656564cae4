#include <signal.h>

#include <chrono>
#include <exception>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "analysis/commands.h"
#include "analysis/receive/receive_report.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"
#include "core/program/progress_line.h"
#include "railcast/io/udp_grabber.h"

namespace railcast {
namespace {

struct ReceiveOptions {
  std::string at = "127.0.0.1:27400";
  std::optional<std::string> from;
  std::optional<double> duration_s;
  std::optional<std::uint64_t> num_frames;
  std::filesystem::path out;  // Empty: nothing is recorded.
  std::optional<std::filesystem::path> summary;
};

double Now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Blocks StopSignals(), so that they stay pending until Wait() asks for them; threads that start
/// later inherit the mask.
class HeldSignals {
 public:
  HeldSignals() {
    ::sigemptyset(&signals_);
    for (const int signal : StopSignals()) ::sigaddset(&signals_, signal);
    ::pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  }
  /// Whether a stop signal arrives within 20 ms.
  [[nodiscard]] bool Wait() const {
    constexpr long kWait_ns = 20'000'000;
    const timespec wait{0, kWait_ns};
    return ::sigtimedwait(&signals_, nullptr, &wait) > 0;
  }

 private:
  sigset_t signals_{};
};

/// Counts, and on request records, the frames of a grabber; called on the grabber's thread.
class FrameCounter {
 public:
  explicit FrameCounter(const ReceiveOptions& options) : max_frames_(options.num_frames) {
    if (!options.out.empty()) files_.emplace(options.out);
  }

  void Take(const ReceivedFrame& frame) {
    const std::lock_guard lock(mutex_);
    if (IsDoneLocked()) return;
    try {
      if (files_) files_->Write(frame);
    } catch (const std::exception&) {
      fault_ = std::current_exception();
      return;
    }
    totals_.last_s = Now_s();
    if (totals_.frames == 0) totals_.first_s = totals_.last_s;
    totals_.Add(frame);
  }

  [[nodiscard]] bool is_done() const {
    const std::lock_guard lock(mutex_);
    return IsDoneLocked();
  }
  [[nodiscard]] ReceivedTotals totals() const {
    const std::lock_guard lock(mutex_);
    return totals_;
  }
  void ThrowIfFailed() const {
    if (fault_) std::rethrow_exception(fault_);
  }

 private:
  [[nodiscard]] bool IsDoneLocked() const {
    return fault_ || (max_frames_ && totals_.frames >= *max_frames_);
  }

  const std::optional<std::uint64_t> max_frames_;
  mutable std::mutex mutex_;
  std::optional<ReceivedFiles> files_;
  ReceivedTotals totals_;
  std::exception_ptr fault_;
};

int RunReceive(const ReceiveOptions& options) {
  if (!options.out.empty()) CheckIsOutside("--out", options.out);
  CheckOutputFiles({}, {{"--summary", options.summary.value_or("")}});
  const HeldSignals signals;
  FrameCounter counter(options);
  WantedStream wanted;
  if (options.from) {
    wanted.from = AtPlace("--from: ", [&] { return ParseEndpoint(*options.from, 0); });
  }
  UdpGrabber grabber(ParseEndpoint(options.at, kStreamPort), wanted);
  grabber.registerCallback(std::function(
      [&](const std::shared_ptr<const ReceivedFrame>& frame) { counter.Take(*frame); }));
  grabber.start();
  std::cout << "listening at " << EndpointText(grabber.at()) << '\n' << std::flush;

  const double begin_s = Now_s();
  const double end_s =
      begin_s + options.duration_s.value_or(std::numeric_limits<double>::infinity());
  double next_s = begin_s;
  const ProgressLine progress;
  while (!counter.is_done() && Now_s() < end_s && !signals.Wait()) {
    if (Now_s() < next_s) continue;
    next_s += 1.0;
    const std::string text = ReceiveProgress(counter.totals(), grabber.counts());
    const auto done = ReceivedShare(counter.totals(), Now_s() - begin_s,
                                    {options.num_frames, options.duration_s});
    if (done) {
      progress.Show(text, *done);
    } else {
      progress.Show(text);
    }
  }
  progress.End();
  // Read before the grabber stops, so that a frame in flight does not count as lost.
  const UdpGrabber::Counts counts = grabber.counts();
  grabber.stop();
  counter.ThrowIfFailed();
  std::cout << ReceiveSummary(counter.totals(), counts);
  if (options.summary) {
    WriteNamedFile(*options.summary, ReceiveSummaryJson(counter.totals(), counts));
  }
  return kExitSuccess;
}

}  // namespace

void AddReceive(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<ReceiveOptions>();
  ProgramOptions receive = app.AddCommand(
      "receive", "Listen to a live stream: what arrives, and what is lost; until Ctrl-C");
  receive
      .AddOption("ADDRESS", options->at,
                 "Address and port to listen at; 0.0.0.0 and [::] hear other machines, too, a "
                 "multicast group what is sent to it")
      .ShowDefault();
  receive
      .AddOption("--from", options->from,
                 "HOST or HOST:PORT whose datagrams are taken; default: the first sender heard")
      .Check(NonEmpty());
  receive
      .AddOption("--duration", options->duration_s, "Seconds after which to end; default: no end")
      .Check(Number({1e-3, 1e9}));
  receive.AddOption("--frames", options->num_frames, "Frames after which to end; default: no end")
      .Check(Whole({1}));
  receive.AddOption("--out", options->out, "Directory to record to: frames/*.pcd and frames.csv")
      .Check(NonEmpty());
  AddSummaryFile(receive, options->summary);
  receive.WhenParsed([&command, options] {
    command = [options](const std::string&) { return RunReceive(*options); };
  });
}

}  // namespace railcast
