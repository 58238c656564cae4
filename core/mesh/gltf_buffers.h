#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh/assimp_reader.h"

namespace railcast {

/// The JSON of a glTF file, text or binary; discarded if it is none.
[[nodiscard]] nlohmann::json JsonOfGltf(const std::string& bytes);

/// The value of a key in an object, or of an index in a list; null if it is not there.
[[nodiscard]] const nlohmann::json& ValueIn(const nlohmann::json& json, const nlohmann::json& key);

/// The names of the files with a glTF file's buffers, each once, as the file has them:
/// "wagon%20a.bin". Of a file that is not as glTF has it, those that can be found: what is wrong is
/// for assimp to say.
[[nodiscard]] std::vector<std::string> BuffersOfGltf(const std::string& bytes);

/// What a glTF file uses and is not read, although it may change its shape or colours: names of
/// extensions without which it can be read.
/// @param shown Name of the file in error messages.
/// @throws InputError "shown: place: rule (got value)" if it needs an extension that is not read,
///   or has positions that are no floats without saying that it needs KHR_mesh_quantization.
[[nodiscard]] std::vector<std::string> CheckGltf(const std::string& bytes,
                                                 const std::string& shown);

/// Puts floats in the place of positions in a file of glTF 2 that assimp 5.2 would read wrong:
/// whole numbers of KHR_mesh_quantization, divided by their type's largest if they are normalised,
/// and what morph targets move in the file's rest pose. A node's weights hold in place of its
/// mesh's (glTF 2.0, 3.6.2.2, 3.7.2.2). Other files stay as they are; a binary file that is changed
/// becomes one of text, with its buffer beside it.
/// @throws InputError "shown: place: rule (got value)" if such positions are not within their
///   buffers, are compressed by Draco, or weights and targets are not of one number.
void MakePositionsFloats(SceneSource& source, const std::string& shown);

/// The name of a file as glTF writes it, without its percent signs: "wagon a.bin".
[[nodiscard]] std::string FileOfUri(const std::string& uri);

/// How many triangles all primitives state together; nothing if one has no indices of triangles, or
/// there are others than `num_primitives`: those of no node are not loaded.
[[nodiscard]] std::optional<std::size_t> TrianglesOfGltf(const std::string& bytes,
                                                         std::size_t num_primitives);

}  // namespace railcast
