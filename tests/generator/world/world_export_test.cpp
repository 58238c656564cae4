#include "generator/world/world_export.h"

#include <gtest/gtest.h>
#include <pcl/PolygonMesh.h>
#include <pcl/console/print.h>
#include <pcl/conversions.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include "core/io/write_file.h"
#include "railcast/scenario.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/world/example_world.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

TEST(ExportWorld, GathersByLabelAndMaterialInTheChunksFrame) {
  const ExportedWorld exported = ExportWorld(ExampleWorld(), {0}, {0, 1}, 2'000'000'000);
  ASSERT_EQ(exported.parts.size(), 3U);
  EXPECT_EQ(exported.parts[0].mesh.vertices[1], Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(exported.parts[1].material, 2);
  EXPECT_EQ(exported.parts[1].mesh.vertices[1], Eigen::Vector3f(12, 0, 0));
  // The first object moved 2 m in 2 s; the other belongs to another chunk.
  EXPECT_EQ(exported.parts[2].label, 12U);
  EXPECT_EQ(exported.parts[2].mesh.vertices.size(), 3U);
  EXPECT_EQ(exported.parts[2].mesh.vertices[0], Eigen::Vector3f(22, 0, 3));
}

// An arc of 500 m with boxes on and beside the track at the boundaries of chunks.
ScenarioSpec ArcWithBoxes() {
  ScenarioSpec scenario = ReadScenario(kScenariosFolder + "minimal.json");
  WorldSpec& world = scenario.world;
  scenario.vehicle.start_s_m = 0.0;
  world.alignment.course = AlignmentElementsSpec{{{ElementType::kArc, 500.0, -500.0}}};
  world.terrain.half_width_m = 20.0;
  world.vegetation.trees_per_hectare = 0.0;
  world.vegetation.grass = false;
  for (int i = 0; i <= 10; ++i) {
    for (const double d_m : {-15.0, 0.0, 15.0}) {
      ObjectSpec box;
      box.name = "box " + std::to_string(world.objects.size());
      box.type = ObjectType::kBox;
      box.s_m = 50.0 * i;
      box.d_m = d_m;
      box.size_m = {1.0, 1.0, 1.0};
      world.objects.push_back(box);
    }
  }
  return scenario;
}

std::size_t NumBoxTriangles(const ScenarioSpec& scenario,
                            const RailWorld& world,
                            const std::vector<int>& chunks) {
  const ExportedWorld exported = ExportWorld(world, chunks, ChunksOfObjects(world, 0), 0);
  std::size_t num_triangles = 0;
  for (const Part& part : exported.parts) {
    const bool is_box = part.label == LabelTable(scenario.labels).Id("object");
    num_triangles += is_box ? part.mesh.triangles.size() : 0;
  }
  return num_triangles;
}

TEST(ExportWorld, TakesEveryObjectOfACurvedLineOnce) {
  constexpr std::size_t kTrianglesOfABox = 12;
  const ScenarioSpec scenario = ArcWithBoxes();
  const auto world = MakeWorld(scenario);
  EXPECT_EQ(NumBoxTriangles(scenario, *world, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}),
            33 * kTrianglesOfABox);
  // A box at the end of a chunk belongs to the next chunk; at the end of the line, to the last one.
  EXPECT_EQ(NumBoxTriangles(scenario, *world, {4}), 3 * kTrianglesOfABox);
  EXPECT_EQ(NumBoxTriangles(scenario, *world, {9}), 6 * kTrianglesOfABox);
}

TEST(EncodePlyMesh, IsReadByPcl) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "world.ply";
  WriteFileWhole(file, EncodePlyMesh(ExportWorld(ExampleWorld(), {0}, {0, 1}, 0), ExampleLabels()));
  // PCL warns of the faces' colours, labels and materials, which its meshes have no place for.
  pcl::console::setVerbosityLevel(pcl::console::L_ERROR);
  pcl::PolygonMesh mesh;
  ASSERT_EQ(pcl::io::loadPLYFile(file.string(), mesh), 0);
  ASSERT_EQ(mesh.polygons.size(), 3U);
  pcl::PointCloud<pcl::PointXYZ> vertices;
  pcl::fromPCLPointCloud2(mesh.cloud, vertices);
  ASSERT_EQ(vertices.size(), 9U);
  EXPECT_EQ(mesh.polygons[2].vertices, (pcl::Indices{6, 7, 8}));
  EXPECT_EQ(vertices[6].x, 20.0F);
}

TEST(EncodeObjMesh, NamesLabelsAndMaterials) {
  SimpleWorld world;
  world.ground = *Triangle(1, 1);
  const std::string text = EncodeObjMesh(ExportWorld(world, {0}, {}, 0), ExampleLabels(),
                                         MaterialLibrary({{"rail_head", 0.08}}));
  EXPECT_EQ(text,
            "# world_from_export 1 0 0 0 0 1 0 0 0 0 1 0\no rail\nusemtl rail_head\n"
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
}

}  // namespace
}  // namespace railcast
