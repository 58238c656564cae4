#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace railcast {

/// A file of a sequence directory and what it must hold.
struct KnownFile {
  std::string name;                    ///< Relative to the directory.
  std::string hash;                    ///< ContentHash of its bytes.
  std::optional<std::uint64_t> bytes;  ///< How many; absent where nothing says it.
};

}  // namespace railcast
