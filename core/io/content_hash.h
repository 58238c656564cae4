#pragma once

#include <string>
#include <string_view>

namespace railcast {

/// XXH3 (64 bits) of the bytes as 16 lower-case hexadecimal digits, as `xxhsum -H3` prints it.
[[nodiscard]] std::string ContentHash(std::string_view bytes);

}  // namespace railcast
