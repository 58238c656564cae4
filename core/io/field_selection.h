#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace railcast {

/// Which fields of the frame's table (core/frame/frame.h) a file carries, in the table's order.
class FieldSelection {
 public:
  /// Every field.
  FieldSelection();
  /// @param list Names separated by commas, in any order; "all" is every field.
  /// @throws InputError if a name is unknown (naming the nearest and all valid ones) or comes
  /// twice.
  explicit FieldSelection(std::string_view list);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] bool Has(std::string_view name) const;
  /// Names separated by commas: what the second constructor reads.
  [[nodiscard]] std::string Text() const;

  bool operator==(const FieldSelection&) const = default;

 private:
  std::vector<std::string> names_;
};

}  // namespace railcast
