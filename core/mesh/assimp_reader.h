#pragma once

#include <string>
#include <vector>

#include "core/mesh/mesh_format.h"
#include "core/mesh/polygon_soup.h"

namespace railcast {

/// Whether railcast was built with assimp.
[[nodiscard]] bool HasAssimp();

/// A file that another one names.
struct FileBeside {
  std::string name;  ///< Without a folder: it lies beside the other.
  std::string bytes;

  bool operator==(const FileBeside&) const = default;
};

/// A scene file's polygons with its transforms applied.
struct SceneMesh {
  PolygonSoup soup;
  double unit_m = 1.0;
  bool y_up = true;
  bool is_mirrored = false;  ///< Whether its axes are left-handed.
};

/// A scene file, whole in memory.
struct SceneSource {
  MeshFormat format{};
  std::string bytes;
  std::vector<FileBeside> beside;
  bool keeps_axes = false;  ///< Whether an FBX file's own axes are not to be used.
};

/// Reads a glTF, FBX, DAE or 3DS file by assimp, with the names of its materials and nodes.
/// Animations are not played: everything is as in the file's rest pose. FBX files are turned, and
/// mirrored if left-handed, as their axes say. assimp sees no other files
/// than the source's, and works in a process of its own (RunLimited()).
/// @throws InputError "shown: rule" if assimp cannot read it, or was not built in, or if the file
///   needs what is not read (CheckGltf).
[[nodiscard]] SceneMesh ReadScene(SceneSource source, const std::string& shown);

}  // namespace railcast
