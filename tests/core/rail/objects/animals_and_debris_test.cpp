#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "core/rail/line/rail_section.h"
#include "railcast/scenario.h"
#include "tests/core/rail/model_checks.h"
#include "tests/core/rail/shipped_models.h"
#include "tests/core/rail/test_tables.h"

namespace railcast {
namespace {

struct Animal {
  ObjectType type{};
  Vector3 size_m;  ///< Over head, antlers and tail.
  double withers_m{};
};
const std::vector<Animal> kAnimals = {{TypeNamed("deer"), {1.13, 0.31, 1.21}, 0.70},
                                      {TypeNamed("dog"), {1.22, 0.24, 0.88}, 0.63},
                                      {TypeNamed("cow"), {2.58, 0.70, 1.64}, 1.45}};

constexpr double kOfSource_m = 0.02;

class Animals : public testing::Test {
 protected:
  const SurfaceClass coat_ = SurfaceNamed("fur", "animal");
  const SurfaceClass horn_ = SurfaceNamed("horn", "animal");
};

TEST_F(Animals, HaveTheirSizesAndStandOnTheGround) {
  for (const Animal& animal : kAnimals) {
    const Model model = WholeModel(animal.type);
    const Eigen::AlignedBox3d box = model.Bounds();
    EXPECT_LT((box.sizes() - animal.size_m).cwiseAbs().maxCoeff(), kOfSource_m)
        << model.name << ": " << box.sizes().transpose();
    EXPECT_LT(box.center().head<2>().norm(), 1e-6) << model.name;
    EXPECT_NEAR(box.min().z(), 0.0, 1e-6) << model.name;
  }
}

/// The withers are the highest point of the back, above the forelegs and behind the neck.
TEST_F(Animals, AreAsHighAtTheWithersAsTheirKind) {
  for (const Animal& animal : kAnimals) {
    const Model model = WholeModel(animal.type);
    double hoof_x_m = 0.0;  // Mean of the front feet.
    int count = 0;
    for (const Vector3& p : VerticesOf(model, horn_)) {
      if (p.z() > 0.1 * animal.withers_m || p.x() < 0.0) continue;
      hoof_x_m += p.x();
      ++count;
    }
    ASSERT_GT(count, 0) << model.name;
    hoof_x_m /= count;
    double withers_m = 0.0;
    for (const Vector3& p : VerticesOf(model, coat_)) {
      const double behind_m = hoof_x_m - p.x();
      if (behind_m > 0.10 * animal.withers_m && behind_m < 0.25 * animal.withers_m) {
        withers_m = std::max(withers_m, p.z());
      }
    }
    EXPECT_NEAR(withers_m, animal.withers_m, 0.03 * animal.withers_m) << model.name;
  }
}

TEST_F(Animals, StandOnFourLegs) {
  for (const Animal& animal : kAnimals) {
    const Model model = WholeModel(animal.type);
    std::array<bool, 4> has_foot{};
    for (const Vector3& p : VerticesOf(model, horn_)) {
      if (p.z() < 0.01) has_foot.at((p.x() > 0.0 ? 2 : 0) + (p.y() > 0.0 ? 1 : 0)) = true;
    }
    EXPECT_EQ(std::count(has_foot.begin(), has_foot.end(), true), 4) << model.name;
    // Between the feet and the belly there is a way through between the legs.
    for (const Vector3& p : VerticesOf(model, coat_)) {
      const double share = p.z() / animal.withers_m;
      if (share > 0.12 && share < 0.28) {
        EXPECT_GT(std::abs(p.y()), 0.02) << model.name << ": " << p.transpose();
      }
    }
  }
}

TEST_F(Animals, AreClosedBodiesOfAFewThousandTriangles) {
  for (const Animal& animal : kAnimals) {
    const Model model = WholeModel(animal.type);
    EXPECT_GE(model.num_triangles(), 500U) << model.name;
    EXPECT_LE(model.num_triangles(), 5000U) << model.name;
    EXPECT_EQ(CountBadTriangles(model), 0U) << model.name;
    EXPECT_EQ(CountOpenEdges(model), 0U) << model.name;
    for (const Part& part : model.parts) EXPECT_EQ(part.label, coat_.label);
  }
}

constexpr double kDebrisRounding_m = 1e-6;

TEST(Debris, HasItsSizesAndItsFootOnTheGround) {
  const std::vector<std::pair<ObjectType, Vector3>> sizes_m = {
      {TypeNamed("pallet"), {1.200, 0.800, 0.144}},
      {TypeNamed("tyre"), {1.014, 1.014, 0.312}},
      {TypeNamed("boulder"), {0.80, 0.68, 0.56}},
      {TypeNamed("ballast_heap"), {1.5, 1.5, 0.75 * std::tan(37.0 * std::numbers::pi / 180.0)}},
      {TypeNamed("landslide"), {8.0, 6.0, 1.2}}};
  for (const auto& [type, size_m] : sizes_m) {
    const Model model = WholeModel(type);
    const Eigen::AlignedBox3d box = model.Bounds();
    EXPECT_LT((box.sizes() - size_m).cwiseAbs().maxCoeff(), 1e-3)
        << model.name << ": " << box.sizes().transpose();
    EXPECT_LT(box.center().head<2>().norm(), kDebrisRounding_m) << model.name;
    EXPECT_NEAR(box.min().z(), 0.0, kDebrisRounding_m) << model.name;
  }
}

TEST(Debris, ConsistsOfClosedBodiesButForLeaves) {
  for (const ObjectType& type : TypesLabelled({"object", "tree", "contact_wire"})) {
    Model model = WholeModel(type);
    EXPECT_EQ(CountBadTriangles(model), 0U) << model.name;
    EXPECT_LE(model.num_triangles(), 5000U) << model.name;
    std::erase_if(model.parts,
                  [&](const Part& part) { return part.material == RailMaterials().Index("leaf"); });
    EXPECT_GT(model.num_triangles(), 100U) << model.name;
    EXPECT_EQ(CountOpenEdges(model), 0U) << model.name;
  }
}

/// The boards of EN 13698-1, found by their corners: MakeBox() has eight vertices.
TEST(Debris, HasThePalletsBoardsAndBlocks) {
  const Model pallet = WholeModel(TypeNamed("pallet"));
  const auto& vertices = pallet.parts.at(0).mesh.vertices;
  std::multiset<std::array<int, 3>> boards_mm;
  for (std::size_t first = 0; first < vertices.size(); first += 8) {
    Eigen::AlignedBox3f box;
    for (std::size_t i = first; i < first + 8; ++i) box.extend(vertices[i]);
    const Eigen::Vector3f size_mm = 1000.0F * box.sizes();
    boards_mm.insert({static_cast<int>(std::lround(size_mm.x())),
                      static_cast<int>(std::lround(size_mm.y())),
                      static_cast<int>(std::lround(size_mm.z()))});
  }
  EXPECT_EQ(boards_mm.size(), 20U);
  EXPECT_EQ(boards_mm.count({1200, 145, 22}), 4U);  // Three of the deck and one at the bottom.
  EXPECT_EQ(boards_mm.count({1200, 100, 22}), 4U);  // Two of the deck and two at the bottom.
  EXPECT_EQ(boards_mm.count({145, 800, 22}), 3U);
  EXPECT_EQ(boards_mm.count({145, 145, 78}), 3U);
  EXPECT_EQ(boards_mm.count({145, 100, 78}), 6U);
}

/// The wire is a tube of eight sides: rings of eight vertices from its top to its end, and the
/// middles of its two ends.
TEST(Debris, HangsAWireOfTheLengthOfItsCatenaryStretchAndCoils) {
  constexpr double kDiameter_m = 0.012;
  constexpr double kTop_m = 5.7;
  constexpr std::size_t kSides = 8;
  const Model wire = WholeModel(TypeNamed("hanging_wire"));
  const auto& vertices = wire.parts.at(0).mesh.vertices;
  std::vector<Vector3> axis;
  for (std::size_t ring = 0; ring + kSides <= vertices.size(); ring += kSides) {
    Vector3 middle_m = Vector3::Zero();
    for (std::size_t i = 0; i < kSides; ++i) middle_m += vertices[ring + i].cast<double>() / kSides;
    for (std::size_t i = 0; i < kSides; ++i) {
      ASSERT_NEAR((vertices[ring + i].cast<double>() - middle_m).norm(), 0.5 * kDiameter_m, 5e-4);
    }
    axis.push_back(middle_m);
  }
  double length_m = 0.0;
  for (std::size_t i = 1; i < axis.size(); ++i) length_m += (axis[i] - axis[i - 1]).norm();
  // z = a (cosh(x / a) - 1) has the arc length sqrt((z + a)^2 - a^2) from its lowest point.
  constexpr double kA_m = 0.5;
  const double high_m = kTop_m - 0.5 * kDiameter_m + kA_m;
  const double expected_m =
      std::sqrt(high_m * high_m - kA_m * kA_m) + 1.5 + 2.5 * 2.0 * std::numbers::pi * 0.35;
  // Chords of 15 degrees are 0.3 % shorter than their arcs.
  EXPECT_NEAR(length_m, expected_m, 0.003 * expected_m);
  EXPECT_LT(length_m, expected_m + 0.01);
  // It bends like a wire, everywhere by less than 20 degrees from piece to piece.
  for (std::size_t i = 2; i < axis.size(); ++i) {
    const Vector3 before = (axis[i - 1] - axis[i - 2]).normalized();
    EXPECT_GT(before.dot((axis[i] - axis[i - 1]).normalized()), std::cos(0.35)) << i;
  }
  EXPECT_NEAR(wire.Bounds().sizes().z(), kTop_m, 0.01);
  EXPECT_EQ(wire.parts.at(0).label, RailLabels().Id("contact_wire"));
}

/// The guides of the shoe clear the rail that it lies on, and its sole covers the rail's head.
TEST(Debris, LaysTheDragShoeOnTheRail) {
  const Model shoe = WholeModel(TypeNamed("drag_shoe"));
  const Eigen::AlignedBox3d box = shoe.Bounds();
  EXPECT_NEAR(box.max().z(), 0.125, kDebrisRounding_m);
  EXPECT_NEAR(box.min().z(), -0.020, kDebrisRounding_m);
  EXPECT_LT(box.center().head<2>().norm(), kDebrisRounding_m);
  const RailSection rail = MakeRailSection(true);
  double middle_m = 0.0;
  double half_width_m = 0.0;
  double inner_m = 1e9;
  double outer_m = -1e9;
  for (const Eigen::Vector2d& p : rail.outline_m) {
    if (p.y() < -0.030) continue;
    inner_m = std::min(inner_m, std::abs(p.x()));
    outer_m = std::max(outer_m, std::abs(p.x()));
  }
  middle_m = 0.5 * (inner_m + outer_m);
  half_width_m = 0.5 * (outer_m - inner_m);
  EXPECT_NEAR(middle_m, 0.753, 0.002);  // The d_m of the documentation.
  EXPECT_LT(half_width_m, 0.038);
  for (const Part& part : shoe.parts) {
    for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
      if (vertex.z() < -1e-4F) {
        EXPECT_GE(std::abs(vertex.y()), 0.0369F);
      }
    }
  }
}

TEST(Debris, LaysTheFallenTreeAcrossTheTrack) {
  const Eigen::AlignedBox3d box = WholeModel(TypeNamed("fallen_tree")).Bounds();
  EXPECT_NEAR(box.sizes().y(), 10.0, 0.6);
  EXPECT_LT(box.sizes().x(), 6.0);
  EXPECT_NEAR(box.min().z(), 0.0, kDebrisRounding_m);
  EXPECT_NEAR(WholeModel(TypeNamed("branch")).Bounds().sizes().x(), 2.5, kDebrisRounding_m);
}

}  // namespace
}  // namespace railcast
