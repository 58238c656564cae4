#include "core/mesh/mesh_readers.h"

#include <gtest/gtest.h>

#include <bit>

#include "core/base/shipped_files.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

/// A pyramid in map coordinates, whose faces follow a list property of another name, and an element
/// that nobody knows.
struct Pyramid {
  std::vector<Vector3> points = {
      {0, 0, 0}, {0.25, 0, 0}, {0.25, 0.0625, 0}, {0, 0.0625, 0}, {0.125, 0.03125, 0.5}};
  std::vector<std::vector<std::uint32_t>> faces = {
      {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {3, 2, 1, 0}};

  [[nodiscard]] std::string Header(const std::string& format) const {
    return "ply\r\nformat " + format + " 1.0\r\ncomment made by hand\nelement vertex " +
           std::to_string(points.size()) +
           "\nproperty double x\nproperty uchar red\nproperty double y\nproperty float64 z\n"
           "element odd 1\nproperty list uchar short what\nelement face " +
           std::to_string(faces.size()) +
           "\nproperty list uchar uint vertex_indices\nproperty float quality\nend_header\n";
  }
};

template <typename Number>
void Append(std::string& bytes, Number number, bool is_big) {
  std::array<char, sizeof(Number)> raw = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  if (is_big) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.begin(), raw.end());
}

std::string Binary(const Pyramid& pyramid, const Vector3& by, bool is_big) {
  std::string bytes = pyramid.Header(is_big ? "binary_big_endian" : "binary_little_endian");
  for (const Vector3& point : pyramid.points) {
    Append(bytes, point.x() + by.x(), is_big);
    bytes += '\xFF';
    Append(bytes, point.y() + by.y(), is_big);
    Append(bytes, point.z() + by.z(), is_big);
  }
  bytes += '\2';
  Append(bytes, std::int16_t{-1}, is_big);
  Append(bytes, std::int16_t{300}, is_big);
  for (const auto& face : pyramid.faces) {
    bytes += static_cast<char>(face.size());
    for (const std::uint32_t corner : face) Append(bytes, corner, is_big);
    Append(bytes, 0.5F, is_big);
  }
  return bytes;
}

constexpr double kLargest = 1e9;

void ExpectPyramid(const std::string& bytes, const Pyramid& pyramid, const Vector3& by) {
  const PolygonSoup soup = ReadPlyMesh("p.ply", bytes, kLargest);
  ASSERT_EQ(soup.points.size(), pyramid.points.size());
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    EXPECT_EQ(soup.points[i], Vector3(pyramid.points[i] + by));
  }
  ASSERT_EQ(soup.faces.size(), pyramid.faces.size());
  for (std::size_t i = 0; i < soup.faces.size(); ++i) {
    EXPECT_EQ(soup.faces[i].corners, pyramid.faces[i]);
  }
}

const Vector3 kUtm(447240.0, 5411935.0, 267.0);

TEST(ReadPlyMesh, KeepsAllDigitsOfDoublesInEitherByteOrder) {
  const Pyramid pyramid;
  ExpectPyramid(Binary(pyramid, kUtm, false), pyramid, kUtm);
  ExpectPyramid(Binary(pyramid, kUtm, true), pyramid, kUtm);
}

TEST(ReadPlyMesh, ReadsNumbersAsText) {
  const Pyramid pyramid;
  ExpectPyramid(pyramid.Header("ascii") +
                    "0 255 0 0\n+0.25 255 0 0\r\n0.25 255 6.25e-2 0\n0 255 0.0625 0\n"
                    "0.125 255 0.03125 0.5\n2 -1 300\n3 0 1 4 0.5\n3 1 2 4 0.5 3 2 3 4 0.5\n"
                    "3 3 0 4 0.5\n4 3 2 1 0 0.5",
                pyramid, Vector3::Zero());
}

std::string PlyComplaint(const std::string& bytes) {
  return MessageOf([&] { (void)ReadPlyMesh("p.ply", bytes, kLargest); });
}

TEST(ReadPlyMesh, SaysWhereAFileEnds) {
  const Pyramid pyramid;
  const std::string whole = Binary(pyramid, Vector3::Zero(), false);
  EXPECT_EQ(PlyComplaint(whole.substr(0, whole.size() - 1)),
            "p.ply: ends within its 5 elements face");
  EXPECT_EQ(PlyComplaint(whole.substr(0, whole.size() - 90)),
            "p.ply: ends within its 1 elements odd");
  EXPECT_EQ(PlyComplaint(whole.substr(0, whole.size() - 150)),
            "p.ply: ends within its 5 elements vertex");
  EXPECT_EQ(PlyComplaint(whole.substr(0, whole.find("property double x"))),
            "p.ply: is no PLY file: its header has no end_header line");
}

