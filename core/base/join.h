#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace railcast {

/// The texts of items one after another, such as "a, b, c".
/// @param text_of Gives the text of an item.
template <typename Items, typename TextOf = std::identity>
[[nodiscard]] std::string Join(const Items& items,
                               std::string_view separator = ", ",
                               TextOf text_of = {}) {
  std::string text;
  for (const auto& item : items) {
    if (!text.empty()) text += separator;
    text += std::invoke(text_of, item);
  }
  return text;
}

/// As Join(), with another separator before the last item, such as "a, b or c".
template <typename Items, typename TextOf = std::identity>
[[nodiscard]] std::string JoinInProse(const Items& items,
                                      std::string_view last_separator,
                                      TextOf text_of = {}) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? last_separator : ", ";
    text += std::invoke(text_of, items[i]);
  }
  return text;
}

/// A count and what it counts: "3 boxes of objects", "1 box of objects".
/// @param what In the plural; its first word ends in "s".
[[nodiscard]] inline std::string Amount(std::uint64_t count, const std::string& what) {
  if (count != 1) return std::to_string(count) + " " + what;
  const std::size_t end = std::min(what.find_first_of(" ,:\n"), what.size());
  std::string word = what.substr(0, end - 1);
  if (word.ends_with("xe")) word.pop_back();
  if (word.ends_with("ie")) word.replace(word.size() - 2, 2, "y");
  return "1 " + word + what.substr(end);
}

}  // namespace railcast
