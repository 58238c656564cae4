#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
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

  /// What is being done from now on; nothing is printed while it is empty. Thread-safe.
  void Show(std::string_view text);

 private:
  void Run(const std::stop_token& stop);
  void Start();

  const std::chrono::milliseconds interval_;
  const std::function<void(const std::string& line)> print_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::string text_;
  bool has_started_ = false;
  std::jthread thread_;  // The last member, so that it ends before the others.
};

}  // namespace railcast
