#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace railcast {

/// Pieces of text as one. (GCC 12 takes chains of + for overlapping copies and warns.)
[[nodiscard]] inline std::string Joined(std::initializer_list<std::string_view> pieces) {
  std::string text;
  for (const std::string_view piece : pieces) text += piece;
  return text;
}

}  // namespace railcast
