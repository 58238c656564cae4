#pragma once

#include <string>
#include <string_view>

#include "core/mesh/assimp_reader.h"

namespace railcast {

/// A scene's mesh as bytes, for another process of the same program.
[[nodiscard]] std::string BytesOfScene(const SceneMesh& mesh);

/// The mesh of BytesOfScene(); nothing if the bytes are damaged, or a face of it names what is not
/// there.
[[nodiscard]] std::optional<SceneMesh> SceneOfBytes(std::string_view bytes);

}  // namespace railcast
