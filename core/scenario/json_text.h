#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"

namespace railcast {

/// JSON that keeps the order of keys, so that faults are reported in the order of the file.
using Json = nlohmann::ordered_json;

/// One step of a JSON pointer (RFC 6901) as messages show it: escapes `~`, `/` and what ShownText()
/// escapes.
[[nodiscard]] std::string PointerStep(std::string_view key);

/// The result of parsing a text.
struct JsonText {
  std::optional<Json> json;                 ///< Absent if the text is not JSON.
  std::string syntax_error;                 ///< "line 3, column 7: ..." if the text is not JSON.
  std::vector<std::string> duplicate_keys;  ///< JSON pointers of keys that occur twice.
};

/// Parses strictly: JSON according to RFC 8259, UTF-8 without byte order mark, at most 64 levels
/// deep, finite numbers only, no NUL bytes.
[[nodiscard]] JsonText ParseJson(const std::string& text);

}  // namespace railcast
