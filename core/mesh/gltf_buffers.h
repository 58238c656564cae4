#pragma once

#include <string>
#include <vector>

namespace railcast {

/// The names of the files with a glTF file's buffers, each once, as the file has them:
/// "wagon%20a.bin". Of a file that is not as glTF has it, those that can be found: what is wrong is
/// for assimp to say.
[[nodiscard]] std::vector<std::string> BuffersOfGltf(const std::string& bytes);

/// The name of a file as glTF writes it, without its percent signs: "wagon a.bin".
[[nodiscard]] std::string FileOfUri(const std::string& uri);

}  // namespace railcast
