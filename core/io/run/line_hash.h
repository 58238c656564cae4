#pragma once

#include <string>
#include <string_view>

namespace railcast {

/// Returns a line of JSON with its last member added: line_xxh3, the hash of the text before it.
/// Lines of unfinished files have no other protection.
/// @param object With members of its own, without a line end.
[[nodiscard]] std::string WithLineHash(std::string_view object);

/// What is wrong with a line's hash of itself; empty if nothing is.
/// @param line As WithLineHash() returned it, without a line end.
[[nodiscard]] std::string LineHashFault(std::string_view line);

/// Whether a line has a hash of itself. Those of older programs have none.
[[nodiscard]] bool HasLineHash(std::string_view line);

}  // namespace railcast
