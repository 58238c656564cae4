#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.h"

namespace railcast {

/// Appends each fault of `error` to `errors`, with `place` in front of its own place. A `place`
/// that ends in ": " stands apart; any other is the beginning of a pointer that the fault
/// continues.
inline void AddPlaced(const std::string& place, const InputError& error, ErrorList& errors) {
  constexpr std::string_view kApart = ": ";
  for (Fault fault : error.faults()) {
    if (!fault.place.empty()) {
      fault.place.insert(0, place);
    } else if (place.ends_with(kApart)) {
      fault.place = place.substr(0, place.size() - kApart.size());
    } else {
      fault.rule.insert(0, place);
    }
    errors.Add(std::move(fault));
  }
}

/// As AddPlaced() for the faults of what stands at `pointer`: those whose places are pointers
/// continue it, and those of files stand apart.
inline void AddAtPointer(const std::string& pointer, const InputError& error, ErrorList& errors) {
  for (const Fault& fault : error.faults()) {
    AddPlaced(pointer + (fault.place.starts_with('/') ? "" : ": "), InputError({fault}), errors);
  }
}

/// Returns what `make` returns.
/// @throws InputError as `make` throws it, with `place` in front of each fault's own (AddPlaced).
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

/// Returns what `make` returns. If it throws an InputError, returns nothing and appends its faults
/// to `errors`, with `place` in front of their own (AddPlaced).
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
