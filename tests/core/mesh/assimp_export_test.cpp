// One model in every format that assimp writes and we read: a sphere of two materials, turned by
// its node, has the same triangles and area in each.
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <assimp/Exporter.hpp>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <memory>
#include <numbers>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/core/io/temporary_directory.h"
#include "tests/core/mesh/imported_meshes.h"

namespace railcast {
namespace {

constexpr unsigned kRings = 12;
constexpr unsigned kSectors = 24;
constexpr double kRadius = 2.0;

aiVector3D OnSphere(double elevation_rad, unsigned sector) {
  const double azimuth_rad = 2.0 * std::numbers::pi * sector / kSectors;
  return {static_cast<ai_real>(kRadius * std::cos(elevation_rad) * std::cos(azimuth_rad)),
          static_cast<ai_real>(kRadius * std::cos(elevation_rad) * std::sin(azimuth_rad)),
          static_cast<ai_real>(kRadius * std::sin(elevation_rad))};
}

double AreaOf(const aiVector3D& a, const aiVector3D& b, const aiVector3D& c) {
  return 0.5 * static_cast<double>(((b - a) ^ (c - a)).Length());
}

/// Half of the sphere as triangles: from the equator to the pole above or below it.
struct HalfSphere {
  std::vector<aiVector3D> corners;
  std::vector<std::array<unsigned, 3>> triangles;
  double area{};

  explicit HalfSphere(double side) {
    const auto add = [this](const aiVector3D& a, const aiVector3D& b, const aiVector3D& c) {
      const auto first = static_cast<unsigned>(corners.size());
      corners.insert(corners.end(), {a, b, c});
      triangles.push_back({first, first + 1, first + 2});
      area += AreaOf(a, b, c);
    };
    constexpr double kStep_rad = std::numbers::pi / kRings;
    for (unsigned ring = 0; ring < kRings / 2; ++ring) {
      const double low_rad = side * kStep_rad * ring;
      const double high_rad = side * kStep_rad * (ring + 1);
      for (unsigned sector = 0; sector < kSectors; ++sector) {
        const aiVector3D a = OnSphere(low_rad, sector);
        const aiVector3D b = OnSphere(low_rad, sector + 1);
        add(a, b, OnSphere(high_rad, sector + 1));
        if (ring + 1 < kRings / 2)
          add(a, OnSphere(high_rad, sector + 1), OnSphere(high_rad, sector));
      }
    }
  }

