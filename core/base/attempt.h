#pragma once

#include <optional>
#include <sstream>
#include <string>

#include "core/base/error.h"

namespace railcast {

/// Each line of `error`, with `place` put before it, to `errors`.
inline void AddPlaced(const std::string& place, const InputError& error, ErrorList& errors) {
  std::istringstream lines(error.what());
  for (std::string line; std::getline(lines, line);) errors.Add(place + line);
}

/// What `make` returns.
/// @throws Its InputError, with `place` put before each line.
template <typename Make>
decltype(auto) AtPlace(const std::string& place, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    ErrorList errors;
    AddPlaced(place, error, errors);
    errors.ThrowIfAny();
    throw;
  }
}

/// What `make` returns; or nothing, and each line of its InputError, with `place` put before it, in
/// `errors`.
template <typename Make>
auto Attempt(const std::string& place, ErrorList& errors, const Make& make)
    -> std::optional<decltype(make())> {
  try {
    return make();
  } catch (const InputError& error) {
    AddPlaced(place, error, errors);
    return std::nullopt;
  }
}

}  // namespace railcast
