#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace railcast {

/// A file of a sequence directory and the content that it must have.
struct KnownFile {
  std::string name;                    ///< Relative to the directory.
  std::string hash;                    ///< ContentHash of its bytes.
  std::optional<std::uint64_t> bytes;  ///< Size in bytes; absent where it is not recorded.
};

}  // namespace railcast