  [[nodiscard]] aiMesh* Mesh(unsigned material) const {
    auto mesh = std::make_unique<aiMesh>();
    mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
    mesh->mMaterialIndex = material;
    mesh->mNumVertices = static_cast<unsigned>(corners.size());
    mesh->mVertices = new aiVector3D[corners.size()];
    mesh->mNormals = new aiVector3D[corners.size()];
    for (std::size_t i = 0; i < corners.size(); ++i) {
      mesh->mVertices[i] = corners[i];
      mesh->mNormals[i] = aiVector3D(corners[i]).Normalize();
    }
    mesh->mNumFaces = static_cast<unsigned>(triangles.size());
    mesh->mFaces = new aiFace[triangles.size()];
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      mesh->mFaces[i].mNumIndices = 3;
      mesh->mFaces[i].mIndices = new unsigned[3]{triangles[i][0], triangles[i][1], triangles[i][2]};
    }
    return mesh.release();
  }
};

/// The two halves in a node below the root that moves and turns them. assimp frees what it holds.
std::unique_ptr<aiScene> SphereScene(const HalfSphere& upper, const HalfSphere& lower) {
  auto scene = std::make_unique<aiScene>();
  scene->mNumMaterials = 2;
  scene->mMaterials = new aiMaterial*[2];
  for (unsigned i = 0; i < 2; ++i) {
    scene->mMaterials[i] = new aiMaterial();
    const aiString name(i == 0 ? "Glass" : "Brick");
    scene->mMaterials[i]->AddProperty(&name, AI_MATKEY_NAME);
  }
  scene->mNumMeshes = 2;
  scene->mMeshes = new aiMesh* [2] { upper.Mesh(0), lower.Mesh(1) };
  scene->mRootNode = new aiNode("root");
  auto* node = new aiNode("body");
  node->mNumMeshes = 2;
  node->mMeshes = new unsigned[2]{0, 1};
  node->mTransformation = aiMatrix4x4(aiVector3D(1, 1, 1), aiQuaternion(aiVector3D(0, 1, 0), 0.3F),
                                      aiVector3D(1, 2, 3));
  scene->mRootNode->addChildren(1, &node);
  return scene;
}

struct ExportedFile {
  std::string format;  ///< assimp's name.
  std::string name;
  double unit_m = 1.0;  ///< What the file says, if it says anything.
};

class AssimpExportsOf : public testing::TestWithParam<ExportedFile> {};

TEST_P(AssimpExportsOf, KeepTrianglesAreaAndHeight) {
  const HalfSphere upper(1.0);
  const HalfSphere lower(-1.0);
  const std::size_t num_triangles = upper.triangles.size() + lower.triangles.size();
  const double area = upper.area + lower.area;
  const auto& [format, name, unit_m] = GetParam();
  const TemporaryDirectory folder;
  const std::string file = (folder.path() / name).string();
  Assimp::Exporter exporter;
  const auto scene = SphereScene(upper, lower);
  ASSERT_EQ(exporter.Export(scene.get(), format.c_str(), file.c_str()), AI_SUCCESS)
      << exporter.GetErrorString();
  const Mesh mesh = Merged(ReadMesh(file));
  EXPECT_EQ(mesh.triangles.size(), num_triangles);
  EXPECT_NEAR(Area(mesh), area * unit_m * unit_m, 1e-5 * area * unit_m * unit_m);
  // A closed sphere is as high however it is turned, but for its facets.
  const double height = Bounds(mesh).sizes().z();
  EXPECT_NEAR(height, 2.0 * kRadius * unit_m, 0.04 * unit_m);
}

// assimp gives every mesh a material; the file's meshes shall have none.
TEST(AssimpExports, NameFacesWithoutMaterialByTheColoursOfVertices) {
  const auto scene = SphereScene(HalfSphere(1.0), HalfSphere(-1.0));
  for (unsigned i = 0; i < 2; ++i) {
    aiMesh& mesh = *scene->mMeshes[i];
    mesh.mColors[0] = new aiColor4D[mesh.mNumVertices];
    const aiColor4D color = i == 0 ? aiColor4D(1.0F, 0.0F, 0.0F, 1.0F) : aiColor4D(0, 0, 0.2F, 1);
    std::fill_n(mesh.mColors[0], mesh.mNumVertices, color);
  }
  const TemporaryDirectory folder;
  const std::string file = (folder.path() / "it.gltf").string();
  Assimp::Exporter exporter;
  ASSERT_EQ(exporter.Export(scene.get(), "gltf2", file), AI_SUCCESS) << exporter.GetErrorString();
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  std::ofstream(file) << std::regex_replace(text.str(), std::regex(R"("material": \d,)"), "");
  const ImportedMesh imported = ReadMesh(file);
  ASSERT_EQ(imported.parts.size(), 2U);
  EXPECT_EQ(imported.parts[0].material, "#ff0000");
  EXPECT_EQ(imported.parts[1].material, "#000033");
}

INSTANTIATE_TEST_SUITE_P(EveryFormat,
                         AssimpExportsOf,
                         testing::Values(ExportedFile{"obj", "it.obj"},
                                         ExportedFile{"ply", "it_ascii.ply"},
                                         ExportedFile{"plyb", "it.ply"},
                                         ExportedFile{"stl", "it_ascii.stl"},
                                         ExportedFile{"stlb", "it.stl"},
                                         ExportedFile{"collada", "it.dae"},
                                         ExportedFile{"3ds", "it.3ds"},
                                         ExportedFile{"gltf2", "it.gltf"},
                                         ExportedFile{"glb2", "it.glb"},
                                         ExportedFile{"fbxa", "it_ascii.fbx", 0.01}),
                         [](const auto& each) { return each.param.format; });

}  // namespace
}  // namespace railcast
