#include "core/program/progress_line.h"

#include <unistd.h>

#include <cmath>
#include <iostream>

#include "core/base/text.h"

namespace railcast {

TerminalLine::TerminalLine() : is_terminal_(::isatty(STDERR_FILENO) == 1) {}

void TerminalLine::Show(std::string_view text) const {
  // CR returns to the beginning of the line, ESC [K clears to its end.
  if (is_terminal_) std::cerr << "\r\033[K" << text << std::flush;
}

void TerminalLine::Say(std::string_view text) const {
  Clear();
  std::cerr << ShownLines(text) << "\n" << std::flush;
}

void TerminalLine::End() const {
  if (is_terminal_) std::cerr << "\n";
}

void ProgressLine::Show(const std::string& what, double done) const {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
  std::string text = std::to_string(std::lround(100.0 * done)) + " %, " + what;
  if (done > 0.0) {
    const long left_s = std::lround(elapsed.count() * (1.0 - done) / done);
    text += ", about " + std::to_string(left_s) + " s left";
  }
  line_.Show(text);
}

}  // namespace railcast
