#include "core/scene/object_contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/scene/shapes.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

// Coordinates as large as in a national grid leave 1e-9 m; vertices are float32.
constexpr double kContactRounding_m = 1e-5;

std::shared_ptr<const Model> SharedModel(Mesh mesh) {
  return std::make_shared<const Model>(Model{"model", {{std::move(mesh), 1, 9}}});
}

// Returns a cube that extends `half_size_m` from its centre to each side.
std::shared_ptr<const Model> Cube(double half_size_m = 0.5) {
  const Vector3 corner_m = Vector3::Constant(half_size_m);
  return SharedModel(MakeBox({-corner_m, corner_m}));
}

std::shared_ptr<const Model> Ball(double radius_m) {
  constexpr int kSides = 60;
  return SharedModel(MakeSphere(radius_m, kSides, kSides));
}

Transform At(double x_m, double y_m, double z_m, double yaw_rad = 0.0) {
  return MakeTransform(RotationFromYawPitchRoll(yaw_rad, 0.0, 0.0), {x_m, y_m, z_m});
}

SimpleWorld WorldOf(const std::shared_ptr<const Model>& one,
                    const std::shared_ptr<const Model>& other,
                    const Transform& one_from_other) {
  SimpleWorld world;
  world.world_from_chunk = At(2'600'000.0, 1'200'000.0, 450.0, 0.7);
  world.AddObject(one, At(3.0, 4.0, 0.0));
  world.AddObject(other, At(3.0, 4.0, 0.0) * one_from_other);
  return world;
}

// Returns the gap between two objects, or NaN where they are apart, after checking that it does not
// depend on their order.
double GapOf_m(const std::shared_ptr<const Model>& one,
               const std::shared_ptr<const Model>& other,
               const Transform& one_from_other) {
  const SimpleWorld world = WorldOf(one, other, one_from_other);
  const SimpleWorld turned = WorldOf(other, one, one_from_other.inverse());
  const std::vector<ObjectContact> contacts = ContactFinder(world).FindAll(0);
  const std::vector<ObjectContact> reversed = ContactFinder(turned).FindAll(0);
  EXPECT_EQ(contacts.size(), reversed.size());
  if (contacts.empty() || reversed.empty()) return std::nan("");
  EXPECT_EQ(contacts[0].one, 0U);
  EXPECT_EQ(contacts[0].other, 1U);
  EXPECT_NEAR(contacts[0].gap_m, reversed[0].gap_m, kContactRounding_m);
  return contacts[0].gap_m;
}

bool AreApart(const std::shared_ptr<const Model>& one,
              const std::shared_ptr<const Model>& other,
              const Transform& one_from_other) {
  return std::isnan(GapOf_m(one, other, one_from_other));
}

TEST(ObjectContacts, BoxesTouchUpToTwoCentimetresAndThenOverlap) {
  EXPECT_TRUE(AreApart(Cube(), Cube(), At(1.021, 0.0, 0.0)));
  EXPECT_NEAR(GapOf_m(Cube(), Cube(), At(1.019, 0.3, 0.3)), 0.019, kContactRounding_m);
  EXPECT_NEAR(GapOf_m(Cube(), Cube(), At(1.0, 0.0, 0.0)), 0.0, kContactRounding_m);
  EXPECT_NEAR(GapOf_m(Cube(), Cube(), At(0.981, 0.0, 0.0)), -0.019, kContactRounding_m);
  EXPECT_FALSE((ObjectContact{0, 1, -0.019}.is_overlap()));
  EXPECT_TRUE((ObjectContact{0, 1, -0.021}.is_overlap()));
}

TEST(ObjectContacts, MeasuresRotatedBoxes) {
  constexpr double kEighth_rad = std::numbers::pi / 4.0;
  const double corner_m = std::sqrt(0.5);
  const double apart_m = 0.5 + corner_m + 0.012;
  EXPECT_NEAR(GapOf_m(Cube(), Cube(), At(apart_m, 0.1, 0.0, kEighth_rad)), 0.012,
              kContactRounding_m);
  EXPECT_NEAR(GapOf_m(Cube(), Cube(), At(apart_m - 0.112, 0.1, 0.0, kEighth_rad)), -0.1,
              kContactRounding_m);
}

TEST(ObjectContacts, BoxesAroundThemMayOverlapWhereTheyAreApart) {
  // Diagonally across the corner of their boxes, the centres of two balls are 2.4 m apart.
  EXPECT_TRUE(AreApart(Ball(1.0), Ball(1.0), At(1.7, 1.7, 0.0)));
  // The facets lie inside the ball by up to 1 - cos(pi / 60) along either circle.
  constexpr double kFacets_m = 0.006;
  EXPECT_NEAR(GapOf_m(Ball(1.0), Ball(1.0), At(1.3, 1.3, 0.0)), 1.3 * std::sqrt(2.0) - 2.0,
              kFacets_m);
}

