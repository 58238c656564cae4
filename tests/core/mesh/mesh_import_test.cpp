#include "core/mesh/mesh_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "core/mesh/assimp_reader.h"
#include "tests/core/io/message_of.h"
#include "tests/core/mesh/imported_meshes.h"
#include "tests/core/mesh/made_scenes.h"

namespace railcast {
namespace {

// A tetrahedron of legs 1, 2 and 3 in each format.
constexpr const char* kObj =
    "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
constexpr const char* kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
constexpr const char* kOff =
    "# by hand\nOFF\n4 4 6 # no edges are read\n0 0 0\n\n1 0 0\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n"
    "3 0 3 2\n3 1 2 3\n";

constexpr std::array<std::array<std::array<float, 3>, 3>, 4> kTriangles = {
    {{{{0, 0, 0}, {0, 2, 0}, {1, 0, 0}}},
     {{{0, 0, 0}, {1, 0, 0}, {0, 0, 3}}},
     {{{0, 0, 0}, {0, 0, 3}, {0, 2, 0}}},
     {{{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}}}};

std::string AsciiStl() {
  std::string text = "solid by hand\n";
  for (const auto& triangle : kTriangles) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const auto& [x, y, z] : triangle) {
      text += "  vertex " + std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(z) +
              '\n';
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid by hand\n";
}

/// Begins with "solid", as files of some programs do.
std::string BinaryStl() {
  std::string bytes = "solid, facet by facet";
  bytes.resize(80, ' ');
  const auto append = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  append(std::uint32_t{4});
  for (const auto& triangle : kTriangles) {
    append(std::array<float, 3>{});
    append(triangle);
    append(std::uint16_t{0});
  }
  return bytes;
}

/// glTF in JSON with its buffer within; y is up.
std::string Gltf() {
  return TriangleGltf(R"({"mesh": 0, "name": "body", "scale": [2, 2, 2]})");
}

TEST(ParseMesh, KnowsFormatsByTheirContent) {
  for (const std::string& bytes :
       {std::string(kObj), std::string(kPly), std::string(kOff), AsciiStl(), BinaryStl()}) {
    SCOPED_TRACE(bytes.substr(0, 20));
    const ImportedMesh mesh = ParseMesh(bytes, "wrong.dae");
    EXPECT_EQ(mesh.num_triangles(), 4U);
    EXPECT_EQ(mesh.num_faces, 4U);
    // Halves of the products of the legs, and a triangle of sides square roots of 5, 13 and 10.
    EXPECT_NEAR(mesh.area_m2, 1.0 + 3.0 + 1.5 + 3.5, 1e-6);
    EXPECT_NEAR(Area(Merged(mesh)), mesh.area_m2, 1e-6);
    EXPECT_TRUE(Bounds(Merged(mesh))
                    .translated(mesh.origin_m)
                    .isApprox(Eigen::AlignedBox3d(Vector3(0, 0, 0), Vector3(1, 2, 3)), 1e-6));
  }
}

TEST(ParseMesh, TakesUnitAndUpAxisFromAFileThatHasThem) {
  if (!HasAssimp()) GTEST_SKIP() << "built without assimp";
  const auto bounds = [](const ImportedMesh& mesh) {
    return Bounds(Merged(mesh)).translated(mesh.origin_m);
  };
  const ImportedMesh mesh = ParseMesh(Gltf(), "wrong.stl");
  ASSERT_EQ(mesh.parts.size(), 1U);
  EXPECT_EQ(mesh.parts[0].material, "Window");
  EXPECT_EQ(mesh.parts[0].group, "body");
  EXPECT_TRUE(bounds(mesh).isApprox(Eigen::AlignedBox3d(Vector3(0, 0, 0), Vector3(2, 0, 2)), 1e-6));
  const ImportedMesh given = ParseMesh(Gltf(), "a.gltf", {.unit_m = 0.5, .y_up = false});
  EXPECT_TRUE(
      bounds(given).isApprox(Eigen::AlignedBox3d(Vector3(0, 0, 0), Vector3(1, 1, 0)), 1e-6));
}

TEST(ParseMesh, TakesTheUnitThatACommentAtTheHeadNames) {
  const std::string triangle = "v 0 0 0\nv 2000 0 0\nv 0 2000 0\nf 1 2 3\n";
  const auto width_m = [](const std::string& text, const MeshUnits& units = {}) {
    return Bounds(Merged(ParseMesh(text, "a.obj", units))).sizes().x();
  };
  EXPECT_NEAR(width_m("# Rhino\n\n# File units = millimeters\n" + triangle), 2.0, 1e-6);
  EXPECT_NEAR(width_m("# units: inches\n" + triangle), 50.8, 1e-5);
  EXPECT_NEAR(width_m("# units: in\n" + triangle), 50.8, 1e-5);
  EXPECT_NEAR(width_m("# units of length in yards\n" + triangle), 1828.8, 1e-3);
  EXPECT_NEAR(width_m("# File units = meters\n" + triangle), 2000.0, 1e-3);
  EXPECT_NEAR(width_m("# 1 unit = 100 cm\n" + triangle), 2000.0, 1e-3);
  // What is given comes first, and comments between shapes may be of anything.
  EXPECT_NEAR(width_m("# units: mm\n" + triangle, {.unit_m = 0.5, .y_up = {}}), 1000.0, 1e-3);
  EXPECT_NEAR(width_m(triangle + "# units: mm\n"), 2000.0, 1e-3);
  EXPECT_NEAR(width_m("ply\nformat ascii 1.0\ncomment Units: mm\nelement vertex 3\n"
                      "property float x\nproperty float y\nproperty float z\nelement face 1\n"
                      "property list uchar int vertex_indices\nend_header\n"
                      "0 0 0\n2000 0 0\n0 2000 0\n3 0 1 2\n"),
              2.0, 1e-6);
}

std::string Complaint(const std::string& bytes, const std::string& file = "a.mesh") {
  return MessageOf([&] { (void)ParseMesh(bytes, file); });
}

TEST(ParseMesh, SaysWhichFormatsItReads) {
  const std::string rule =
      HasAssimp()
          ? "a.mesh: is of no known format; OBJ, PLY, STL, OFF, glTF, FBX, DAE and 3DS files "
            "can be read"
          : "a.mesh: is of no known format; OBJ, PLY, STL and OFF files can be read";
  EXPECT_EQ(Complaint(""), rule);
  EXPECT_EQ(Complaint(std::string(100, '\0')), rule);
  EXPECT_EQ(Complaint("solid\x1b[31m"), rule);
  EXPECT_EQ(Complaint("", "a.obj"), "a.obj: holds no triangle");
}

TEST(ParseMesh, RefusesCoordinatesThatSinglePrecisionCannotHold) {
  std::string text = AsciiStl();
  text.replace(text.find("2.000000"), 8, "5411935.");
  EXPECT_EQ(
      Complaint(text),
      "a.mesh: coordinates of this format must lie within 8192 m of its origin, for they have "
      "single precision (got 5411935); OBJ, PLY and OFF files keep all their digits");
}

TEST(ParseMesh, RefusesADamagedStl) {
  std::string text = AsciiStl();
  text.replace(text.find("vertex 1.0"), 10, "vertex one");
  EXPECT_THAT(Complaint(text),
              testing::StartsWith("a.mesh: line 6: a vertex must have three finite "
                                  "coordinates (got \"  vertex one"));
  const std::string whole = AsciiStl();
  EXPECT_EQ(Complaint(whole.substr(0, whole.rfind("  vertex"))), "a.mesh: ends within a facet");
  std::string uneven = AsciiStl();
  uneven.insert(uneven.find(" endloop"), "  vertex 1 1 1\n");
  EXPECT_EQ(Complaint(uneven), "a.mesh: line 8: a facet must have three vertices (got \"4\")");
  std::string bytes = BinaryStl();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + 84 + 50 + 12, &nan, sizeof(nan));
  EXPECT_EQ(Complaint(bytes), "a.mesh: triangle 1 must have finite coordinates (got nan)");
}

TEST(ParseMesh, TellsWhetherTextOfStlHasAnEnd) {
  const std::string whole = AsciiStl();
  const std::string cut = whole.substr(0, whole.find("endsolid"));
  EXPECT_EQ(ParseMesh(cut, "a.stl").remarks.size(), 1U);
  for (const char* end : {"endsolid\n", "end solid by hand\n", "ENDSOLID\nthat was all\n"}) {
    EXPECT_TRUE(ParseMesh(cut + end, "a.stl").remarks.empty()) << end;
  }
}

TEST(ParseMesh, LeavesOutFacesOfTwoCorners) {
  const std::string off = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n2 0 1\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
      "float z\nelement edge 2\nelement face 2\nproperty list uchar int vertex_index\n"
      "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n2 0 1\n";
  for (const std::string& text : {off, ply}) {
    const ImportedMesh mesh = ParseMesh(text, "a");
    EXPECT_EQ(mesh.num_faces, 1U);
    EXPECT_EQ(mesh.num_cornerless, 1U);
  }
}

TEST(ParseMesh, TellsWhatStandsBehindTheShape) {
  const ImportedMesh mesh = ParseMesh(BinaryStl() + "\r\n", "a.stl");
  EXPECT_EQ(mesh.num_triangles(), 4U);
  EXPECT_EQ(mesh.remarks, (std::vector<Remark>{{RemarkKind::kSurplusBytes, "a.stl", 2}}));
  EXPECT_TRUE(ParseMesh(BinaryStl(), "a.stl").remarks.empty());
  EXPECT_TRUE(ParseMesh(kPly, "a.ply").remarks.empty());
  EXPECT_EQ(ParseMesh(std::string(kPly) + "0 0 1\n", "a.ply").remarks,
            (std::vector<Remark>{{RemarkKind::kSurplusBytes, "a.ply", 7}}));
}

TEST(ParseMesh, ReadsTextInUtf16AndBehindAByteOrderMark) {
  for (const std::string& text :
       {std::string(kObj), std::string(kPly), std::string(kOff), AsciiStl()}) {
    EXPECT_EQ(ParseMesh("\xEF\xBB\xBF" + text, "a").num_triangles(), 4U) << text;
    std::string utf16 = "\xFF\xFE";
    for (const char letter : text) utf16 += letter + std::string(1, '\0');
    EXPECT_EQ(ParseMesh(utf16, "a").num_triangles(), 4U) << text;
  }
  if (HasAssimp()) {
    EXPECT_EQ(ParseMesh("\xEF\xBB\xBF" + Gltf(), "a.gltf").num_triangles(), 1U);
  }
}

TEST(ParseMesh, NamesSplats) {
  EXPECT_EQ(Complaint("ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
                      "property float y\nproperty float z\nproperty float f_dc_0\nend_header\n" +
                      std::string(16, '\0')),
            "a.mesh: holds Gaussian splats, which are no surface: make a mesh of them first (got "
            "the property f_dc_0)");
}

TEST(ParseMesh, SaysHowMuchOfABinaryStlIsMissing) {
  const std::string whole = BinaryStl();  // 84 bytes and 4 times 50.
  const std::string is_stl =
      "is a binary STL file of 4 triangles by its header and must have 284 bytes; ";
  EXPECT_EQ(Complaint(whole.substr(0, 200)), "a.mesh: " + is_stl + "84 are missing");
  EXPECT_EQ(Complaint(whole.substr(0, 90), "a.STL"), "a.STL: " + is_stl + "194 are missing");
  EXPECT_EQ(Complaint(whole + "12345", "a.stl"), "a.stl: " + is_stl + "5 are too many");
  std::string named = whole.substr(0, 200);
  named[5] = ' ';  // Begins like a text: "solid  facet".
  EXPECT_EQ(Complaint(named), "a.mesh: " + is_stl + "84 are missing");
}

// OpenMesh takes "router" and "outer_ring" for loops, and the three lines after a loop's beginning
// for its vertices, whatever they are.
TEST(ParseMesh, ReadsAsciiStlHoweverItIsSpreadOverLines) {
  const std::string facets =
      "FACET NORMAL 0 0 1\nOUTER LOOP\n\nVERTEX 0 0 0\n\nVERTEX 1 0 0\nVERTEX 0 1e-50 0\n"
      "ENDLOOP\nENDFACET\n"
      "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 2 0 endloop endfacet\n"
      "facet normal 0 0 1\nouter loop vertex 0 0 0\nvertex 1 0 0 vertex 0 4 0 endloop\nendfacet\n";
  for (const char* name : {"solid router vertex\n", "SOLID\n"}) {
    const ImportedMesh mesh = ParseMesh(name + facets + "endsolid outer_ring\n", "a.stl");
    EXPECT_DOUBLE_EQ(mesh.area_m2, 1.0 + 2.0);
    EXPECT_EQ(mesh.num_triangles(), 2U);
    EXPECT_EQ(mesh.num_flat, 1U);
  }
}

// OpenMesh's reader takes a colour for the next face.
TEST(ParseMesh, PassesOverColoursInOffFiles) {
  const ImportedMesh mesh = ParseMesh(
      "COFF 4 2 0\n0 0 0 255 0 0\n1 0 0 255 0 0\n1 1 0 255 0 0\n0 1 0 255 0 0\n"
      "3 0 1 2 1.0 0.5 0.5 0.75\n3 0 2 3 3\n",
      "a.off");
  EXPECT_EQ(mesh.num_triangles(), 2U);
  EXPECT_DOUBLE_EQ(mesh.area_m2, 1.0);
}

TEST(ParseMesh, RefusesADamagedOff) {
  const std::string counts = "a.mesh: line 2: must give the numbers of vertices and faces (got ";
  EXPECT_EQ(Complaint("OFF\n3 one 0\n"), counts + "\"one\")");
  EXPECT_EQ(Complaint("OFF\n3\n"), counts + "\"\")");
  EXPECT_EQ(Complaint("4OFF\n3 1 0\n"),
            "a.mesh: line 1: vertices must have three coordinates (got \"4OFF\")");
  EXPECT_EQ(Complaint("OFF\n3 4000000000 0\n0 0 0\n"),
            "a.mesh: ends within its 3 vertices and 4000000000 faces");
  EXPECT_EQ(Complaint("OFF\n3 1 0\n0 0 inf\n0 0 1e99\n0 0 0\n3 0 1 3\n"),
            "a.mesh: line 3: a vertex must have three finite coordinates (got \"inf\")\n"
            "a.mesh: line 4: a vertex must have three finite coordinates (got \"1e99\")\n"
            "a.mesh: line 6: a face must name one of the 3 vertices, counted from 0 (got \"3\")");
  const std::string vertices = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(Complaint(vertices + "3 0 1 3\n"),
            "a.mesh: line 6: a face must name one of the 3 vertices, counted from 0 (got \"3\")");
  EXPECT_EQ(Complaint(vertices + "3 0 1 -1\n"),
            "a.mesh: line 6: a face must name one of the 3 vertices, counted from 0 (got \"-1\")");
  EXPECT_EQ(Complaint(vertices + "4 0 1 2\n"),
            "a.mesh: line 6: a face must name its corners (got \"4\")");
}

TEST(ParseMesh, TakesNoWordInACommentForAScene) {
  EXPECT_EQ(ParseMesh(std::string("# exported from <COLLADA> {\"asset\"}\n") + kObj, "a").num_faces,
            4U);
}

TEST(ParseMesh, TakesNoUnitThatAssimpHasAppliedAlready) {
  EXPECT_EQ(MessageOf([&] {
              (void)ParseMesh("<?xml version=\"1.0\"?><COLLADA/>", "a.dae",
                              {.unit_m = 0.01, .y_up = {}});
            }),
            "a.dae: says itself what its unit and its upward axis are: leave out unit_m and up");
}

TEST(ParseMesh, SaysWhyASceneCannotBeRead) {
  if (!HasAssimp()) GTEST_SKIP() << "built without assimp";
  const std::string header("glTF\2\0\0\0\x40\0\0\0\xF0\xFF\xFF\xFFJSON", 20);
  EXPECT_EQ(Complaint(header), "a.mesh: ends within its first chunk of 4294967280 bytes");
  EXPECT_EQ(Complaint(header.substr(0, 19)), "a.mesh: ends within its header");
  EXPECT_EQ(Complaint("glTF\3" + header.substr(5)),
            "a.mesh: must be glTF of version 1 or 2 (got 3)");
  EXPECT_THAT(Complaint(R"({"asset": {"version": "2.0"}})"),
              testing::AnyOf(testing::StartsWith("a.mesh: cannot be read as gltf"),
                             testing::EndsWith("holds no triangle")));
}

}  // namespace
}  // namespace railcast
