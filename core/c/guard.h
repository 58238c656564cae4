#pragma once

#include <stdexcept>
#include <string>

#include "railcast/c_api.h"

namespace railcast {

/// The host's argument breaks a rule of c_api.h.
class ArgumentError final : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The host's callback failed or broke a rule of railcast_rays.
class CallbackError final : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// @throws ArgumentError "name: must not be null".
template <typename T>
T& NotNull(T* argument, const char* name) {
  if (argument == nullptr) throw ArgumentError(std::string(name) + ": must not be null");
  return *argument;
}

/// Keeps the message of the exception that is being handled for LastError(), and returns its
/// status.
[[nodiscard]] railcast_status StatusOfException() noexcept;

/// The calling thread's message.
[[nodiscard]] const char* LastError() noexcept;

/// Does the work of one function of the C interface, which no exception leaves.
template <typename Work>
[[nodiscard]] railcast_status Guarded(const Work& work) noexcept {
  try {
    work();
    return RAILCAST_OK;
  } catch (...) {
    return StatusOfException();
  }
}

}  // namespace railcast
