#pragma once

#include <string>

namespace railcast {

/// A DAE file as assimp understands it: in UTF-8, and without blanks at the ends of values. XML
/// Schema passes over these in all values that DAE has, but assimp 5.2 takes a unit of " 0.01 " for
/// 1 m, an axis of " Z_UP " for the default, y, and does not find what " #mesh " names.
[[nodiscard]] std::string PlainDae(std::string bytes);

}  // namespace railcast
