#pragma once

#include <chrono>
#include <string>

namespace railcast {

/// How far a long job is and how long it will still take, rewritten in one line of the terminal;
/// silent where stderr is none.
class ProgressLine {
 public:
  ProgressLine();

  /// @param done Share of the job, in [0, 1].
  void Show(const std::string& what, double done) const;
  /// Where it is not known how long the job is.
  void Show(const std::string& what) const;
  void End() const;

 private:
  bool is_terminal_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace railcast
