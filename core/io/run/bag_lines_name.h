#pragma once

#include <string_view>

namespace railcast {

/// The file that says what a run's bag holds, beside the bag.
inline constexpr std::string_view kBagLinesFile = "bag.jsonl";

}  // namespace railcast
