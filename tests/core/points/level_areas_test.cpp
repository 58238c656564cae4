#include "core/points/level_areas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace railcast {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// Rings of a sensor's points on a plane, from a distance on.
void AddGround(double below_m, double slope, double from_m, Points& points_m) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, 0.01);
  for (double way_m = from_m; way_m < 40.0; way_m *= 1.06) {
    for (double turn_rad = 0.0; turn_rad < 6.28; turn_rad += 0.01) {
      const double x_m = way_m * std::cos(turn_rad);
      points_m.emplace_back(static_cast<float>(x_m), static_cast<float>(way_m * std::sin(turn_rad)),
                            static_cast<float>(slope * x_m - below_m + noise(random)));
    }
  }
}

void AddBox(double x_m, double y_m, double half_m, double z_m, Points& points_m) {
  for (double x = -half_m; x <= half_m; x += 0.1) {
    for (double y = -half_m; y <= half_m; y += 0.1) {
      points_m.emplace_back(static_cast<float>(x_m + x), static_cast<float>(y_m + y),
                            static_cast<float>(z_m));
    }
  }
}

TEST(LevelAreas, OfGroundAreOnePlaneWhateverItsSlope) {
  for (const double below_m : {0.4, 1.8, 4.5}) {
    for (const double slope : {0.0, 0.04, -0.12}) {
      Points points_m;
      AddGround(below_m, slope, 3.5, points_m);
      const GroundBelow ground = FindGroundBelow(points_m);
      ASSERT_TRUE(ground.is_found);
      EXPECT_NEAR(ground.below_m, below_m, 0.02);
    }
  }
}

TEST(LevelAreas, LeaveOutTheVehicleWallsAndWhatIsAbove) {
  Points points_m;
  AddGround(1.9, 0.0, 5.0, points_m);
  AddBox(0.0, 0.0, 1.5, -0.115, points_m);  // A roof,
  AddBox(8.0, 8.0, 1.0, -0.6, points_m);    // a car's,
  AddBox(0.0, 0.0, 20.0, 3.0, points_m);    // and a ceiling.
  for (double z_m = -1.9; z_m < 3.0; z_m += 0.1) {
    for (double y_m = -20.0; y_m < 20.0; y_m += 0.1) {
      points_m.emplace_back(10.0F, static_cast<float>(y_m), static_cast<float>(z_m));
    }
  }
  const GroundBelow ground = FindGroundBelow(points_m);
  ASSERT_TRUE(ground.is_found);
  EXPECT_NEAR(ground.below_m, 1.9, 0.02);
}

TEST(LevelAreas, OfSimilarSizeAreBothNamed) {
  Points points_m;
  AddBox(6.0, 0.0, 5.0, -3.0, points_m);
  AddBox(-6.0, 0.0, 4.5, -2.0, points_m);
  const GroundBelow ground = FindGroundBelow(points_m);
  EXPECT_FALSE(ground.is_found);
  ASSERT_EQ(ground.rivals.size(), 2U);
  EXPECT_NEAR(ground.rivals[0].below_m, 3.0, 1e-3);
  EXPECT_NEAR(ground.rivals[1].below_m, 2.0, 1e-3);
  // Squares of 0.5 m that are met.
  EXPECT_NEAR(ground.rivals[0].area_m2, 100.0, 25.0);
}

// Each beam meets all walls at about one height.
TEST(LevelAreas, AreNoneOnWallsThatLevelBeamsMeet) {
  for (const double radius_m : {3.5, 8.0, 20.0}) {
    Points points_m;
    for (const double depression_rad : {0.002, 0.01, 0.03}) {
      for (double turn_rad = 0.0; turn_rad < 6.28; turn_rad += 0.005) {
        const double way_m = radius_m * (1.0 + 0.1 * std::cos(3.0 * turn_rad));
        points_m.emplace_back(static_cast<float>(way_m * std::cos(turn_rad)),
                              static_cast<float>(way_m * std::sin(turn_rad)),
                              static_cast<float>(-way_m * depression_rad));
      }
    }
    EXPECT_TRUE(FindLevelAreas(points_m).empty()) << radius_m;
  }
}

TEST(LevelAreas, AreNoneInAChaosOfPointsAndWithoutPoints) {
  EXPECT_TRUE(FindLevelAreas({}).empty());
  EXPECT_TRUE(FindLevelAreas(Points(100, Eigen::Vector3f(NAN, NAN, NAN))).empty());
  std::mt19937_64 random(5);
  std::uniform_real_distribution<float> place(-20.0F, 20.0F);
  Points points_m;
  for (int i = 0; i < 2000; ++i) points_m.emplace_back(place(random), place(random), place(random));
  EXPECT_FALSE(FindGroundBelow(points_m).is_found);
}

}  // namespace
}  // namespace railcast
