#include "core/rail/objects/mesh_object.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>

#include "core/base/error.h"
#include "core/mesh/mesh_import.h"
#include "core/rail/objects/object_models.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/rail/test_tables.h"

namespace railcast {
namespace {

/// Three triangles of different sizes: a pane, a wall and something without a name.
constexpr const char* kHouse =
    "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0 2 0\nv 0 0 3\n"
    "f 1 2 3\n"
    "g front\nusemtl DarkGlass\nf 1 2 4\nf 1 3 4\n"
    "g side\nusemtl wall\nf 1 4 5\n";

class MeshObjectOfAFile : public testing::Test {
 protected:
  void Write(const std::string& text) {
    std::ofstream(file_) << text;
    spec_.type = ObjectType::kMesh;
    spec_.file = file_.string();
  }

  [[nodiscard]] MeshObject Make() const {
    return MakeMeshObject(
        spec_, {SurfaceOfObject(spec_, TestSurfaces(), labels_, materials_), labels_, materials_});
  }
  [[nodiscard]] std::string Complaint() const {
    return MessageOf([&] { (void)Make(); });
  }
  /// Material, label and number of triangles of each part of the model.
  [[nodiscard]] std::map<std::pair<std::string, std::string>, std::size_t> Parts() const {
    std::map<std::pair<std::string, std::string>, std::size_t> parts;
    for (const Part& part : Make().model.parts) {
      parts[{materials_.materials()[part.material].name, labels_.Find(part.label)->name}] =
          part.mesh.triangles.size();
    }
    return parts;
  }

