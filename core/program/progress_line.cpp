#include "core/program/progress_line.h"

#include <atomic>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "core/base/text.h"

namespace railcast {
namespace {

// One for the whole program, so that jobs within jobs do not print lines of their own. It is never
// destroyed: a process that was forked has no thread to wait for.
RegularLines& LinesOfLog() {
  constexpr std::chrono::seconds kInterval(30);
  static RegularLines& lines = *new RegularLines(kInterval, [](const std::string& line) {
    std::cerr << ShownLines(line) + "\n" << std::flush;
  });
  return lines;
}

// Numbers the lines of a program. What is left of one when it is destroyed is over.
std::shared_ptr<const int> NewJob() {
  static std::atomic<int> num_jobs = 0;
  return {new int(++num_jobs), [](const int* job) {
            LinesOfLog().Show(*job, "");
            delete job;
          }};
}

}  // namespace

RegularLines::RegularLines(std::chrono::milliseconds interval,
                           std::function<void(const std::string& line)> print)
    : interval_(interval), print_(std::move(print)) {}

void RegularLines::Show(int job, std::string_view text) {
  const std::scoped_lock lock(mutex_);
  if (text.empty()) {
    texts_.erase(job);
    return;
  }
  texts_[job] = text;
  if (!std::exchange(has_started_, true)) Start();
}

void RegularLines::Start() {
  try {
    thread_ = std::jthread([this](const std::stop_token& stop) { Run(stop); });
  } catch (const std::system_error&) {
    // Where no further thread can be started, the work itself goes on without these lines.
  }
}

void RegularLines::Run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    wake_.wait_for(lock, stop, interval_, [] { return false; });
    if (stop.stop_requested() || texts_.empty()) continue;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
    std::string line = "after " + DurationText(elapsed.count());
    const char* separator = ": ";
    for (const auto& [job, text] : texts_) line += std::exchange(separator, "; ") + text;
    print_(line);
  }
}

std::string DurationText(double duration_s) {
  const auto seconds = static_cast<std::uint64_t>(std::ceil(duration_s));
  std::ostringstream text;
  text << std::setfill('0');
  if (seconds >= 3600) {
    text << seconds / 3600 << ":" << std::setw(2);
  }
  text << seconds / 60 % 60 << ":" << std::setw(2) << seconds % 60;
  return text.str();
}

TerminalLine::TerminalLine() : is_terminal_(::isatty(STDERR_FILENO) == 1), job_(NewJob()) {}

void TerminalLine::Show(std::string_view text) const {
  if (is_terminal_) {
    // CR returns to the beginning of the line, ESC [K clears to its end.
    std::cerr << "\r\033[K" << ShownLines(text) << std::flush;
  } else {
    LinesOfLog().Show(*job_, text);
  }
}

void TerminalLine::Say(std::string_view text) const {
  if (is_terminal_) Clear();
  std::cerr << ShownLines(text) + "\n" << std::flush;
}

void TerminalLine::End() const {
  if (is_terminal_) {
    std::cerr << "\n";
  } else {
    LinesOfLog().Show(*job_, "");
  }
}

std::string ProgressText(const std::string& what,
                         double done,
                         double done_before,
                         double elapsed_s) {
  std::string text = std::to_string(std::lround(100.0 * done)) + " %, " + what;
  if (done > done_before) {
    text += ", about " + DurationText(elapsed_s * (1.0 - done) / (done - done_before)) + " left";
  }
  return text;
}

void ProgressLine::Show(const std::string& what, double done) const {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
  line_.Show(ProgressText(what, done, done_before_, elapsed.count()));
}

}  // namespace railcast
