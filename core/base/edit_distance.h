#pragma once

#include <cstddef>
#include <string_view>

namespace railcast {

/// Levenshtein's distance (1966): the least number of inserted, deleted or changed characters that
/// turns one name into the other. For naming what a misspelt word may have meant.
[[nodiscard]] std::size_t EditDistance(std::string_view a, std::string_view b);

}  // namespace railcast
