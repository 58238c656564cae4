#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
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

}  // namespace railcast
