#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace railcast {

/// Returns the XXH3 hash (64 bits) of the bytes as 16 lower-case hexadecimal digits, as printed by
/// `xxhsum -H3`.
[[nodiscard]] std::string ContentHash(std::string_view bytes);
/// The same hash as a number.
[[nodiscard]] std::uint64_t ContentHashNumber(std::string_view bytes);

struct FileHash {
  std::string hash;  ///< ContentHash() of its bytes.
  std::uint64_t num_bytes{};
};
/// Reads a file of any size piece by piece.
/// @throws InputError if it is not a regular file or cannot be read.
[[nodiscard]] FileHash HashFile(const std::filesystem::path& file);

}  // namespace railcast
