#include "core/mesh/mesh_readers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/base/error.h"
#include "core/mesh/mesh_import.h"
#include "tests/core/io/message_of.h"
#include "tests/core/mesh/imported_meshes.h"

namespace railcast {
namespace {

using std::filesystem::path;

class ReadObjTest : public testing::Test {
 protected:
  /// Writes a file used by this test only and returns its path.
  path Write(const std::string& text) {
    const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
    file_ = path(testing::TempDir()) / ("railcast_" + test + ".obj");
    std::ofstream(file_) << text;
    return file_;
  }
  void TearDown() override { std::filesystem::remove(file_); }

  /// The message of ReadObj about a text, without the file name.
  std::string Complaint(const std::string& text) {
    try {
      (void)ReadMesh(Write(text));
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find(file_.string() + ": "), 0U);
      return what.substr(file_.string().size() + 2);
    }
    return "";
  }

 private:
  path file_;
};

constexpr const char* kThreeVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST_F(ReadObjTest, ListsAllLinesWithFaultsButNoMoreThanTwenty) {
  const std::string faults =
      Complaint("v 0 0 x\nv 1 0 0\nv 0 1 nan\nf 1 2 3\nf 1 2 0\nf 1 2 9\nf 1 b 3\n");
  const std::string file = (path(testing::TempDir()) / "railcast_").string() +
                           "ListsAllLinesWithFaultsButNoMoreThanTwenty.obj: ";
  EXPECT_EQ(faults, "line 1: a vertex must have three finite coordinates (got \"x\")\n" + file +
                        "line 3: a vertex must have three finite coordinates (got \"nan\")\n" +
                        file + "line 5: a face must name one of the 3 vertices (got \"0\")\n" +
                        file + "line 7: a face must name vertices by number (got \"b\")\n" + file +
                        "line 6: a face must name one of the 3 vertices (got \"9\")");
  std::string many;
  for (int i = 0; i < 1000; ++i) many += "v 0 0 x\n";
  const std::string twenty = Complaint(many);
  EXPECT_EQ(std::count(twenty.begin(), twenty.end(), '\n'), 19);
  EXPECT_NE(twenty.find("line 19: "), std::string::npos);
  EXPECT_EQ(twenty.find("line 20: "), std::string::npos);
  EXPECT_NE(twenty.find("goes on; this many faults are listed at most"), std::string::npos);
}

TEST_F(ReadObjTest, KeepsFacesThatShareAnEdgeThreeTimes) {
  const Mesh mesh = ReadMerged(Write("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\n"
                                     "f 1 2 3\nf 1 2 4\nf 1 2 5\n"),
                               1.0, false);
  EXPECT_EQ(mesh.triangles.size(), 3U);
  EXPECT_EQ(mesh.vertices.size(), 5U);
}

TEST_F(ReadObjTest, ConvertsUnitsAndTurnsYUp) {
  const ImportedMesh read =
      ReadMesh(Write("v 100 200 300\nv 200 200 300\nv 100 500 300\nf 1 2 3\n"), {0.01, true});
  EXPECT_TRUE(Bounds(Merged(read))
                  .translated(read.origin_m)
                  .isApprox(Eigen::AlignedBox3d(Vector3(1, -3, 2), Vector3(2, -3, 5)), 1e-6));
}

TEST_F(ReadObjTest, UnderstandsNegativeIndicesGroupsContinuationsAndCarriageReturns) {
  const Mesh mesh =
      ReadMerged(Write("mtllib none.mtl\r\ng one f 1 2 3\r\nv 0 0 \\\r\n0\r\nv 1 0 0\r\n"
                       "vt 0 0\nusemtl x\nv 0 1 0 0.5 nan 1\nf -3/1 -2/1/1 -1//1 # ok\n"
                       "v 9 9 9"),
                 1.0, false);
  ASSERT_EQ(mesh.triangles.size(), 1U);
  EXPECT_EQ(mesh.vertices.size(), 3U) << "the last vertex is unused";
  EXPECT_DOUBLE_EQ(Area(mesh), 0.5);
}

TEST_F(ReadObjTest, GoesOnInTheNextLineOnlyWhereGeometryDoes) {
  const Mesh mesh = ReadMerged(Write("# C:\\\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl C:\\paint\\\n"
                                     "f 1 2 3# one \\\nf 1 2 \\\n3\n"),
                               1.0, false);
  EXPECT_EQ(mesh.triangles.size(), 2U);
}

TEST_F(ReadObjTest, UnderstandsPlusSigns) {
  const Mesh mesh = ReadMerged(Write("v 0 0 0\nv +1e0 0 0\nv 0 +.5 +0\nf +1 +2 +3\n"), 1.0, false);
  ASSERT_EQ(mesh.triangles.size(), 1U);
  EXPECT_DOUBLE_EQ(Area(mesh), 0.25);
}

// OpenMesh's reader skips a coordinate that it cannot parse, and with it the vertex.
TEST_F(ReadObjTest, CountsAVertexWithTheSmallestAndTheLongestNumbers) {
  const std::string digits(1000, '1');
  const Mesh mesh = ReadMerged(Write("v 1e-310 -1e-46 4.9e-324\nv 1." + digits + " 0 0\nv 0 0." +
                                     digits + "e1 -0\nf 1 -2 -1\n"),
                               1.0, false);
  ASSERT_EQ(mesh.triangles.size(), 1U);
  EXPECT_NEAR(Area(mesh), 0.5 * 10.0 / 9.0 * 10.0 / 9.0, 1e-6);
}

TEST_F(ReadObjTest, CutsAConcaveFaceIntoItsOwnArea) {
  const Mesh mesh =
      ReadMerged(Write("v 0 0 0\nv 0 3 0\nv 0 3 2\nv 0 2 2\nv 0 2 1\nv 0 1 1\nv 0 1 2\nv 0 0 2\n"
                       "f 1 2 3 4 5 6 7 8\n"),
                 1.0, false);
  EXPECT_EQ(mesh.triangles.size(), 6U);
  EXPECT_NEAR(Area(mesh), 5.0, 1e-6);
}

/// A polyhedron's vertices, moved.
std::string Moved(const std::string& vertices, const Vector3& by) {
  std::istringstream in(vertices);
  std::ostringstream out;
  out.precision(17);
  std::string v;
  for (Vector3 p; in >> v >> p.x() >> p.y() >> p.z();) {
    out << "v " << p.x() + by.x() << ' ' << p.y() + by.y() << ' ' << p.z() + by.z() << '\n';
  }
  return out.str();
}

// In float32, the northing of a place in UTM coordinates has steps of 0.5 m.
TEST_F(ReadObjTest, KeepsTrianglesAndAreaAtAnyOrigin) {
  const std::string vertices =
      "v 0 0 0\nv 0.25 0 0\nv 0.25 0.0625 0\nv 0 0.0625 0\nv 0.125 0.03125 0.5\n";
  const std::string faces = "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 4 3 2 1\n";
  const Mesh here = ReadMerged(Write(vertices + faces), 1.0, false);
  const Vector3 utm(447240.0, 5411935.0, 267.0);
  const ImportedMesh there = ReadMesh(Write(Moved(vertices, utm) + faces));
  EXPECT_EQ(Merged(there).triangles, here.triangles);
  EXPECT_EQ(Merged(there).vertices, here.vertices);
  EXPECT_EQ(there.origin_m, utm + Vector3(0.125, 0.03125, 0.25));
}

// The outline goes from corner `from` to the window, around it the other way and back.
TEST_F(ReadObjTest, KeepsTheAreaOfAPlateWithAWindow) {
  const std::string vertices =
      "v 0 0 0\nv 4 0 0\nv 4 0 3\nv 0 0 3\nv 1 0 1\nv 3 0 1\nv 3 0 2\nv 1 0 2\n";
  for (int from = 0; from < 4; ++from) {
    for (int to = 0; to < 4; ++to) {
      std::string face = "f";
      for (int i = 0; i <= 4; ++i) face += ' ' + std::to_string(1 + (from + i) % 4);
      for (int i = 4; i >= 0; --i) face += ' ' + std::to_string(5 + (to + i) % 4);
      // From a corner on the far side, the way crosses the window: no outline of a face.
      if ((from - to + 4) % 4 == 2) continue;
      EXPECT_NEAR(Area(ReadMerged(Write(vertices + face + '\n'), 1.0, false)), 10.0, 1e-5) << face;
    }
  }
}

// It has no area by the formula, but it is there.
TEST_F(ReadObjTest, KeepsAFaceThatGoesThereAndBack) {
  const Mesh mesh = ReadMerged(Write(std::string(kThreeVertices) + "f 1 2 3 2\n"), 1.0, false);
  EXPECT_DOUBLE_EQ(Area(mesh), 2.0 * 0.5);
}

// A square with a triangle perpendicular to it on one edge: seen from above, the triangle has no
// area.
TEST_F(ReadObjTest, KeepsATriangleThatStandsUprightOnItsFace) {
  const Mesh mesh = ReadMerged(
      Write("v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nv 0 1 -1\nf 1 2 3 4 5\n"), 1.0, true);
  EXPECT_EQ(mesh.triangles.size(), 3U);
}

TEST_F(ReadObjTest, PassesOverAByteOrderMark) {
  const Mesh mesh =
      ReadMerged(Write("\xEF\xBB\xBF" + std::string(kThreeVertices) + "f 1 2 3\n"), 1.0, false);
  EXPECT_EQ(mesh.triangles.size(), 1U);
}

TEST_F(ReadObjTest, DropsTrianglesWithoutArea) {
  const Mesh mesh = ReadMerged(
      Write(std::string(kThreeVertices) + "v 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 2\n"), 1.0, false);
  EXPECT_EQ(mesh.triangles.size(), 1U);
}

TEST_F(ReadObjTest, LeavesOutFacesThatLackCorners) {
  const ImportedMesh mesh = ReadMesh(Write(std::string(kThreeVertices) + "f 1 2 3\nf 1 2\n"));
  EXPECT_EQ(mesh.num_faces, 1U);
  EXPECT_EQ(mesh.num_cornerless, 1U);
}

TEST_F(ReadObjTest, TellsOfWordsThatAreNotRead) {
  const ImportedMesh mesh =
      ReadMesh(Write(std::string(kThreeVertices) + "f 1 2 3\nF 1 2 3\nsurf 0 1 0 1 1 2 3\n"));
  ASSERT_EQ(mesh.remarks.size(), 1U);
  EXPECT_EQ(mesh.remarks[0].kind, RemarkKind::kExtensionUnread);
  EXPECT_EQ(mesh.remarks[0].number, 2U);
  EXPECT_EQ(mesh.remarks[0].detail, "F");
}

TEST_F(ReadObjTest, RefusesAFileThatIsNotThere) {
  EXPECT_EQ(MessageOf([&] { (void)ReadMesh("/nowhere/wagon.obj"); }),
            "/nowhere/wagon.obj: no such file or directory");
  EXPECT_THROW((void)ReadMesh(testing::TempDir()), InputError);
}

TEST_F(ReadObjTest, RefusesAFileWithoutATriangle) {
  EXPECT_EQ(Complaint(""), "holds no triangle");
  EXPECT_EQ(Complaint(kThreeVertices), "holds no triangle");
  EXPECT_EQ(Complaint(std::string(kThreeVertices) + "f 1 2 1\nl 1 2\n"), "holds no triangle");
}

TEST_F(ReadObjTest, RefusesAnIndexOfNoVertex) {
  const std::string vertices = kThreeVertices;
  const std::string rule = "line 4: a face must name one of the 3 vertices (got ";
  EXPECT_EQ(Complaint(vertices + "f 1 2 4\n"), rule + "\"4\")");
  EXPECT_EQ(Complaint(vertices + "f 0 1 2\n"), rule + "\"0\")");
  EXPECT_EQ(Complaint(vertices + "f -1 -2 -4/1\n"), rule + "\"-4\")");
  EXPECT_EQ(Complaint(vertices + "f 1 2 two\n"),
            "line 4: a face must name vertices by number (got \"two\")");
  EXPECT_EQ(Complaint(vertices + "f 1 2 +-1\n"),
            "line 4: a face must name vertices by number (got \"+-1\")");
  EXPECT_EQ(Complaint(vertices + "f 1 2 99999999999\n"),
            "line 4: a face must name vertices by number (got \"99999999999\")");
}

TEST_F(ReadObjTest, RefusesACoordinateThatIsNoFiniteNumber) {
  const std::string rule = "line 2: a vertex must have three finite coordinates (got ";
  EXPECT_EQ(Complaint("# x\nv 0 nan 0\n"), rule + "\"nan\")");
  EXPECT_EQ(Complaint("# x\nv 0 -inf 0\n"), rule + "\"-inf\")");
  EXPECT_EQ(Complaint("# x\nv 0 1e39 0\n"), rule + "\"1e39\")");
  EXPECT_EQ(Complaint("# x\nv 0 1,5 0\n"), rule + "\"1,5\")");
  EXPECT_EQ(Complaint("# x\nv 0 1\n"), rule + "\"\")");
  EXPECT_EQ(Complaint("# x\nv 0 \x1b" + std::string(100, '0') + " 0\n"),
            rule + "\"\\u001b" + std::string(54, '0') + "...\")");
  EXPECT_EQ(Complaint("# x\nv 1 1 +-1\n"), rule + "\"+-1\")");
  // Finite in kilometres but not in metres.
  EXPECT_THROW((void)ReadMesh(Write("v 0 1e38 0\n"), {1000.0, false}), InputError);
}

TEST_F(ReadObjTest, KeepsTheNamesOfMaterialsAndGroups) {
  const ImportedMesh mesh =
      ReadMesh(Write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\ng left side \nusemtl Glass 1\nf 1 3 2\n"
                     "usemtl paint\nf 1 2 3\ng\nusemtl Glass 1\nf 1 2 3\ng left side\nf 2 3 1\n"));
  ASSERT_EQ(mesh.parts.size(), 4U);
  const auto names = [&](std::size_t i) {
    return std::pair(mesh.parts[i].group, mesh.parts[i].material);
  };
  EXPECT_EQ(names(0), std::pair(std::string(), std::string()));
  EXPECT_EQ(names(1), std::pair(std::string("left side"), std::string("Glass 1")));
  EXPECT_EQ(names(2), std::pair(std::string("left side"), std::string("paint")));
  EXPECT_EQ(names(3), std::pair(std::string(), std::string("Glass 1")));
  EXPECT_EQ(mesh.parts[1].mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.num_faces, 5U);
}

}  // namespace
}  // namespace railcast
