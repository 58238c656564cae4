#include "core/program/regular_lines.h"

#include <system_error>
#include <utility>

#include "core/program/progress_line.h"

namespace railcast {

RegularLines::RegularLines(std::chrono::milliseconds interval,
                           std::function<void(const std::string& line)> print)
    : interval_(interval), print_(std::move(print)) {}

void RegularLines::Show(std::string_view text) {
  const std::scoped_lock lock(mutex_);
  text_ = text;
  if (!text_.empty() && !std::exchange(has_started_, true)) Start();
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
    if (stop.stop_requested() || text_.empty()) continue;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin_;
    print_("after " + DurationText(elapsed.count()) + ": " + text_);
  }
}

}  // namespace railcast
