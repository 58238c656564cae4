#include "core/extras/recipe/structure_contacts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/rail/catenary/catenary.h"
#include "core/rail/line/line_place.h"
#include "railcast/scenario.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"

namespace railcast {
namespace {

using testing::Optional;

/// The project's line with a platform 4 m wide on its right and a noise wall on its left.
class StructureContactsTest : public testing::Test {
 protected:
  StructureContactsTest() : scenario_(ReadScenario(MakeProject(directory_.path()))) {
    scenario_.world.vegetation = {};  // The project has no plants.
    PlatformSpec platform;
    platform.name = "platform";
    platform.begin_s_m = 420.0;
    platform.end_s_m = 480.0;
    platform.side = TrackSide::kRight;
    platform.width_m = 4.0;
    NoiseWallSpec wall;
    wall.name = "wall";
    wall.begin_s_m = 420.0;
    wall.end_s_m = 480.0;
    wall.side = TrackSide::kLeft;
    scenario_.world.structures = {platform, wall};
    world_ = MakeWorld(scenario_);
  }

  /// What an upright person there is in.
  [[nodiscard]] std::optional<std::string> FindAt(double s_m, double d_m) const {
    ObjectSpec person;
    person.name = "person";
    person.type = ObjectType::kPerson;
    person.s_m = s_m;
    person.d_m = d_m;
    return Find(person);
  }
  [[nodiscard]] std::optional<std::string> Find(const ObjectSpec& object,
                                                std::int64_t time_ns = 0) const {
    const auto world = world_->WithObject(object, 0);
    StructureContacts contacts(world_, LabelTable(scenario_.labels));
    return contacts.Find(*world, world->objects().size() - 1, time_ns);
  }

  TemporaryDirectory directory_;
  ScenarioSpec scenario_;
  std::shared_ptr<const RailWorld> world_;
};

TEST_F(StructureContactsTest, AreAtThePlatformsEdgeButNotOnThePlatform) {
  EXPECT_THAT(FindAt(450.0, -1.65), Optional(std::string("platform")));
  EXPECT_EQ(FindAt(450.0, -3.0), std::nullopt);
  EXPECT_EQ(FindAt(450.0, -1.0), std::nullopt);
}

TEST_F(StructureContactsTest, AreInAWall) {
  EXPECT_THAT(FindAt(450.0, 3.85), Optional(std::string("noise_wall")));
  EXPECT_EQ(FindAt(450.0, 3.3), std::nullopt);
  EXPECT_EQ(FindAt(490.0, 3.85), std::nullopt);
}

TEST_F(StructureContactsTest, AreInAMast) {
  const std::uint32_t mast = LabelTable(scenario_.labels).Id("mast");
  int num_masts = 0;
  for (const int chunk : {10, 11, 12}) {
    for (const Placement& placement : world_->BuildChunk(chunk).placements) {
      // Cantilevers have the instances of their masts.
      const bool is_mast = placement.model->parts.front().label == mast;
      if (!is_mast || placement.instance < kFirstMastInstance) continue;
      const PlaceBesideLine foot = PlaceOnLine(
          world_->alignment(),
          world_->WorldFromChunk(chunk) * placement.chunk_from_model.translation(), 50.0 * chunk);
      EXPECT_THAT(FindAt(foot.s_m, foot.d_m), Optional(std::string("mast"))) << foot.s_m;
      EXPECT_EQ(FindAt(foot.s_m + 1.0, foot.d_m), std::nullopt);
      ++num_masts;
    }
  }
  EXPECT_GT(num_masts, 1);
}

TEST_F(StructureContactsTest, AreNotInTheTrackOrTheGround) {
  ObjectSpec person;
  person.name = "person";
  person.type = ObjectType::kPerson;
  person.person = PersonSpec{.posture = Posture::kLying};
  person.s_m = 520.0;
  person.heading_deg = 90.0;
  for (const double d_m : {0.0, -0.8, -2.0, -12.0}) {
    person.d_m = d_m;
    EXPECT_EQ(Find(person), std::nullopt) << d_m;
  }
}

// Objects are placed with the help of a line that has none, since making them takes long.
TEST_F(StructureContactsTest, AreTheSameOnALineWithoutPlants) {
  VegetationSpec& plants = scenario_.world.vegetation;
  ASSERT_GT(plants.trees_per_hectare, 0.0);
  plants.trees_per_hectare = plants.bushes_per_hectare = 0.0;
  plants.grass = false;
  StructureContacts with_plants(world_, LabelTable(scenario_.labels));
  StructureContacts without(MakeWorld(scenario_), LabelTable(scenario_.labels));
  ObjectSpec box;
  box.name = "box";
  box.type = ObjectType::kBox;
  box.size_m = {1.0, 1.0, 3.0};
  int num_found = 0;
  for (box.s_m = 415.0; box.s_m < 470.0; box.s_m += 5.0) {
    for (box.d_m = -12.0; box.d_m <= 12.0; box.d_m += 0.75) {
      const auto world = world_->WithObject(box, 0);
      const std::size_t index = world->objects().size() - 1;
      const auto found = with_plants.Find(*world, index, 0);
      EXPECT_EQ(without.Find(*world, index, 0), found) << box.s_m << ' ' << box.d_m;
      if (found) ++num_found;
    }
  }
  EXPECT_GT(num_found, 20);
}

TEST_F(StructureContactsTest, ComeAndGoWithTheObjectsMotion) {
  ObjectSpec box;
  box.name = "box";
  box.type = ObjectType::kBox;
  box.size_m = {1.0, 1.0, 1.0};
  box.d_m = 3.8;
  box.s_m = 410.0;
  MotionSpec motion;
  motion.profile = {{.time_s = 0.0, .s_m = {}, .speed_mps = 5.0}};
  box.motion = motion;
  EXPECT_EQ(Find(box, 0), std::nullopt);
  EXPECT_THAT(Find(box, 4'000'000'000), Optional(std::string("noise_wall")));
  EXPECT_EQ(Find(box, 20'000'000'000), std::nullopt);
}

}  // namespace
}  // namespace railcast