TEST(ObjectContacts, ABeamThroughACubeOverlapsThoughNoEdgesMeet) {
  const auto beam = SharedModel(MakeBox({Vector3(-3.0, -0.1, -0.1), Vector3(3.0, 0.1, 0.1)}));
  EXPECT_NEAR(GapOf_m(Cube(), beam, Transform::Identity()), -0.6, kContactRounding_m);
}

TEST(ObjectContacts, FindsWhatIsEnclosed) {
  // The way out of the ball is its radius and half the cube, and more where the corners lead.
  EXPECT_LT(GapOf_m(Ball(1.5), Cube(), Transform::Identity()), -1.9);
  // A hollow body that is not convex: a vault over an L. The cube meets none of its faces.
  const std::vector<Eigen::Vector2d> outline = {{0, 0}, {6, 0}, {6, 3}, {3, 3}, {3, 6}, {0, 6}};
  const auto hall = SharedModel(MakeExtrusion(outline, 0.0, 4.0));
  EXPECT_LT(GapOf_m(hall, Cube(), At(2.0, 1.5, 1.5)), -1.9);
  EXPECT_TRUE(AreApart(hall, Cube(), At(2.0, 4.5, 4.5)));
  // It leans on a wall of the notch, outside, and stands on the floor, inside.
  EXPECT_NEAR(GapOf_m(hall, Cube(), At(2.0, 3.5, 4.5)), 0.0, kContactRounding_m);
  EXPECT_LT(GapOf_m(hall, Cube(), At(2.0, 1.5, 0.5)), -0.9);
}

TEST(ObjectContacts, AnOpenTroughDoesNotEncloseItsLoad) {
  Mesh trough = MakeFloor(-1.0F, 2.0F);
  for (int side = 0; side < 4; ++side) {
    trough.Append(MakeWall(2.0F, 2.0F),
                  Transform(Eigen::AngleAxisd(0.5 * std::numbers::pi * side, Vector3::UnitZ())));
  }
  const auto model = SharedModel(trough);
  EXPECT_TRUE(AreApart(model, Cube(), Transform::Identity()));
  // The cube stands on the floor, and then in it.
  EXPECT_NEAR(GapOf_m(model, Cube(), At(0.3, 0.2, -0.5)), 0.0, kContactRounding_m);
  EXPECT_NEAR(GapOf_m(model, Cube(), At(0.3, 0.2, -0.55)), -0.05, kContactRounding_m);
}

TEST(ObjectContacts, FindsEveryPairOnceAtItsMoment) {
  SimpleWorld world;
  world.AddObject(Cube(), At(50.0, 0.0, 0.0), Vector3(-10.0, 0.0, 0.0));
  world.AddObject(Cube(), At(0.2, 0.0, 0.0));
  world.AddObject(Cube(), At(0.9, 0.0, 0.0));
  ContactFinder finder(world);
  ASSERT_EQ(finder.FindAll(0).size(), 1U);
  EXPECT_EQ(finder.FindAll(0)[0].one, 1U);
  constexpr std::int64_t kMet_ns = 5'000'000'000;
  const std::vector<ObjectContact> contacts = finder.FindAll(kMet_ns);
  ASSERT_EQ(contacts.size(), 3U);
  EXPECT_NEAR(contacts[0].gap_m, -0.8, kContactRounding_m);
  EXPECT_NEAR(contacts[1].gap_m, -0.1, kContactRounding_m);
  EXPECT_NEAR(contacts[2].gap_m, -0.3, kContactRounding_m);
  constexpr std::int64_t kLater_ns = 5'010'000'000;
  EXPECT_NEAR(finder.FindAll(kLater_ns)[0].gap_m, -0.7, kContactRounding_m);
  // Moments may be asked for in any order.
  EXPECT_EQ(finder.FindAll(0).size(), 1U);
}

TEST(ObjectContacts, FindsThoseOfTheVehicleAlone) {
  SimpleWorld world;
  world.AddObject(Cube(), At(0.9, 0.0, 0.0));
  world.AddObject(Cube(), At(1.8, 0.0, 0.0));
  world.AddObject(Cube(), At(0.0, 0.0, 0.0), Vector3(0.1, 0.0, 0.0), true);
  ContactFinder finder(world);
  const std::vector<ObjectContact> contacts = finder.FindOfVehicle(0);
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].one, 0U);
  EXPECT_EQ(contacts[0].other, 2U);
  EXPECT_NEAR(contacts[0].gap_m, -0.1, kContactRounding_m);
}

TEST(ObjectContacts, NothingTouchesWhatHasNoTriangles) {
  SimpleWorld world;
  world.AddObject(std::make_shared<const Model>(), At(0.0, 0.0, 0.0), Vector3::Zero(), true);
  world.AddObject(Cube(), At(0.0, 0.0, 0.0));
  EXPECT_TRUE(ContactFinder(world).FindAll(0).empty());
  EXPECT_TRUE(ContactFinder(world).FindOfVehicle(0).empty());
}

}  // namespace
}  // namespace railcast
