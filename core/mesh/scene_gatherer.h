#pragma once

#include <assimp/scene.h>

#include <string>

#include "core/mesh/polygon_soup.h"

namespace railcast {

/// What a scene is gathered with.
struct SceneGathering {
  std::string shown;  ///< The file in messages.
  /// From the scene's axes, in which assimp gives it, to those of the file.
  Eigen::Affine3d file_from_scene = Eigen::Affine3d::Identity();
};

/// Gathers the meshes of a scene's nodes as polygons with the names of their materials and nodes,
/// in their rest pose. A mesh with a skin is where its bones hold it, wherever its own node is
/// (glTF 2.0, 3.7.3.3: "the transform of the node is ignored").
/// @throws InputError "shown: rule (got value)" for a coordinate or a corner that is none.
[[nodiscard]] PolygonSoup GatherScene(const aiScene& scene, const SceneGathering& gathering);

}  // namespace railcast