TEST(ReadPlyMesh, RefusesACountThatWouldFillTheMemory) {
  EXPECT_EQ(PlyComplaint("ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\n"
                         "end_header\n0\n"),
            "p.ply: ends within its 4000000000 elements vertex");
  EXPECT_EQ(PlyComplaint("ply\nformat ascii 1.0\nelement vertex 1\nend_header\n0\n"),
            "p.ply: element vertex: has no property");
}

TEST(ReadPlyMesh, RefusesWhatIsNoNumberAndNoVertex) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n";
  EXPECT_EQ(PlyComplaint(header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
            "p.ply: face 0 must name one of the 3 vertices, counted from 0 (got 3)");
  EXPECT_EQ(PlyComplaint(header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"),
            "p.ply: face 0 must name one of the 3 vertices, counted from 0 (got -1)");
  EXPECT_EQ(PlyComplaint(header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n"),
            "p.ply: face 0 must name one of the 3 vertices, counted from 0 (got 1.5)");
  EXPECT_EQ(PlyComplaint(header + "0 0 0\n1 0 0\n0 1 0\n2.5 0 1 1\n"),
            "p.ply: element face: a list's length must be a whole number (got 2.5)");
  EXPECT_EQ(PlyComplaint(header + "0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n"),
            "p.ply: vertex 1 must have three finite coordinates (got nan)");
  EXPECT_EQ(PlyComplaint(header + "0 0 0\n1 0 2e9\n0 1 0\n3 0 1 2\n"),
            "p.ply: vertex 1 must have three finite coordinates (got 2e+09)");
  EXPECT_EQ(PlyComplaint(header + "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n"),
            "p.ply: element vertex: must consist of numbers (got \"zero\")");
}

TEST(ReadPlyMesh, RefusesAHeaderOfAnotherFormat) {
  EXPECT_EQ(PlyComplaint("ply\nformat binary 1.0\nend_header\n"),
            "p.ply: format: must be ascii, binary_little_endian or binary_big_endian (got binary)");
  EXPECT_EQ(PlyComplaint("ply\nend_header\n"), "p.ply: format: missing");
  EXPECT_EQ(PlyComplaint("ply\nformat ascii 1.0\nelement vertex many\nend_header\n"),
            "p.ply: element vertex: must be a whole number below 2^32 (got many)");
  EXPECT_EQ(PlyComplaint("ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n"),
            "p.ply: property x: unknown type half");
  EXPECT_EQ(PlyComplaint("ply\nformat ascii 1.0\nproperty float x\nend_header\n"),
            "p.ply: is no PLY file: a header line begins with property");
  EXPECT_EQ(
      PlyComplaint("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                   "end_header\n1 1\n"),
      "p.ply: element vertex: must have the properties x, y and z");
}

/// A triangle in text behind the first lines of a header.
std::string TriangleBehind(const std::string& first_lines) {
  return first_lines +
         "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 1\nproperty list uchar int vertex_index\nend_header\n"
         "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
}

TEST(ReadPlyMesh, WantsItsFirstLineToBePlyAlone) {
  EXPECT_EQ(PlyComplaint(TriangleBehind("ply\nformat ascii 1.0\n")), "no error");
  EXPECT_EQ(PlyComplaint(TriangleBehind("ply\r\nformat ascii 1.0\r\n")), "no error");
  for (const std::string first : {"", "PLY", "ply ", " ply", "ply 1.0", "format"}) {
    EXPECT_EQ(PlyComplaint(TriangleBehind(first + "\nformat ascii 1.0\n")),
              "p.ply: is no PLY file: its first line must be \"ply\"")
        << first;
  }
}

TEST(ReadPlyMesh, WantsAVersionBehindItsFormatAndNoMore) {
  for (const std::string line : {"format ascii", "format ascii 1.0 x"}) {
    EXPECT_EQ(PlyComplaint(TriangleBehind("ply\n" + line + "\n")),
              "p.ply: format: must have a version and nothing behind it (got \"" + line + "\")");
  }
  EXPECT_EQ(
      PlyComplaint(TriangleBehind("ply\nformat\n")),
      "p.ply: format: must be ascii, binary_little_endian or binary_big_endian (got nothing)");
}

TEST(ReadPlyMesh, RefusesASecondElementOfVertices) {
  const std::string vertex =
      "property float x\nproperty float y\nproperty float z\nproperty uchar red\n";
  // Of the second ones, one part of a colour would stand beyond the colours of the first.
  EXPECT_EQ(PlyComplaint("ply\nformat ascii 1.0\nelement vertex 1\n" + vertex +
                         "property uchar green\nproperty uchar blue\nelement vertex 2\n" + vertex +
                         "end_header\n0 0 0 1 2 3\n1 0 0 1\n0 1 0 1\n"),
            "p.ply: element vertex: must come once");
  EXPECT_EQ(PlyComplaint("ply\nformat ascii 1.0\nend_header\n"), "no error");
}

TEST(ReadPlyMesh, TakesMaterialsFromCommentsAndUnitsFromNone) {
  const PolygonSoup soup =
      ReadPlyMesh("p.ply",
                  TriangleBehind("ply\nformat ascii 1.0\ncomment File units = millimeters\n"
                                 "comment material shell\nobj_info material of_scan\n"),
                  kLargest);
  EXPECT_EQ(soup.materials, std::vector<std::string>{"shell"});
  EXPECT_EQ(soup.points[1], Vector3::UnitX());
}

/// A fan of triangles about the first vertex, each with a shade of its own.
std::string ShadedFan(int num_triangles) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex " + std::to_string(2 * num_triangles + 1) +
      "\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face " +
      std::to_string(num_triangles) + "\nproperty list uchar int vertex_indices\nend_header\n";
  std::string faces;
  for (int i = 0; i < num_triangles; ++i) {
    const std::string shade = " 160 82 " + std::to_string(i) + '\n';
    text += std::to_string(i) + " 0 1" + shade + std::to_string(i + 1) + " 0 1" + shade;
    faces += "3 " + std::to_string(2 * i) + ' ' + std::to_string(2 * i + 1) + ' ' +
             std::to_string(2 * num_triangles) + '\n';
  }
  return text + "0 0 0 1 2 3\n" + faces;
}

TEST(ReadPlyMesh, NamesMaterialsByTheColoursOfVertices) {
  const PolygonSoup soup = ReadPlyMesh("p.ply", ShadedFan(3), kLargest);
  EXPECT_EQ(soup.materials, (std::vector<std::string>{"#a05200", "#a05201", "#a05202"}));
  ASSERT_EQ(soup.faces.size(), 3U);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(soup.faces[i].material, i);
}

TEST(ReadPlyMesh, TakesManyColoursForAPhotograph) {
  EXPECT_EQ(ReadPlyMesh("p.ply", ShadedFan(32), kLargest).materials.size(), 32U);
  EXPECT_TRUE(ReadPlyMesh("p.ply", ShadedFan(33), kLargest).materials.empty());
}

TEST(ReadPlyMesh, NamesTheMaterialsOfFacesThatItsHeaderNames) {
  const std::string head =
      "ply\nformat ascii 1.0\ncomment material shell\ncomment material wheels\n"
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uchar int vertex_indices\nproperty uchar material_index\n"
      "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 1\n";
  const PolygonSoup soup = ReadPlyMesh("p.ply", head + "3 2 1 0 0\n", kLargest);
  EXPECT_EQ(soup.materials, (std::vector<std::string>{"shell", "wheels"}));
  ASSERT_EQ(soup.faces.size(), 2U);
  EXPECT_EQ(soup.faces[0].material, 1U);
  EXPECT_EQ(soup.faces[1].material, 0U);
  EXPECT_EQ(MessageOf([&] { (void)ReadPlyMesh("p.ply", head + "3 2 1 0 2\n", kLargest); }),
            "p.ply: face 1 must name one of the 2 materials, counted from 0 (got 2)");
}

TEST(ReadShippedPly, ReadsWhatTheReaderOfAllPlyFilesReads) {
  std::size_t num_files = 0;
  for (const std::string_view name : ShippedFileNames()) {
    if (!name.ends_with(".ply")) continue;
    ++num_files;
    const std::string_view bytes = ShippedFile(std::string(kShippedPrefix).append(name)).value();
    const ImportedMesh fast = ReadShippedPly(bytes);
    const ImportedMesh slow =
        MakeTriangles(ReadPlyMesh(std::string(name), bytes, kLargest), 1.0, false);
    ASSERT_EQ(fast.parts.size(), slow.parts.size()) << name;
    for (std::size_t i = 0; i < fast.parts.size(); ++i) {
      EXPECT_EQ(fast.parts[i].material, slow.parts[i].material) << name;
      EXPECT_EQ(fast.parts[i].mesh.triangles, slow.parts[i].mesh.triangles) << name;
      const auto& vertices = fast.parts[i].mesh.vertices;
      ASSERT_EQ(vertices.size(), slow.parts[i].mesh.vertices.size()) << name;
      for (std::size_t k = 0; k < vertices.size(); ++k) {
        const Vector3 expected = slow.parts[i].mesh.vertices[k].cast<double>() + slow.origin_m;
        // The slow reader has rounded it about the middle: by half a unit in the last place at 16
        // m.
        ASSERT_LT((vertices[k].cast<double>() - expected).norm(), 1e-6) << name;
      }
    }
    EXPECT_EQ(fast.origin_m, Vector3(Vector3::Zero()));
    EXPECT_EQ(fast.num_faces, slow.num_faces);
    EXPECT_EQ(slow.num_flat + slow.num_cornerless, 0U) << name;
    EXPECT_NEAR(fast.area_m2, slow.area_m2, 1e-5 * slow.area_m2);  // float32 has 24 bits.
  }
  EXPECT_EQ(num_files, 35U);
}

}  // namespace
}  // namespace railcast
