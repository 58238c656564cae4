#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/shipped_files.h"
#include "core/rail/objects/object_surfaces.h"
#include "core/scenario/object_types.h"
#include "tests/core/rail/shipped_models.h"

namespace railcast {
namespace {

/// A face of a shipped file: the positions of its corners, by the number of its material.
struct FaceOfFile {
  std::array<Eigen::Vector3f, 3> corners_m;
  std::uint8_t material{};
};

/// Reads what the header of all shipped files says, and nothing else: floats, and faces of a byte,
/// three 16-bit corners and a byte for the material.
std::vector<FaceOfFile> FacesOfFile(std::string_view bytes) {
  constexpr std::string_view kEnd = "end_header\n";
  const std::size_t begin = bytes.find(kEnd) + kEnd.size();
  std::istringstream header{std::string(bytes.substr(0, begin))};
  std::map<std::string, std::size_t> counts;
  for (std::string line; std::getline(header, line);) {
    std::istringstream words(line);
    std::string first;
    std::string name;
    std::size_t count = 0;
    if (words >> first >> name >> count && first == "element") counts[name] = count;
  }
  const char* at = bytes.data() + begin;
  std::vector<Eigen::Vector3f> vertices(counts["vertex"]);
  std::memcpy(static_cast<void*>(vertices.data()), at, 12 * vertices.size());
  at += 12 * vertices.size();
  std::vector<FaceOfFile> faces(counts["face"]);
  for (FaceOfFile& face : faces) {
    EXPECT_EQ(*at, 3);
    std::array<std::uint16_t, 3> corners{};
    std::memcpy(corners.data(), at + 1, sizeof corners);
    for (std::size_t i = 0; i < 3; ++i) face.corners_m.at(i) = vertices.at(corners.at(i));
    face.material = static_cast<std::uint8_t>(at[7]);
    at += 8;
  }
  EXPECT_EQ(at, bytes.data() + bytes.size());
  return faces;
}

TEST(ShippedModels, HaveTheVerticesAndTrianglesOfTheirFilesBitByBit) {
  for (const ObjectType& type : ShippedTypes()) {
    const std::vector<FaceOfFile> faces = FacesOfFile(ShippedFile(type.model->file).value());
    const Model body = PiecesOfModel(type).front();
    std::vector<std::size_t> next(body.parts.size(), 0);
    EXPECT_EQ(body.num_triangles(), faces.size()) << body.name;
    for (const FaceOfFile& face : faces) {
      const Mesh& mesh = body.parts.at(face.material).mesh;
      const auto& triangle = mesh.triangles.at(next.at(face.material)++);
      for (std::size_t i = 0; i < 3; ++i) {
        ASSERT_EQ(mesh.vertices.at(triangle.at(i)), face.corners_m.at(i)) << body.name;
      }
    }
  }
}

TEST(ShippedModels, UseEveryFileOfTheirFolder) {
  std::set<std::string> used = {"labels.json", "models.json", "railway.json"};
  for (const ObjectType& type : ShippedTypes()) {
    std::vector<std::string> files = {type.model->file};
    if (IsRailVehicle(type)) files.push_back(type.model->rail_vehicle->bogie);
    for (const std::string& file : files) used.insert(file.substr(kShippedPrefix.size()));
  }
  const std::vector<std::string_view> names = ShippedFileNames();
  EXPECT_EQ(used, std::set<std::string>(names.begin(), names.end()));
  EXPECT_FALSE(ShippedFile("models.json")) << "without the prefix it is a file of the user's";
}

std::string MaterialIn(std::string_view name) {
  const auto named = MaterialOfName(name);
  return named ? std::string(named->material) : "";
}

TEST(MaterialOfName, FindsLongWordsInsideWords) {
  EXPECT_EQ(MaterialIn("darkglass"), "glass");
  EXPECT_EQ(MaterialIn("sweethome3d_window_mirror"), "glass");
  EXPECT_EQ(MaterialIn("GLASS.001"), "glass");
  EXPECT_EQ(MaterialIn("tiresTrailer"), "black_rubber");
  EXPECT_EQ(MaterialIn("Betonschwelle"), "concrete");
  EXPECT_EQ(MaterialIn("Aluminum"), "galvanised_steel");
  EXPECT_EQ(MaterialIn("RedBrick2"), "masonry");
}

TEST(MaterialOfName, TakesShortWordsOnlyWhole) {
  EXPECT_EQ(MaterialIn("front_tire"), "black_rubber");
  EXPECT_EQ(MaterialIn("RoodWood"), "wood");
  EXPECT_EQ(MaterialIn("wood1"), "wood");
  EXPECT_EQ(MaterialIn("iron"), "galvanised_steel");
  EXPECT_EQ(MaterialIn("OakLeaf"), "leaf");
  EXPECT_EQ(MaterialIn("entire"), "");
  EXPECT_EQ(MaterialIn("environment"), "");
  EXPECT_EQ(MaterialIn("value"), "");
  EXPECT_EQ(MaterialIn("leaflet"), "");
}

TEST(MaterialOfName, TakesNoFrameForAPaneAndNoPaintForMetal) {
  EXPECT_EQ(MaterialIn("FensterRahmen"), "");
  EXPECT_EQ(MaterialIn("window_frame"), "");
  EXPECT_EQ(MaterialIn("metallicPaint"), "");
}

TEST(MaterialOfName, NamesNothingForOtherNames) {
  for (const char* name : {"", "Material.001", "body", "black", "\xff\xfe", "123"}) {
    EXPECT_EQ(MaterialIn(name), "") << name;
  }
}

/// A word for a material that nobody has would never count.
TEST(MaterialOfName, GivesMaterialsOfTheSuppliedLibrary) {
  std::ifstream in(std::string(RAILCAST_SOURCE_DIR) + "/scenarios/materials/railway.json");
  std::stringstream library;
  library << in.rdbuf();
  for (const char* word : {"glass", "rubber", "leaf", "bark", "wood", "brick", "concrete",
                           "asphalt", "gravel", "plastic", "skin", "shirt", "steel"}) {
    const std::string material = MaterialIn(word);
    ASSERT_NE(material, "") << word;
    EXPECT_NE(library.str().find("\"name\": \"" + material + "\""), std::string::npos) << material;
  }
}

}  // namespace
}  // namespace railcast
