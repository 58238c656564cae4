#pragma once

#include <set>
#include <string>
#include <string_view>

namespace railcast {

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
