#include "core/io/progress_line.h"

#include <unistd.h>

#include <cmath>
#include <iostream>

namespace railcast {

ProgressLine::ProgressLine()
    : is_terminal_(::isatty(STDERR_FILENO) == 1), begin_(std::chrono::steady_clock::now()) {}

void ProgressLine::Show(const std::string& what, double done) const {
  if (!is_terminal_) return;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
  // CR: to the line's begin. ESC [K: clear to its end.
  std::cerr << "\r\033[K" << std::lround(100.0 * done) << " %, " << what;
  if (done > 0.0) {
    std::cerr << ", about " << std::lround(elapsed.count() * (1.0 - done) / done) << " s left";
  }
  std::cerr << std::flush;
}

void ProgressLine::Show(const std::string& what) const {
  if (is_terminal_) std::cerr << "\r\033[K" << what << std::flush;
}

void ProgressLine::End() const {
  if (is_terminal_) std::cerr << "\r\033[K" << std::flush;
}

}  // namespace railcast
