#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <variant>

#include "core/scenario/command.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/scenario/scenario_files.h"

namespace railcast {
namespace {

/// A box as an OBJ file of one material.
std::string BoxText(const Vector3& min_m, const Vector3& max_m, const std::string& material) {
  std::ostringstream text;
  for (const double x_m : {min_m.x(), max_m.x()}) {
    for (const double y_m : {min_m.y(), max_m.y()}) {
      for (const double z_m : {min_m.z(), max_m.z()}) {
        text << "v " << x_m << ' ' << y_m << ' ' << z_m << '\n';
      }
    }
  }
  text << "usemtl " << material
       << "\nf 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n";
  return text.str();
}

/// A scenario whose own table has a rail vehicle, a crate, and the shipped car in another paint.
class OwnModels : public testing::Test {
 protected:
  void SetUp() override {
    folder_.Write("cart.obj", BoxText({-4, -1.2, 0.6}, {4, 1.2, 2.6}, "shell"));
    folder_.Write("bogie.obj", BoxText({-1, -0.8, 0}, {1, 0.8, 0.6}, "wheels"));
    folder_.Write("crate.obj", BoxText({-50, -25, 0}, {50, 25, 40}, "planks"));
    folder_.Write("models.json", R"({"version": 1, "models": [
      {"name": "cart", "file": "cart.obj", "label": "wagon", "size_m": [8, 2.4, 2.6],
       "rail_vehicle": {"pivot_distance_m": 5, "bogie": "bogie.obj"},
       "parts": [{"of": "shell", "material": "tank_paint"}, {"of": "wheels", "material": "wheel_steel"}]},
      {"name": "crate", "file": "crate.obj", "unit_m": 0.01, "label": "object", "size_m": [1, 0.5, 0.4],
       "parts": [{"of": "planks", "material": "wood", "label": "pole"}]},
      {"name": "grey_car", "file": "railcast:car.ply", "label": "road_vehicle",
       "size_m": [4.284, 2.073, 1.456], "material": "grey_paint"}]})");
  }

  [[nodiscard]] std::filesystem::path Scenario() const {
    return folder_.Write("scenario.json", R"({"version": 1, "file": ")" +
                                              (ScenariosDir() / "minimal.json").string() +
                                              R"(", "models": "models.json", "world": {
      "alignment": {"course": {"type": "elements", "elements": [{"type": "straight", "length_m": 1000}]}},
      "objects": [{"name": "cart", "type": "cart", "s_m": 500},
                  {"name": "crate", "type": "crate", "s_m": 450, "d_m": 4},
                  {"name": "car", "type": "grey_car", "s_m": 470, "d_m": 6}],
      "trains": [{"name": "train", "s_m": 700, "vehicles": [{"type": "cart"}, {"type": "cart"}, {"type": "open_wagon"}]}]
    }})");
  }

  const TemporaryFolder folder_;
};

TEST_F(OwnModels, StandAndAreLabelledAsTheirTableSays) {
  const ScenarioSpec spec = ReadScenario(Scenario());
  const auto world = MakeWorld(spec);
  const LabelTable labels(spec.labels);
  const MaterialLibrary materials(spec.materials);
  const SceneObject& cart = world->objects()[0];
  EXPECT_EQ(cart.type, "cart");
  EXPECT_EQ(cart.label, labels.Id("wagon"));
  EXPECT_TRUE(cart.is_rail_vehicle);
  const Eigen::AlignedBox3d whole_m(Vector3(-4, -1.2, 0), Vector3(4, 1.2, 2.6));
  EXPECT_TRUE(cart.model->Bounds().isApprox(whole_m, 1e-6)) << "its body on its two bogies";
  ASSERT_EQ(cart.model->parts.size(), 2U);
  EXPECT_EQ(cart.model->parts[0].material, materials.Index("tank_paint"));
  EXPECT_EQ(cart.model->parts[1].material, materials.Index("wheel_steel"));
  const SceneObject& crate = world->objects()[1];
  EXPECT_EQ(crate.label, labels.Id("object"));
  EXPECT_EQ(crate.model->parts.at(0).label, labels.Id("pole"));
  EXPECT_TRUE(crate.model->Bounds().sizes().isApprox(Vector3(1, 0.5, 0.4), 1e-6));
}

TEST_F(OwnModels, CoupleAtTheEndsOfTheirLength) {
  const auto world = MakeWorld(ReadScenario(Scenario()));
  const auto x_m = [&](std::size_t object) {
    return world->WorldFromObject(object, 0).translation().x();
  };
  EXPECT_NEAR(x_m(3), 700.0 - 4.0, 1e-6);
  EXPECT_NEAR(x_m(4), 700.0 - 12.0, 1e-6);
  EXPECT_NEAR(x_m(5), 700.0 - 16.0 - 14.04 / 2.0, 1e-6);
}

TEST_F(OwnModels, ArePlacedByCommandsToTheirScenario) {
  ScenarioSpec spec = ReadScenario(Scenario());
  const std::string line =
      R"({"command": "place_object", "object": {"name": "late", "type": "crate", "s_m": 480}})";
  const CommandLine read = ReadCommand(line, spec.models);
  ASSERT_TRUE(read.command.has_value()) << read.faults.front();
  spec.world.objects.push_back(std::get<PlaceObject>(*read.command).object);
  EXPECT_TRUE(MakeWorld(spec)->objects().at(3).model->Bounds().sizes().isApprox(
      Vector3(1, 0.5, 0.4), 1e-6));

  const CommandLine elsewhere = ReadCommand(line);
  ASSERT_EQ(elsewhere.faults.size(), 1U);
  EXPECT_THAT(elsewhere.faults.front(), testing::HasSubstr("/object/type: must be \"box\""));
}

TEST_F(OwnModels, MayBeShippedMeshesOfOtherMaterials) {
  const ScenarioSpec spec = ReadScenario(Scenario());
  const auto world = MakeWorld(spec);
  const MaterialLibrary materials(spec.materials);
  std::set<std::string> names;
  for (const Part& part : world->objects()[2].model->parts) {
    names.insert(materials.materials()[part.material].name);
  }
  // "window", "tyre" and "metal" are words that stand for materials; all else is grey.
  EXPECT_EQ(names,
            (std::set<std::string>{"grey_paint", "glass", "black_rubber", "galvanised_steel"}));
}

TEST_F(OwnModels, AreInTheResolvedScenario) {
  const ScenarioSpec spec = ReadScenario(Scenario());
  const auto resolved = folder_.Write("resolved.json", ResolvedScenarioJson(spec));
  const ScenarioSpec again = ReadScenario(resolved);
  EXPECT_EQ(again, spec);
  ASSERT_EQ(again.models.size(), 3U);
  EXPECT_EQ(again.models[2].file, "railcast:car.ply");
}

TEST(TypeNamed, KnowsShapesAndShippedModels) {
  EXPECT_EQ(TypeNamed("person"), ObjectType::kPerson);
  EXPECT_TRUE(IsRailVehicle(TypeNamed("coach")));
  EXPECT_FALSE(IsRailVehicle(TypeNamed("car")));
  EXPECT_EQ(MessageOf([&] { static_cast<void>(TypeNamed("coch")); }),
            "type: unknown type, the nearest is \"coach\"");
}

}  // namespace
}  // namespace railcast
