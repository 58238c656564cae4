#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace railcast {

/// Keeps the order of keys, so that errors come in the order of the file.
using Json = nlohmann::ordered_json;

/// One step down in a JSON pointer (RFC 6901), as messages show it: escapes `~` and `/`, and what
/// ShownText() does.
[[nodiscard]] std::string PointerStep(std::string_view key);

/// What a text holds, and what is wrong with it.
struct JsonText {
  std::optional<Json> json;                 ///< Absent if the text is no JSON.
  std::string syntax_error;                 ///< "line 3, column 7: ...", if so.
  std::vector<std::string> duplicate_keys;  ///< JSON pointers.
};

/// Parses strictly: JSON as RFC 8259 has it, UTF-8 without byte order mark, at most 64 levels deep,
/// every number finite, without NUL bytes.
[[nodiscard]] JsonText ParseJson(const std::string& text);

}  // namespace railcast
