#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

namespace railcast {

/// Prints at regular intervals what a program is doing, for logs. It has a thread of its own, since
/// a single step may take longer than an interval.
class RegularLines {
 public:
  /// @param print Called with each line, by a thread of its own.
  RegularLines(std::chrono::milliseconds interval,
               std::function<void(const std::string& line)> print);

  /// What a job does from now on; empty once it is over. The texts of jobs within jobs become one
  /// line; nothing is printed while there is none. Thread-safe.
  void Show(int job, std::string_view text);

 private:
  void Run(const std::stop_token& stop);
  void Start();

  const std::chrono::milliseconds interval_;
  const std::function<void(const std::string& line)> print_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::map<int, std::string> texts_;  ///< By job, the outer ones first.
  bool has_started_ = false;
  std::jthread thread_;  // The last member, so that it ends before the others.
};

/// "0:05", "8:19" or "2:05:00": minutes and seconds, with hours where there are any. Parts of a
/// second count as a whole one.
[[nodiscard]] std::string DurationText(double duration_s);

/// A line on stderr that shows the progress of a job. On a terminal it is rewritten in place.
/// Elsewhere, as in a log, every half minute what is shown last becomes a line, so that a job of
/// less than that leaves none. Jobs within jobs share these lines. A copy is the same line.
class TerminalLine {
 public:
  TerminalLine();

  void Show(std::string_view text) const;
  /// Prints `text` as a line of its own above the progress, even where stderr is not a terminal.
  void Say(std::string_view text) const;
  void Clear() const { Show(""); }
  /// Keeps the text shown last on the terminal and begins a new line.
  void End() const;

 private:
  bool is_terminal_;
  std::shared_ptr<const int> job_;  ///< Its number among the lines of a log.
};

/// "42 %, scenario 11 of 24, about 2:05 left".
/// @param done Completed share of the job, in [0, 1].
/// @param done_before That of an earlier run, which says nothing of the time that is left.
/// @param elapsed_s Since this run began.
[[nodiscard]] std::string ProgressText(const std::string& what,
                                       double done,
                                       double done_before,
                                       double elapsed_s);

/// Shows in a TerminalLine how far a long job is and how long it will still take.
class ProgressLine {
 public:
  /// @param done_before Completed share of a job that an earlier run began.
  explicit ProgressLine(double done_before = 0.0)
      : begin_(std::chrono::steady_clock::now()), done_before_(done_before) {}

  /// @param done Completed share of the job, in [0, 1].
  void Show(const std::string& what, double done) const;
  /// For a job of unknown length.
  void Show(const std::string& what) const { line_.Show(what); }
  void End() const { line_.Clear(); }

 private:
  TerminalLine line_;
  std::chrono::steady_clock::time_point begin_;
  double done_before_;
};

}  // namespace railcast
