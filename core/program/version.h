#pragma once

#include <string>

namespace railcast {

/// Returns the project's version and the commit that the program was built from:
/// "0.1.0+14c4fad0a1b2". If files of the tree have changed since, ".dirty." and a hash of these
/// changes follow; if git cannot tell the commit, it is "0.1.0+unknown"; built without a
/// repository, from a tarball, it is "0.1.0" alone.
[[nodiscard]] std::string ProgramVersion();

}  // namespace railcast
