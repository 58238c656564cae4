#include "core/mesh/assimp_reader.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/mesh/face_colors.h"

namespace railcast {
namespace {

Eigen::Affine3d Matrix(const aiMatrix4x4& m) {
  Eigen::Matrix4d matrix;
  matrix << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
      m.d3, m.d4;
  return Eigen::Affine3d(matrix);
}

/// Gathers the meshes of a scene's nodes.
class SceneGatherer {
 public:
  SceneGatherer(const aiScene& scene, const std::string& shown)
      : scene_(scene), shown_(shown), materials_(soup_.materials), groups_(soup_.groups) {}

  PolygonSoup Gather() {
    if (scene_.mRootNode != nullptr) AddNode(*scene_.mRootNode, Eigen::Affine3d::Identity());
    if (has_colors_) NameMaterialsByColor(colors_, soup_);
    return std::move(soup_);
  }

 private:
  void AddNode(const aiNode& node, const Eigen::Affine3d& scene_from_parent) {
    const Eigen::Affine3d scene_from_node = scene_from_parent * Matrix(node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      AddMesh(*scene_.mMeshes[node.mMeshes[i]], node.mName.C_Str(), scene_from_node);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) AddNode(*node.mChildren[i], scene_from_node);
  }

  void AddMesh(const aiMesh& mesh, const char* node, const Eigen::Affine3d& scene_from_node) {
    const std::size_t first = soup_.points.size();
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& v = mesh.mVertices[i];
      const Vector3 point = scene_from_node * Vector3(v.x, v.y, v.z);
      if (!point.allFinite()) {
        throw InputError(shown_ + ": vertex " + std::to_string(i) + " of \"" + ShownText(node) +
                         "\" must have three finite coordinates");
      }
      soup_.points.push_back(point);
      colors_.push_back(ColorOf(mesh, i));
    }
    has_colors_ = has_colors_ || mesh.HasVertexColors(0);
    const std::uint32_t group = groups_.Of(node);
    const std::uint32_t material = materials_.Of(MaterialOf(mesh));
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      std::vector<std::uint32_t> corners;  // Two of a line, one of a point.
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices) {
          throw InputError(shown_ + ": face " + std::to_string(i) + " of \"" + ShownText(node) +
                           "\" must name one of its " + std::to_string(mesh.mNumVertices) +
                           " vertices, counted from 0" + Got(face.mIndices[k]));
        }
        corners.push_back(static_cast<std::uint32_t>(first + face.mIndices[k]));
      }
      soup_.AddFace(std::move(corners), material, group);
    }
  }

  /// assimp makes a material for what has none in the file: then the colours tell parts apart.
  [[nodiscard]] std::string MaterialOf(const aiMesh& mesh) const {
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
  const std::string& shown_;
  PolygonSoup soup_;
  std::vector<Rgb8> colors_;  ///< Of the points.
  bool has_colors_ = false;   ///< Whether the file gives any of them.
  NameIndices materials_;
  NameIndices groups_;
};

/// FBX files say what their unit is, in centimetres, and which axis is up. assimp has turned and
/// scaled the other formats to metres with y up.
void TakeUnits(const aiScene& scene, const std::string& format, SceneMesh& mesh) {
  if (format != "fbx") return;
  mesh.unit_m = 0.01;
  if (scene.mMetaData == nullptr) return;
  float unit_cm = 0.0F;
  double unit_cm_double = 0.0;
  if (scene.mMetaData->Get("UnitScaleFactor", unit_cm_double))
    unit_cm = float(unit_cm_double);
  else
    (void)scene.mMetaData->Get("UnitScaleFactor", unit_cm);
  if (unit_cm > 0.0F) mesh.unit_m = 0.01 * static_cast<double>(unit_cm);
  int up = 1;
  if (scene.mMetaData->Get("UpAxis", up)) mesh.y_up = up == 1;
}

/// Checks the lengths in a binary glTF file's header, as much as which assimp would allocate.
void CheckGlb(const std::string& bytes, const std::string& shown) {
  constexpr std::size_t kHeaderBytes = 20;
  const auto number_at = [&](std::size_t place) {
    std::uint32_t number = 0;
    std::memcpy(&number, bytes.data() + place, sizeof(number));
    return number;
  };
  if (bytes.size() < kHeaderBytes) throw InputError(shown + ": ends within its header");
  if (number_at(4) != 2)
    throw InputError(shown + ": must be glTF of version 2" + Got(number_at(4)));
  if (number_at(12) > bytes.size() - kHeaderBytes) {
    throw InputError(shown + ": ends within its first chunk of " + std::to_string(number_at(12)) +
                     " bytes");
  }
}

}  // namespace

bool HasAssimp() {
  return true;
}

SceneMesh ReadScene(const std::string& bytes,
                    const std::string& format,
                    const std::filesystem::path& file,
                    const std::string& shown) {
  if (format == "glb") CheckGlb(bytes, shown);
  Assimp::Importer importer;
  // Everything but triangles' corners only takes time.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                              aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                  aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS |
                                  aiComponent_ANIMATIONS | aiComponent_TEXTURES |
                                  aiComponent_LIGHTS | aiComponent_CAMERAS);
  const unsigned flags = aiProcess_RemoveComponent;
  // A glTF file in JSON may name others beside it, which assimp finds by the file's own name.
  const aiScene* scene =
      format == "gltf" && file.extension() == ".gltf"
          ? importer.ReadFile(file.string(), flags)
          : importer.ReadFileFromMemory(bytes.data(), bytes.size(), flags, format.c_str());
  if (scene == nullptr) {
    throw InputError(shown + ": cannot be read as " + format + ": " +
                     ShownText(importer.GetErrorString()));
  }
  SceneMesh mesh{.soup = SceneGatherer(*scene, shown).Gather()};
  TakeUnits(*scene, format, mesh);
  return mesh;
}

}  // namespace railcast
