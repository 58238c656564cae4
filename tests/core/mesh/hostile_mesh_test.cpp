// Mesh files of some kB that are made to bring a program down: nested without end, multiplied
// without end, or with a face that takes minutes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "core/base/error.h"
#include "core/mesh/assimp_reader.h"
#include "tests/core/io/message_of.h"
#include "tests/core/mesh/imported_meshes.h"
#include "tests/core/mesh/made_scenes.h"
#include "tests/support/memory_limit.h"

namespace railcast {
namespace {

class HostileMesh : public testing::Test {
 protected:
  void SetUp() override {
    if (!HasAssimp()) GTEST_SKIP() << "built without assimp";
  }

  static std::string ComplaintOf(const std::string& bytes) {
    return MessageOf([&] { (void)ParseMesh(bytes, "a.mesh"); });
  }
  static std::string BrokeOff(const std::string& format) {
    return "a.mesh: cannot be read as " + format +
           ": it is damaged or nested too deeply, and assimp broke off";
  }
};

std::string DaeNode(const std::string& content) {
  return "<node>" + content + "</node>";
}

TEST_F(HostileMesh, IsReadWith5000NestedNodesOfGltf) {
  std::string nodes;
  for (int i = 1; i <= 5000; ++i) {
    nodes += "{\"children\": [" + std::to_string(i) + "], \"translation\": [0.5, 0, 0]}, ";
  }
  const ImportedMesh mesh = ParseMesh(TriangleGltf(nodes + "{\"mesh\": 0}"), "a.mesh");
  EXPECT_EQ(mesh.num_triangles(), 1U);
  EXPECT_NEAR(mesh.origin_m.x(), 2500.5, 1e-9);
}

TEST_F(HostileMesh, IsReadWith5000NestedNodesOfDae) {
  const std::string nodes = Repeated("<node>", 5000) + DaeNode("<instance_geometry url=\"#g\"/>") +
                            Repeated("</node>", 5000);
  EXPECT_EQ(ParseMesh(TriangleDae(nodes), "a.mesh").num_triangles(), 1U);
}

TEST_F(HostileMesh, WhoseNodeHoldsItselfIsRefused) {
  EXPECT_EQ(ComplaintOf(TriangleDae("<node id=\"a\"><instance_node url=\"#a\"/></node>")),
            BrokeOff("dae"));
}

TEST_F(HostileMesh, OfJsonNested200000DeepIsRefused) {
  const std::string levels = Repeated("[", 200'000) + Repeated("]", 200'000);
  EXPECT_EQ(ComplaintOf(R"({"asset": {"version": "2.0"}, "extras": )" + levels + "}"),
            BrokeOff("gltf"));
}

TEST_F(HostileMesh, OfFbxScopesNested200000DeepIsRefused) {
  const std::string header =
      "; FBX 7.3.0 project file\nFBXHeaderExtension: {\nFBXHeaderVersion: 1003\n"
      "FBXVersion: 7300\n}\n";
  EXPECT_EQ(ComplaintOf(header + Repeated("A: {\n", 200'000) + Repeated("}\n", 200'000)),
            BrokeOff("fbx"));
}

// 2^41 nodes in 1.4 kB.
TEST_F(HostileMesh, OfNodesThatDoubleIsRefused) {
  if (!kCanLimitMemory) GTEST_SKIP() << "sanitizers reserve more than can be limited";
  std::string nodes;
  for (int i = 1; i <= 41; ++i) {
    const std::string next = std::to_string(i);
    nodes += "{\"children\": [" + next + ", " + next + "]}, ";
  }
  EXPECT_EQ(ComplaintOf(TriangleGltf(nodes + "{\"mesh\": 0}")),
            "a.mesh: must not take more than 600 MB of memory to read");
}

/// A regular polygon.
std::string PolygonObj(int num_corners) {
  std::ostringstream text;
  for (int i = 0; i < num_corners; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / num_corners;
    text << "v " << std::cos(angle_rad) << ' ' << std::sin(angle_rad) << " 0\n";
  }
  text << 'f';
  for (int i = 1; i <= num_corners; ++i) text << ' ' << i;
  return text.str() + '\n';
}

TEST(HostileFace, Of600000CornersIsRefused) {
  std::string error;
  try {
    (void)ParseMesh(PolygonObj(600'000), "a.obj");
  } catch (const InputError& thrown) {
    error = thrown.what();
  }
  EXPECT_EQ(error, "a.obj: face 0 must have at most 10000 corners (got 600000)");
  EXPECT_EQ(ParseMesh(PolygonObj(2000), "a.obj").num_triangles(), 1998U);
}

}  // namespace
}  // namespace railcast