  const LabelTable labels_ = RailLabels();
  MaterialLibrary materials_ = RailMaterials();
  const TemporaryDirectory folder_;
  const std::filesystem::path file_ = folder_.path() / "house.obj";
  ObjectSpec spec_;
};

using TrianglesBySurface = std::map<std::pair<std::string, std::string>, std::size_t>;

TEST_F(MeshObjectOfAFile, TakesMaterialsFromTheWordsInNames) {
  Write(kHouse);
  EXPECT_EQ(Parts(), (TrianglesBySurface{{{"glass", "object"}, 2}, {{"grey_paint", "object"}, 2}}));
  const MeshObject mesh = Make();
  ASSERT_EQ(mesh.parts.size(), 3U);
  EXPECT_EQ(mesh.parts[0].why_material, "the type's");
  EXPECT_EQ(mesh.parts[1].why_material, "by the word \"glass\"");
  EXPECT_EQ(mesh.parts[1].why_label, "the type's");
}

TEST_F(MeshObjectOfAFile, TakesNoMaterialThatTheLibraryLacks) {
  std::vector<Material> materials(materials_.materials().begin() + 1, materials_.materials().end());
  std::erase_if(materials,
                [](const Material& material) { return material.name == "black_rubber"; });
  materials_ = MaterialLibrary(materials);
  Write("v 0 0 0\nv 1 0 0\nv 0 0 1\nusemtl rubber\nf 1 2 3\n");
  EXPECT_EQ(Parts(), (TrianglesBySurface{{{"grey_paint", "object"}, 1}}));
}

TEST_F(MeshObjectOfAFile, HasThePaintNearestToItsColours) {
  std::vector<Material> materials(materials_.materials().begin() + 1, materials_.materials().end());
  for (const auto& [name, reflectivity] :
       {std::pair{"paint_05", 0.05}, {"paint_25", 0.25}, {"paint_57", 0.57}}) {
    materials.push_back({name, reflectivity});
  }
  materials_ = MaterialLibrary(materials);
  // Nearest by ratio: 0.5 x 0.2126 + 0.3 x 0.7152 + 0 = 0.32 lies below sqrt(0.25 x 0.57) = 0.377.
  std::ofstream(folder_.path() / "house.mtl") << "newmtl wall\nKd 0.5 0.3 0\nnewmtl DarkGlass\n"
                                                 "Kd 1 1 1\nnewmtl soot\nKd 0 0 0\n";
  Write("mtllib house.mtl\n" + std::string(kHouse) + "usemtl soot\nf 2 4 5\n");
  EXPECT_EQ(Parts(), (TrianglesBySurface{{{"grey_paint", "object"}, 1},
                                         {{"glass", "object"}, 2},
                                         {{"paint_25", "object"}, 1},
                                         {{"paint_05", "object"}, 1}}));
  EXPECT_EQ(Make().parts[2].why_material, "by its colour, of luminance 0.3209");
  spec_.parts = {{.of = "wall", .material = "concrete", .label = {}}};
  EXPECT_EQ(Make().parts[2].why_material, "as parts/0 says");
  spec_.parts.clear();
  spec_.material = "wood";
  EXPECT_EQ(Parts(), (TrianglesBySurface{{{"wood", "object"}, 5}}));
}

TEST_F(MeshObjectOfAFile, HasTheObjectsMaterialThroughoutIfItHasOne) {
  Write(kHouse);
  spec_.material = "wood";
  spec_.label = "building";
  EXPECT_EQ(Parts(), (TrianglesBySurface{{{"wood", "building"}, 4}}));
  EXPECT_EQ(Make().parts[1].why_material, "the object's");
  EXPECT_EQ(Make().parts[1].why_label, "the object's");
}

TEST_F(MeshObjectOfAFile, PutsAnEntryOfAGroupBeforeThatOfAMaterial) {
  Write(kHouse);
  spec_.material = "wood";
  spec_.parts = {{.of = "DarkGlass", .material = "ceramic", .label = "signal"},
                 {.of = "front", .material = "concrete", .label = {}},
                 {.of = "wall", .material = {}, .label = "fence"}};
  EXPECT_EQ(Parts(),
            (TrianglesBySurface{
                {{"wood", "object"}, 1}, {{"concrete", "signal"}, 2}, {{"wood", "fence"}, 1}}));
  EXPECT_EQ(Make().parts[1].why_material, "as parts/1 says");
  EXPECT_EQ(Make().parts[1].why_label, "as parts/0 says");
}

TEST_F(MeshObjectOfAFile, RefusesEntriesThatNameNothing) {
  Write(kHouse);
  spec_.parts = {{.of = "front", .material = "gold", .label = "gold"},
                 {.of = "Front", .material = "wood", .label = {}}};
  EXPECT_EQ(Complaint(),
            "/parts/0/material: must be in the material library (got \"gold\")\n"
            "/parts/0/label: must be in the label table (got \"gold\")\n"
            "/parts/1/of: must name a material or group of the file: \"DarkGlass\", \"front\", "
            "\"side\", \"wall\" (got \"Front\")");
  Write("v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
  spec_.parts = {{.of = "Front", .material = "wood", .label = {}}};
  EXPECT_EQ(Complaint(),
            "/parts/0/of: must name a material or group of the file, which names none (got "
            "\"Front\")");
}

TEST_F(MeshObjectOfAFile, QuotesAndShortensTheNamesOfAFileInMessages) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 0 1\n";
  for (char name = 'a'; name < 'p'; ++name) {
    text += std::string("g ") + name + (name == 'a' ? "\x1b[31m" : "") + "\nf 1 2 3\n";
  }
  Write(text);
  spec_.parts = {{.of = "z", .material = "wood", .label = {}}};
  EXPECT_EQ(Complaint(),
            "/parts/0/of: must name a material or group of the file: \"a\\u001b[31m\", \"b\", "
            "\"c\", \"d\", \"e\", \"f\", \"g\", \"h\", \"i\", \"j\", \"k\", \"l\" and 3 more (got "
            "\"z\")");
}

TEST_F(MeshObjectOfAFile, KeepsTheFilesOriginIfTold) {
  Write("v 10 20 30\nv 12 20 30\nv 10 24 30\nv 10 20 33\nf 1 2 3\nf 1 2 4\n");
  spec_.origin = MeshOrigin::kFile;
  EXPECT_EQ(Make().model.Bounds().min(), Vector3(10, 20, 30));
  EXPECT_EQ(Make().model.Bounds().max(), Vector3(12, 24, 33));
  spec_.up = UpAxis::kY;
  EXPECT_EQ(Make().model.Bounds().min(), Vector3(10, -33, 20));
  spec_.up.reset();
  spec_.size_m = {1.0, 2.0, 6.0};  // Half, half and twice the file's.
  EXPECT_EQ(Make().model.Bounds().min(), Vector3(5, 10, 60));
  EXPECT_EQ(Make().model.Bounds().max(), Vector3(6, 12, 66));
}

/// A fan of 64 triangles in a plane, as a wall of a scan has them, and a pane.
std::string DenseWall() {
  std::string text = "v 0 0 0\nv 0 5 10\n";
  for (int i = 0; i <= 64; ++i) text += "v " + std::to_string(0.125 * i) + " 0 20\n";
  text += "usemtl brick\n";
  for (int i = 0; i < 64; ++i) {
    text += "f 1 " + std::to_string(i + 3) + " " + std::to_string(i + 4) + "\n";
  }
  return text + "usemtl glass\nf 1 2 3\n";
}

TEST_F(MeshObjectOfAFile, IsSimplifiedOnlyWithATolerance) {
  Write(DenseWall());
  const MeshObject whole = Make();
  EXPECT_EQ(whole.num_read, 65);
  EXPECT_EQ(whole.model.num_triangles(), 65);
  EXPECT_EQ(whole.deviation_m, 0.0);
  spec_.tolerance_mm = 2.5;
  const MeshObject simplified = Make();
  EXPECT_EQ(simplified.num_read, 65);
  EXPECT_LT(simplified.model.num_triangles(), 4);
  EXPECT_LE(simplified.deviation_m, 0.0025);
  EXPECT_TRUE(simplified.model.Bounds().isApprox(whole.model.Bounds(), 1e-6));
  EXPECT_EQ(simplified.parts.at(0).num_triangles + 1, simplified.model.num_triangles());
  EXPECT_EQ(simplified.parts.at(0).surface.material, whole.parts.at(0).surface.material);
  EXPECT_NE(simplified.parts.at(1).surface.material, whole.parts.at(0).surface.material);
}

/// The peak is 0.02 of the file's units high: within 2.5 mm where it is scaled down.
TEST_F(MeshObjectOfAFile, IsSimplifiedAtItsSizeInTheWorld) {
  Write(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0.02\n"
      "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
  spec_.tolerance_mm = 2.5;
  EXPECT_EQ(Make().model.num_triangles(), 4);
  spec_.size_m = {0.1, 0.1, 0.001};
  EXPECT_EQ(Make().model.num_triangles(), 2);
}

TEST_F(MeshObjectOfAFile, SharesNoModelWithOneOfAnotherTolerance) {
  Write(DenseWall());
  ObjectModels models(TestSurfaces(), labels_, materials_);
  const auto whole = models.Of(spec_);
  spec_.tolerance_mm = 2.5;
  EXPECT_LT(models.Of(spec_)->num_triangles(), whole->num_triangles());
}

TEST_F(MeshObjectOfAFile, RefusesTheOriginOfMapCoordinates) {
  Write("v 2600000 1200000 500\nv 2600001 1200000 500\nv 2600000 1200001 501.5\nf 1 2 3\n");
  EXPECT_EQ(Make().model.Bounds().max(), Vector3(0.5, 0.5, 1.5));
  spec_.origin = MeshOrigin::kFile;
  EXPECT_EQ(Complaint(),
            "/origin: must be \"foot\" for a mesh that reaches further than 8192 m from its file's "
            "origin (got 2.6e+06 m)");
  spec_.unit_m = 0.001;
  EXPECT_EQ(Complaint(), "no error");
}

/// A face of 5 mm, 5 km from the origin, where float32 has steps of 0.5 mm.
TEST_F(MeshObjectOfAFile, IsWithinHalfAMillimetreOfAFarOrigin) {
  Write("v 5000.0013 0.0021 0\nv 5000.0063 0.0021 0\nv 5000.0013 0.0071 0\nf 1 2 3\n");
  spec_.origin = MeshOrigin::kFile;
  const Eigen::AlignedBox3d box = Make().model.Bounds();
  EXPECT_NEAR(box.min().x(), 5000.0013, 0.00025);
  EXPECT_NEAR(box.max().x(), 5000.0063, 0.00025);
  EXPECT_NEAR(box.min().y(), 0.0021, 1e-9);
}

TEST(MeshObject, OfRealFilesHasTheSameTrianglesAboutFootAndOrigin) {
  const std::filesystem::path folder = RAILCAST_SHARED_DATA_DIR;
  if (!std::filesystem::exists(folder / "mesh_report.csv")) GTEST_SKIP() << "none in " << folder;
  const RailSurfaces surfaces = TestSurfaces();
  const LabelTable labels = RailLabels();
  const MaterialLibrary materials = RailMaterials();
  int num_compared = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".obj" && extension != ".stl" && extension != ".ply") continue;
    if (entry.file_size() > 1'000'000) continue;  // These suffice.
    ObjectSpec spec;
    spec.type = ObjectType::kMesh;
    spec.file = entry.path().string();
    std::optional<ImportedMesh> imported;
    try {
      imported = ReadMesh(entry.path());
    } catch (const InputError&) {
      continue;  // The tests of the readers say which.
    }
    SCOPED_TRACE(entry.path().string());
    const MeshTables tables{surfaces.box, labels, materials};
    const MeshObject foot = MakeMeshObject(spec, tables);
    spec.origin = MeshOrigin::kFile;
    if (foot.file_bounds_m.min()
            .cwiseAbs()
            .cwiseMax(foot.file_bounds_m.max().cwiseAbs())
            .maxCoeff() > 8192.0) {
      EXPECT_THROW((void)MakeMeshObject(spec, tables), InputError);
      continue;
    }
    ++num_compared;
    const MeshObject origin = MakeMeshObject(spec, tables);
    EXPECT_EQ(foot.model.num_triangles(), imported->num_triangles());
    EXPECT_EQ(origin.model.num_triangles(), imported->num_triangles());
    const Eigen::AlignedBox3d box = origin.model.Bounds();
    const double reach_m = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
    const double rounding_m = 3 * 6e-8 * reach_m;  // Float32 rounds twice on the way.
    EXPECT_LE((box.min() - origin.file_bounds_m.min()).cwiseAbs().maxCoeff(), rounding_m);
    EXPECT_LE((box.sizes() - foot.model.Bounds().sizes()).cwiseAbs().maxCoeff(), 2 * rounding_m);
    EXPECT_NEAR(foot.model.Bounds().min().z(), 0.0, rounding_m);
  }
  EXPECT_GE(num_compared, 100);
}

}  // namespace
}  // namespace railcast
