#pragma once

#include <stdexcept>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

namespace railcast {

/// Something the user can mend: a scenario, a mesh, a command line, a file.
///
/// `what()` holds one line per fault, each "place: rule (value)", for example
/// `scenarios/demo.json: /lidar/range_max_m: must be > 0 (got -5)`.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& lines) : std::runtime_error(lines) {}
};

/// Gathers faults so that a file's errors are reported all at once, each of them once.
class ErrorList {
 public:
  void Add(std::string line) {
    if (seen_.insert(line).second) lines_.push_back(std::move(line));
  }

  [[nodiscard]] bool empty() const { return lines_.empty(); }
  [[nodiscard]] const std::vector<std::string>& lines() const { return lines_; }

  /// @throws InputError with every line, if there is any.
  void ThrowIfAny() const;

 private:
  std::vector<std::string> lines_;
  std::unordered_set<std::string> seen_;
};

/// Aborts with the place if an assumption of ours (never of the user's) is broken. Always on.
void Check(bool condition,
           const char* assumption,
           const char* file = __builtin_FILE(),
           int line = __builtin_LINE());

}  // namespace railcast
