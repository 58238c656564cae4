#pragma once

#include <string>
#include <string_view>

namespace railcast {

/// Returns the XXH3 hash (64 bits) of the bytes as 16 lower-case hexadecimal digits, as printed by
/// `xxhsum -H3`.
[[nodiscard]] std::string ContentHash(std::string_view bytes);

}  // namespace railcast
