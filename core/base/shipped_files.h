#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace railcast {

/// The name of a file that the library holds begins with this: "railcast:car.ply".
inline constexpr std::string_view kShippedPrefix = "railcast:";

/// The content of a file of scenarios/models, or of scenarios/labels.json or
/// scenarios/materials/railway.json, which the library holds so that a program finds it
/// wherever it runs.
/// @param name With the prefix.
[[nodiscard]] std::optional<std::string_view> ShippedFile(std::string_view name);

/// The names of all of them, in alphabetical order.
[[nodiscard]] std::vector<std::string_view> ShippedFileNames();

}  // namespace railcast
