#pragma once

#include <optional>
#include <sstream>
#include <string>

#include "core/base/error.h"

namespace railcast {

/// What `make` returns; or nothing, and each line of its InputError, with `place` put before it, in
/// `errors`.
template <typename Make>
auto Attempt(const std::string& place, ErrorList& errors, const Make& make)
    -> std::optional<decltype(make())> {
  try {
    return make();
  } catch (const InputError& error) {
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);) errors.Add(place + line);
    return std::nullopt;
  }
}

}  // namespace railcast
