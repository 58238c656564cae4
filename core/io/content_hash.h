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

/// Returns a line of JSON with its last member added: line_xxh3, the hash of the text before it.
/// Lines of unfinished files have no other protection.
/// @param object With members of its own, without a line end.
[[nodiscard]] std::string WithLineHash(std::string_view object);

/// What is wrong with a line's hash of itself; empty if nothing is.
/// @param line As WithLineHash() returned it, without a line end.
[[nodiscard]] std::string LineHashFault(std::string_view line);

/// The line as it was before WithLineHash(), if it has a hash.
[[nodiscard]] std::string WithoutLineHash(std::string_view line);

}  // namespace railcast
