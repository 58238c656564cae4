#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace railcast {

/// The names of the files with a glTF file's buffers, each once, as the file has them:
/// "wagon%20a.bin". Of a file that is not as glTF has it, those that can be found: what is wrong is
/// for assimp to say.
[[nodiscard]] std::vector<std::string> BuffersOfGltf(const std::string& bytes);

/// What a glTF file uses and is not read, although it may change its shape or colours: names of
/// extensions without which it can be read, and weights of morph targets.
/// @param shown Name of the file in error messages.
/// @throws InputError "shown: place: rule (got value)" if it needs an extension that is not read,
///   or has positions that are no floats.
[[nodiscard]] std::vector<std::string> CheckGltf(const std::string& bytes,
                                                 const std::string& shown);

/// The name of a file as glTF writes it, without its percent signs: "wagon a.bin".
[[nodiscard]] std::string FileOfUri(const std::string& uri);

/// How many triangles all primitives state together; nothing if one has no indices of triangles, or
/// there are others than `num_primitives`: those of no node are not loaded.
[[nodiscard]] std::optional<std::size_t> TrianglesOfGltf(const std::string& bytes,
                                                         std::size_t num_primitives);

}  // namespace railcast
