#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace railcast {

/// A terminal line that shows the progress of a job and is rewritten in place. Silent where stderr
/// is not a terminal, except for Say().
class TerminalLine {
 public:
  TerminalLine();

  void Show(std::string_view text) const;
  /// Prints `text` as a line of its own above the progress, even where stderr is not a terminal.
  void Say(std::string_view text) const;
  void Clear() const { Show(""); }
  /// Keeps the text shown last and begins a new line.
  void End() const;

 private:
  bool is_terminal_;
};

/// Shows in a TerminalLine how far a long job is and how long it will still take.
class ProgressLine {
 public:
  ProgressLine() : begin_(std::chrono::steady_clock::now()) {}

  /// @param done Completed share of the job, in [0, 1].
  void Show(const std::string& what, double done) const;
  /// For a job of unknown length.
  void Show(const std::string& what) const { line_.Show(what); }
  void End() const { line_.Clear(); }

 private:
  TerminalLine line_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace railcast
