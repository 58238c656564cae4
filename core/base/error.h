#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
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

/// Returns what says that this railcast lacks an extra, and how it comes.
/// @param what What needs it: "a.mcap".
[[nodiscard]] InputError LacksExtra(const std::string& what, const std::string& extra);

/// JSON pointers of values that are unknown because they contain a fault. Rules are applied to
/// known values only, so that one fault does not cause further messages.
class UnknownPlaces {
 public:
  void Add(std::string pointer) { pointers_.insert(std::move(pointer)); }

  /// Returns whether the value at `pointer` is known: neither it, nor any value inside it, nor any
  /// value containing it is marked as unknown.
  [[nodiscard]] bool IsKnown(std::string_view pointer) const;

 private:
  std::set<std::string, std::less<>> pointers_;
};

}  // namespace railcast
