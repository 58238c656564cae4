#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "core/base/error.h"
#include "core/mesh/assimp_reader.h"
#include "core/mesh/mesh_import.h"
#include "tests/core/mesh/imported_meshes.h"

namespace railcast {
namespace {

using std::filesystem::path;

/// One row of mesh_report.csv, which was produced by an independent reader.
struct Report {
  std::size_t triangles{};   ///< Counted as fans, including degenerate triangles.
  std::size_t polygons{};    ///< Faces with more than three corners.
  std::size_t degenerate{};  ///< Triangles without area.
};

/// The rows of the files of which that reader understood every line.
std::map<std::string, Report> ReadReports(const path& csv) {
  std::map<std::string, Report> reports;
  std::ifstream in(csv);
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::vector<std::string> cells;
    std::istringstream cells_in(line + ",");
    for (std::string cell; std::getline(cells_in, cell, ',');) cells.push_back(cell);
    if (cells.size() < 17 || cells[10].empty() || cells[15] != "0") continue;
    const auto number = [&](std::size_t i) { return std::size_t{std::stoul(cells[i])}; };
    reports[cells[0]] = {number(3), number(4), number(10)};
  }
  return reports;
}

TEST(RealMeshes, GivesTheTrianglesOfTheReportOrOneLine) {
  const path folder = RAILCAST_SHARED_DATA_DIR;
  if (!std::filesystem::exists(folder / "mesh_report.csv")) {
    GTEST_SKIP() << "no real meshes under " << folder;
  }
  const auto reports = ReadReports(folder / "mesh_report.csv");
  int num_compared = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".obj" && extension != ".OBJ") continue;
    const std::string name = std::filesystem::relative(entry.path(), folder).string();
    SCOPED_TRACE(name);
    try {
      const std::size_t num_triangles = ReadMesh(entry.path(), {1.0, true}).num_triangles();
      const auto report = reports.find(name);
      if (report == reports.end()) continue;
      ++num_compared;
      EXPECT_LE(num_triangles, report->second.triangles);
      // Which slivers have no area depends on rounding, so all, some or none of them may be
      // missing; so may two more per file whose corners lie on one line in decimal digits, but not
      // in the float32 of that reader.
      constexpr std::size_t kSlivers = 2;
      EXPECT_GE(num_triangles + report->second.degenerate + kSlivers, report->second.triangles);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("holds no triangle"));
    }
  }
  EXPECT_GE(num_compared, 100);
}

/// Reads all files of a folder with one of the extensions. Those that cannot be read must say why
/// in lines that name them; the others must have sound triangles.
struct Reading {
  std::map<std::string, std::size_t> triangles;  ///< By path below the folder.
  std::map<std::string, std::string> complaints;
};

Reading ReadAll(const path& folder, const std::set<std::string>& extensions) {
  Reading reading;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    std::string extension = entry.path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), ::tolower);
    if (!extensions.contains(extension)) continue;
    const std::string name = std::filesystem::relative(entry.path(), folder).string();
    SCOPED_TRACE(name);
    try {
      const ImportedMesh imported = ReadMesh(entry.path());
      const Mesh mesh = Merged(imported);
      reading.triangles[name] = mesh.triangles.size();
      EXPECT_NEAR(Area(mesh), imported.area_m2, 1e-3 * imported.area_m2);
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_THAT(what, testing::StartsWith(entry.path().string() + ": "));
      EXPECT_EQ(what.find('\n'), std::string::npos);
      reading.complaints[name] = what.substr(entry.path().string().size() + 2);
    }
  }
  return reading;
}

TEST(RealMeshes, OfPlyStlAndOffAreReadOrSayWhyNot) {
  const path folder = RAILCAST_SHARED_DATA_DIR;
  if (!std::filesystem::exists(folder / "mesh_report.csv")) {
    GTEST_SKIP() << "no real meshes under " << folder;
  }
  const Reading reading = ReadAll(folder, {".ply", ".stl", ".off"});
  for (const auto& [name, what] : reading.complaints) {
    // "OFF8 6 12" in one word; and faces with a list that the header does not declare.
    const std::string expected = name == "meshes_messy_trimesh/whitespace.off"
                                     ? "is of no known format"
                                 : name == "meshes_messy_trimesh/fuze_ascii.ply"
                                     ? "element face: must have all of its numbers"
                                     : "holds no triangle";
    EXPECT_THAT(what, testing::StartsWith(expected)) << name;
  }
  EXPECT_GE(reading.triangles.size(), 41U);
  EXPECT_EQ(reading.triangles.at("meshes_messy_trimesh/comments.off"), 12U);
  EXPECT_EQ(reading.triangles.at("meshes_messy_openmesh/cube1.off"), 15048U);
  EXPECT_EQ(reading.triangles.at("meshes_messy_openmesh/cube1.stl"), 15048U);
  EXPECT_EQ(reading.triangles.at("meshes_messy_openmesh/cube1Binary.stl"), 15048U);
}

TEST(RealMeshes, OfScenesAreReadOrSayWhyNot) {
  const path folder = RAILCAST_SHARED_DATA_DIR;
  if (!HasAssimp()) GTEST_SKIP() << "built without assimp";
  if (!std::filesystem::exists(folder / "mesh_report.csv")) {
    GTEST_SKIP() << "no real meshes under " << folder;
  }
  const Reading reading = ReadAll(folder, {".glb", ".gltf", ".dae", ".fbx", ".3ds"});
  EXPECT_THAT(reading.complaints, testing::IsEmpty());
  EXPECT_GE(reading.triangles.size(), 27U);
}

// It has 5478 edges with more than two faces and 46249 faces with more than three corners.
TEST(RealMeshes, KeepsALorryThatIsNoManifold) {
  const path file =
      path(RAILCAST_SHARED_DATA_DIR) / "meshes_sweethome3d/BlendSwap-CC-0/peterbilt.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no real meshes: " << file;
  const Mesh mesh = ReadMerged(file, 0.01, true);
  EXPECT_EQ(mesh.triangles.size(), 116471U);  // 30 of 116501 triangles have no area.
  const Vector3 size_m = Bounds(mesh).sizes();
  EXPECT_TRUE(size_m.isApprox(Vector3(2.872, 21.05, 4.030), 1e-3)) << size_m.transpose();
}

}  // namespace
}  // namespace railcast
