#pragma once

#include <cstddef>
#include <string>
#include <unordered_set>
#include <vector>

#include "railcast/error.h"

namespace railcast {

/// Collects faults, so that all errors of a file are reported together and each only once.
class ErrorList {
 public:
  void Add(Fault fault);
  /// Adds a fault whose line is already put together.
  void AddLine(std::string line) { Add({"", std::move(line), ""}); }

  [[nodiscard]] bool empty() const { return faults_.empty(); }
  [[nodiscard]] std::size_t size() const { return faults_.size(); }
  [[nodiscard]] const std::vector<Fault>& faults() const { return faults_; }
  [[nodiscard]] std::vector<std::string> lines() const;

  /// @throws InputError with all faults if there are any.
  void ThrowIfAny() const;

 private:
  std::vector<Fault> faults_;
  std::unordered_set<std::string> seen_;  ///< Lines.
};

/// Aborts and prints the source location if an internal assumption is violated (a programming
/// error, never a user error). Active in all build types.
void Check(bool condition,
           const char* assumption,
           const char* file = __builtin_FILE(),
           int line = __builtin_LINE());

}  // namespace railcast
