#include "core/rail/objects/object_surfaces.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace railcast {
namespace {

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
