#include "core/mesh/mesh_deviation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/core/mesh/simple_meshes.h"

namespace railcast {
namespace {

TEST(MeshDeviation, OfAPlateAboveAnotherIsItsHeight) {
  const Mesh plate = Plate(1.0, 20);
  Mesh raised = Plate(1.0, 7);
  for (Eigen::Vector3f& vertex : raised.vertices) vertex.z() += 0.05F;
  const auto deviation_m = MeshSurface(plate).DeviationWithin_m(raised, 0.1);
  ASSERT_TRUE(deviation_m);
  EXPECT_NEAR(*deviation_m, 0.05, 1e-6);
}

TEST(MeshDeviation, OfAPeakIsThatOfItsTop) {
  Mesh peak = Plate(1.0, 2);
  for (Eigen::Vector3f& vertex : peak.vertices) {
    if (vertex.norm() < 0.1F) vertex.z() = 0.3F;
  }
  const auto deviation_m = MeshSurface(Plate(1.0, 1)).DeviationWithin_m(peak, 0.4);
  ASSERT_TRUE(deviation_m);
  EXPECT_NEAR(*deviation_m, 0.3, 1e-6);
}

TEST(MeshDeviation, IsUnknownBeyondTheLimit) {
  Mesh raised = Plate(1.0, 7);
  for (Eigen::Vector3f& vertex : raised.vertices) vertex.z() += 0.05F;
  const MeshSurface plate(Plate(1.0, 20));
  EXPECT_FALSE(plate.DeviationWithin_m(raised, 0.049));
  EXPECT_TRUE(plate.DeviationWithin_m(raised, 0.051));
}

/// The corners of the plate are at those of the frame, but nothing is near its middle.
TEST(MeshDeviation, SeesAHoleBetweenTheCornersOfATriangle) {
  const MeshSurface frame(Plate(1.0, 10, 0.4));
  EXPECT_FALSE(frame.DeviationWithin_m(Plate(1.0, 1), 0.19));
  const auto deviation_m = frame.DeviationWithin_m(Plate(1.0, 1), 0.25);
  ASSERT_TRUE(deviation_m);
  EXPECT_GT(*deviation_m, 0.15);
  EXPECT_LE(*deviation_m, 0.2);
  EXPECT_TRUE(MeshSurface(Plate(1.0, 1)).DeviationWithin_m(Plate(1.0, 10, 0.4), 1e-6));
}

TEST(MeshDeviation, OfAnInscribedSphereIsTheSagittaOfItsTriangles) {
  const double radius_m = 1.0;
  const MeshSurface fine(Sphere(radius_m, 128));
  const Mesh coarse = Sphere(radius_m, 32);
  // The middle of the longest edges, at the equator, is this much inside.
  const double sagitta_m = radius_m * (1.0 - std::cos(std::numbers::pi / 32));
  const auto deviation_m = fine.DeviationWithin_m(coarse, 3.0 * sagitta_m);
  ASSERT_TRUE(deviation_m);
  EXPECT_GT(*deviation_m, sagitta_m);
  EXPECT_LT(*deviation_m, 2.0 * sagitta_m);
}

}  // namespace
}  // namespace railcast
