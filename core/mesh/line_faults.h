#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "core/base/error.h"

namespace railcast {

/// The faults of a mesh file in text, which are reported together.
class LineFaults {
 public:
  /// @param shown Name of the file in error messages.
  explicit LineFaults(std::string shown) : shown_(std::move(shown)) {}

  /// Reads a line or anything else by `read`, which may throw an InputError, and keeps that.
  /// Returns whether it threw none.
  /// @throws InputError with all faults kept as soon as they are too many to list.
  template <typename Read>
  bool Try(const Read& read) {
    constexpr std::size_t kMostFaults = 19;  // With the line below, as many as an error shows.
    try {
      read();
      return true;
    } catch (const InputError& error) {
      for (const Fault& fault : error.faults()) faults_.Add(fault);
    }
    if (faults_.size() >= kMostFaults) {
      faults_.AddLine(shown_ + ": goes on; this many faults are listed at most");
      faults_.ThrowIfAny();
    }
    return false;
  }

  /// @throws InputError with all faults kept, if there are any.
  void ThrowIfAny() const { faults_.ThrowIfAny(); }

 private:
  std::string shown_;
  ErrorList faults_;
};

}  // namespace railcast
