#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

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

}  // namespace
}  // namespace railcast
