#include "core/mesh/scene_gatherer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/mesh/polygon_soup.h"

namespace railcast {
namespace {

Eigen::Affine3d Matrix(const aiMatrix4x4& m) {
  Eigen::Matrix4d matrix;
  matrix << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
      m.d3, m.d4;
  return Eigen::Affine3d(matrix);
}

Vector3 DoublesOf(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

/// A node and where it is.
struct PlacedNode {
  const aiNode* node{};
  Eigen::Affine3d file_from_node;
};

/// All nodes, each before its children and these in their order. Without recursion: a file may nest
/// them as deep as it likes.
std::vector<PlacedNode> PlacedNodesOf(const aiScene& scene,
                                      const Eigen::Affine3d& file_from_scene) {
  std::vector<PlacedNode> nodes;
  std::vector<std::pair<const aiNode*, Eigen::Affine3d>> open;
  if (scene.mRootNode != nullptr) open.emplace_back(scene.mRootNode, file_from_scene);
  while (!open.empty()) {
    const auto [node, file_from_parent] = open.back();
    open.pop_back();
    nodes.push_back({node, file_from_parent * Matrix(node->mTransformation)});
    for (unsigned i = node->mNumChildren; i > 0; --i) {
      open.emplace_back(node->mChildren[i - 1], nodes.back().file_from_node);
    }
  }
  return nodes;
}

class SceneGatherer {
 public:
  SceneGatherer(const aiScene& scene, const SceneGathering& gathering)
      : scene_(scene),
        gathering_(gathering),
        nodes_(PlacedNodesOf(scene, gathering.file_from_scene)),
        groups_(soup_.groups) {
    for (const PlacedNode& placed : nodes_) {
      node_of_name_.try_emplace(placed.node->mName.C_Str(), &placed);
    }
  }

  PolygonSoup Gather() {
    for (const PlacedNode& placed : nodes_) {
      for (unsigned i = 0; i < placed.node->mNumMeshes; ++i) {
        AddMesh(*scene_.mMeshes[placed.node->mMeshes[i]], placed);
      }
    }
    if (has_colors_) NameMaterialsByColor(colors_, soup_);
    return std::move(soup_);
  }

 private:
  void AddMesh(const aiMesh& mesh, const PlacedNode& placed) {
    const char* node = placed.node->mName.C_Str();
    const std::size_t first = soup_.points.size();
    const std::vector<Vector3> points = PointsOf(mesh, placed.file_from_node);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!points[i].allFinite()) {
        throw InputError(gathering_.shown + ": vertex " + std::to_string(i) + " of \"" +
                         ShownText(node) + "\" must have three finite coordinates");
      }
      soup_.points.push_back(points[i]);
      colors_.push_back(ColorOf(mesh, static_cast<unsigned>(i)));
    }
    has_colors_ = has_colors_ || mesh.HasVertexColors(0);
    const std::uint32_t group = groups_.Of(node);
    const std::uint32_t material = MaterialOf(mesh);
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      std::vector<std::uint32_t> corners;  // Two of a line, one of a point.
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices) {
          throw InputError(gathering_.shown + ": face " + std::to_string(i) + " of \"" +
                           ShownText(node) + "\" must name one of its " +
                           std::to_string(mesh.mNumVertices) + " vertices, counted from 0" +
                           Got(face.mIndices[k]));
        }
        corners.push_back(static_cast<std::uint32_t>(first + face.mIndices[k]));
      }
      soup_.AddFace(std::move(corners), material, group);
    }
  }

  /// The places of a mesh's vertices in the file's axes.
  [[nodiscard]] std::vector<Vector3> PointsOf(const aiMesh& mesh,
                                              const Eigen::Affine3d& file_from_node) const {
    std::vector<Vector3> points(mesh.mNumVertices, Vector3::Zero());
    std::vector<double> weights(mesh.mNumVertices, 0.0);
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      const auto joint = node_of_name_.find(bone.mName.C_Str());
      if (joint == node_of_name_.end()) continue;
      const Eigen::Affine3d file_from_mesh =
          joint->second->file_from_node * Matrix(bone.mOffsetMatrix);
      for (unsigned i = 0; i < bone.mNumWeights; ++i) {
        const unsigned vertex = bone.mWeights[i].mVertexId;
        const double weight = bone.mWeights[i].mWeight;
        if (vertex >= mesh.mNumVertices || !(weight > 0.0)) continue;
        points[vertex] += weight * (file_from_mesh * DoublesOf(mesh.mVertices[vertex]));
        weights[vertex] += weight;
      }
    }
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      if (weights[i] > 0.0) {
        points[i] /= weights[i];
      } else {
        points[i] = file_from_node * DoublesOf(mesh.mVertices[i]);
      }
    }
    return points;
  }

  /// Materials of one name and of different colours stay apart.
  [[nodiscard]] std::uint32_t MaterialOf(const aiMesh& mesh) {
    const std::string name = NameOfMaterial(mesh);
    const std::optional<double> luminance = LuminanceOfMaterial(mesh);
    if (name.empty() && !luminance) return PolygonSoup::kUnnamed;
    const auto next = static_cast<std::uint32_t>(soup_.materials.size());
    const auto [it, is_new] = materials_.try_emplace({name, luminance}, next);
    if (is_new) {
      soup_.materials.push_back(name);
      soup_.luminances.push_back(luminance);
    }
    return it->second;
  }

  /// The luminance of the base colour that a glTF material has: white, if the file gives none.
  /// Nothing is known where a picture or colours of vertices change it, or there is no material:
  /// assimp's own is white and has no name.
  [[nodiscard]] std::optional<double> LuminanceOfMaterial(const aiMesh& mesh) const {
    if (mesh.mMaterialIndex >= scene_.mNumMaterials || mesh.HasVertexColors(0)) return std::nullopt;
    const aiMaterial& material = *scene_.mMaterials[mesh.mMaterialIndex];
    aiColor4D color;
    if (material.Get(AI_MATKEY_BASE_COLOR, color) != AI_SUCCESS ||
        material.GetTextureCount(aiTextureType_BASE_COLOR) > 0) {
      return std::nullopt;
    }
    const bool is_white = color.r == 1.0F && color.g == 1.0F && color.b == 1.0F;
    if (is_white && material.GetName().length == 0) return std::nullopt;
    for (const double part : {color.r, color.g, color.b}) {
      if (part >= 0.0 && part <= 1.0) continue;
      throw InputError(gathering_.shown + ": the base colour of " +
                       Quoted(material.GetName().C_Str()) + " must have parts from 0 to 1" +
                       Got(part));
    }
    return LuminanceOf(color.r, color.g, color.b);
  }

  /// assimp makes a material for what has none in the file: then the colours tell parts apart.
  [[nodiscard]] std::string NameOfMaterial(const aiMesh& mesh) const {
    if (mesh.mMaterialIndex >= scene_.mNumMaterials) return "";
    const std::string name = scene_.mMaterials[mesh.mMaterialIndex]->GetName().C_Str();
    return mesh.HasVertexColors(0) && name == AI_DEFAULT_MATERIAL_NAME ? "" : name;
  }

  [[nodiscard]] static Rgb8 ColorOf(const aiMesh& mesh, unsigned vertex) {
    constexpr Rgb8 kWhite = {255, 255, 255};
    if (!mesh.HasVertexColors(0)) return kWhite;
    const aiColor4D& color = mesh.mColors[0][vertex];
    const auto byte_of = [](ai_real part) {
      return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(part, 0.0F, 1.0F)));
    };
    return {byte_of(color.r), byte_of(color.g), byte_of(color.b)};
  }

  const aiScene& scene_;
  const SceneGathering& gathering_;
  std::vector<PlacedNode> nodes_;
  std::unordered_map<std::string, const PlacedNode*> node_of_name_;
  PolygonSoup soup_;
  std::vector<Rgb8> colors_;  ///< Colours of the points.
  bool has_colors_ = false;   ///< Whether the file gives any of them.
  std::map<std::pair<std::string, std::optional<double>>, std::uint32_t> materials_;
  NameIndices groups_;
};

}  // namespace

PolygonSoup GatherScene(const aiScene& scene, const SceneGathering& gathering) {
  return SceneGatherer(scene, gathering).Gather();
}

}  // namespace railcast
