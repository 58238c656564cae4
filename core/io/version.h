#pragma once

#include <string>

namespace railcast {

/// The project's version and the commit that the program was built from: "0.1.0+14c4fad0a1b2". It
/// ends in ".dirty" if files of the tree were changed since, so that no commit says what it does;
/// built without a repository, from a tarball, it is "0.1.0" alone.
[[nodiscard]] std::string ProgramVersion();

}  // namespace railcast
