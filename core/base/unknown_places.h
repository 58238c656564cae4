#pragma once

#include <set>
#include <string>
#include <string_view>

namespace railcast {

/// The places, as JSON pointers, of values that are not known because something about them is
/// faulty. A rule is applied only to what is known, so that a fault brings no others in its wake.
class UnknownPlaces {
 public:
  void Add(std::string pointer) { pointers_.insert(std::move(pointer)); }

  /// Whether neither the value there, nor anything in it, nor what it is part of, is unknown.
  [[nodiscard]] bool IsKnown(std::string_view pointer) const;

 private:
  std::set<std::string, std::less<>> pointers_;
};

}  // namespace railcast
