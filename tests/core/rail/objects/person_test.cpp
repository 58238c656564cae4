#include "core/rail/objects/object_models.h"

#include <gtest/gtest.h>

#include "tests/core/rail/model_checks.h"
#include "tests/core/rail/test_tables.h"

namespace railcast {
namespace {

TEST(MakePerson, StandsOnTheGroundAtTheGivenHeight) {
  for (const double height_m : {1.75, 1.20, 2.0}) {
    const Eigen::AlignedBox3d box = MakePerson(TestSurfaces(), height_m).Bounds();
    EXPECT_NEAR(box.min().z(), 0.0, 1e-6);
    EXPECT_NEAR(box.max().z(), height_m, 1e-6);
    // Arms hang at the sides; the stride is at most half the height.
    EXPECT_NEAR(box.sizes().y() / height_m, 0.6 / 1.75, 0.03);
    EXPECT_LT(box.sizes().x(), 0.5 * height_m);
  }
}

TEST(MakePerson, IsMadeOfFewAndSoundTriangles) {
  const RailSurfaces surfaces = TestSurfaces();
  const Model person = MakePerson(surfaces);
  EXPECT_LT(person.num_triangles(), 3000U);
  EXPECT_EQ(CountBadTriangles(person), 0U);
  for (const Part& part : person.parts) EXPECT_EQ(part.label, surfaces.skin.label);
}

TEST(MakePerson, HasABareHeadAndHandsAndClothesElsewhere) {
  const RailSurfaces surfaces = TestSurfaces();
  const Model person = MakePerson(surfaces);
  for (const Vector3& p : VerticesOf(person, surfaces.clothing)) EXPECT_LT(p.z(), 1.51);
  bool has_hands = false;
  for (const Vector3& p : VerticesOf(person, surfaces.skin)) {
    EXPECT_TRUE(p.z() > 1.45 || (p.z() < 0.95 && std::abs(p.y()) > 0.2)) << p.transpose();
    has_hands = has_hands || p.z() < 0.95;
  }
  EXPECT_TRUE(has_hands);
}

}  // namespace
}  // namespace railcast
