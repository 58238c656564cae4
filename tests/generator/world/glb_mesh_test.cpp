#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "core/mesh/mesh_import.h"
#include "generator/world/world_export.h"
#include "railcast/scenario.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/world/example_world.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

// An independent reader: by it, positions are turned to y up and colours are linear.
TEST(EncodeGlbMesh, IsReadByAssimp) {
  const ExportedWorld exported = ExportWorld(ExampleWorld(), {0}, {0, 1}, 0);
  const LabelTable labels = ExampleLabels();
  const std::string bytes =
      EncodeGlbMesh(exported, labels, MaterialLibrary({{"rail_head", 0.08}, {"soil", 0.25}}));
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(),
                                                     aiProcess_PreTransformVertices, "glb");
  ASSERT_NE(scene, nullptr) << importer.GetErrorString();
  std::map<std::string, const aiMesh*> meshes;  // By material; two are of rail_head.
  ASSERT_GE(scene->mNumMeshes, 2U);
  std::size_t num_faces = 0;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    const aiMesh& mesh = *scene->mMeshes[i];
    meshes[scene->mMaterials[mesh.mMaterialIndex]->GetName().C_Str()] = &mesh;
    num_faces += mesh.mNumFaces;
  }
  EXPECT_EQ(num_faces, 3U);
  const aiMesh& placed = *meshes.at("soil");
  ASSERT_EQ(placed.mNumVertices, 3U);
  // Twice as large at (10, 0, 0): its third vertex is (10, 2, 0) with z up.
  EXPECT_NEAR(placed.mVertices[2].x, 10.0F, 1e-5F);
  EXPECT_NEAR(placed.mVertices[2].y, 0.0F, 1e-5F);
  EXPECT_NEAR(placed.mVertices[2].z, -2.0F, 1e-5F);
  ASSERT_TRUE(placed.HasVertexColors(0));
  const std::array<float, 3> shares = {placed.mColors[0][0].r, placed.mColors[0][0].g,
                                       placed.mColors[0][0].b};
  for (std::size_t i = 0; i < 3; ++i) {
    const float srgb = shares[i] <= 0.0031308F ? 12.92F * shares[i]
                                               : 1.055F * std::pow(shares[i], 1.0F / 2.4F) - 0.055F;
    EXPECT_EQ(std::lround(255.0F * srgb), labels.Find(1)->rgb.at(i));
  }
}

// What we export is what we read: the same triangles, and materials by their names.
TEST(EncodeGlbMesh, IsReadAsAMesh) {
  const ExportedWorld exported = ExportWorld(ExampleWorld(), {0}, {0, 1}, 0);
  const ImportedMesh mesh = ParseMesh(
      EncodeGlbMesh(exported, ExampleLabels(), MaterialLibrary({{"rail_head", 0.08}, {"soil", 1}})),
      "world.glb");
  EXPECT_EQ(mesh.num_triangles(), 3U);
  EXPECT_NEAR(mesh.area_m2, 0.5 + 2.0 + 0.5, 1e-6);
  ASSERT_EQ(mesh.parts.size(), 3U);
  EXPECT_EQ(mesh.parts[1].material, "soil");
  EXPECT_EQ(mesh.parts[1].group, ExampleLabels().Find(1)->name);
  EXPECT_TRUE(mesh.origin_m.isApprox(Vector3(10.5, 1.0, 1.5), 1e-6)) << mesh.origin_m.transpose();
}

// The judge of the format itself. It is looked for where NODE_PATH says.
TEST(EncodeGlbMesh, PassesTheValidatorOfKhronos) {
  if (RunCommand("node -e 'require.resolve(\"gltf-validator\")'").status != 0) {
    GTEST_SKIP() << "node or npm's gltf-validator is missing";
  }
  ScenarioSpec scenario = ReadScenario(kScenariosFolder + "station.json");
  scenario.world.vegetation.trees_per_hectare = 0.0;
  scenario.world.vegetation.grass = false;
  const auto world = MakeWorld(scenario);
  const std::vector<int> chunks = {2, 3};  // Both have parts without triangles.
  const ExportedWorld exported = ExportWorld(*world, chunks, ChunksOfObjects(*world, 0), 0);
  std::size_t num_triangles = 0;
  for (const Part& part : exported.parts) num_triangles += part.mesh.triangles.size();
  const TemporaryDirectory directory;
  const auto file = directory.path() / "world.glb";
  WriteFileWhole(file, EncodeGlbMesh(exported, LabelTable(scenario.labels),
                                     MaterialLibrary(scenario.materials)));
  const Ended judged = RunCommand(
      "node " RAILCAST_SOURCE_DIR "/tests/generator/world/validate_glb.cjs " + file.string());
  EXPECT_EQ(judged.said, std::to_string(num_triangles) + " triangles\n");
}

}  // namespace
}  // namespace railcast
