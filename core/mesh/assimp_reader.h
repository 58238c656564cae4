#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/mesh/polygon_soup.h"

namespace railcast {

/// Whether railcast was built with assimp.
[[nodiscard]] bool HasAssimp();

/// A scene file's polygons with its transforms applied.
struct SceneMesh {
  PolygonSoup soup;
  double unit_m = 1.0;
  bool y_up = true;
};

/// The extension of the scene format, of those that assimp reads for railcast, that `bytes` begin
/// like: "glb", "gltf", "fbx", "dae" or "3ds".
[[nodiscard]] std::optional<std::string> SceneFormatOf(const std::string& bytes);

/// Reads a glTF, FBX, DAE or 3DS file held in `bytes` by assimp, with the names of its materials
/// and nodes. Animations are not played: everything is as in the file's rest pose.
/// @param format As SceneFormatOf() has it.
/// @param file Beside it other files that it names are looked for; empty = they are not read.
/// @throws InputError "shown: rule" if assimp cannot read it, or was not built in.
[[nodiscard]] SceneMesh ReadScene(const std::string& bytes,
                                  const std::string& format,
                                  const std::filesystem::path& file,
                                  const std::string& shown);

}  // namespace railcast
