#include "core/program/progress_line.h"

#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "core/base/text.h"
#include "core/program/regular_lines.h"

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

}  // namespace

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

TerminalLine::TerminalLine() : is_terminal_(::isatty(STDERR_FILENO) == 1) {}

void TerminalLine::Show(std::string_view text) const {
  if (is_terminal_) {
    // CR returns to the beginning of the line, ESC [K clears to its end.
    std::cerr << "\r\033[K" << text << std::flush;
  } else {
    LinesOfLog().Show(text);
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
    LinesOfLog().Show("");
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
