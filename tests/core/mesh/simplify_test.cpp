#include "core/mesh/simplify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/mesh/mesh_deviation.h"
#include "core/scene/shapes.h"
#include "tests/core/mesh/imported_meshes.h"
#include "tests/core/mesh/simple_meshes.h"

namespace railcast {
namespace {

constexpr double kNormal_deg = 20.0;

/// Triangles of a mesh that a plate is bent to.
template <class Height>
Mesh Bent(Mesh mesh, const Height& height_m) {
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    vertex.z() = static_cast<float>(
        height_m(static_cast<double>(vertex.x()), static_cast<double>(vertex.y())));
  }
  return mesh;
}

/// A box whose sides are dense plates.
Mesh DenseBox(double length_m, int num_across) {
  const Mesh plate = Plate(length_m, num_across);
  Mesh box;
  const Transform out(Eigen::Translation3d(0, 0, 0.5 * length_m));
  constexpr double kRight_rad = 0.5 * std::numbers::pi;
  for (int turn = 0; turn < 4; ++turn) {
    box.Append(plate, Transform(Eigen::AngleAxisd(turn * kRight_rad, Vector3::UnitX())) * out);
  }
  for (const double turn : {-1.0, 1.0}) {
    box.Append(plate, Transform(Eigen::AngleAxisd(turn * kRight_rad, Vector3::UnitY())) * out);
  }
  // Rotations by right angles leave rounding errors that would open the edges.
  for (Eigen::Vector3f& vertex : box.vertices) {
    vertex = (vertex * 1024.0F).array().round() / 1024.0F;
  }
  return box;
}

Vector3 NormalOf(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const Vector3 a = mesh.vertices[triangle[0]].cast<double>();
  const Vector3 b = mesh.vertices[triangle[1]].cast<double>();
  const Vector3 c = mesh.vertices[triangle[2]].cast<double>();
  return (b - a).cross(c - a);
}

double Angle_deg(const Vector3& one, const Vector3& other) {
  return std::atan2(one.cross(other).norm(), one.dot(other)) * 180.0 / std::numbers::pi;
}

/// What holds of every simplified mesh.
void ExpectWithin(const Mesh& made, const Mesh& mesh, double tolerance_m) {
  EXPECT_LE(made.triangles.size(), mesh.triangles.size());
  ASSERT_FALSE(made.triangles.empty());
  EXPECT_TRUE(MeshSurface(mesh).DeviationWithin_m(made, tolerance_m));
  EXPECT_TRUE(MeshSurface(made).DeviationWithin_m(mesh, tolerance_m));
  for (const auto& triangle : made.triangles) EXPECT_GT(NormalOf(made, triangle).norm(), 1e-12);
}

Mesh Simplified(const Mesh& mesh, double tolerance_m) {
  const SimplifiedParts made =
      Simplified(std::vector<Mesh>{mesh}, {.deviation_m = tolerance_m, .normal_deg = kNormal_deg});
  EXPECT_LE(made.deviation_m, tolerance_m);
  return made.parts.at(0);
}

std::vector<std::array<float, 3>> SortedPlaces(const Mesh& mesh) {
  std::vector<std::array<float, 3>> places;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    places.push_back({vertex.x(), vertex.y(), vertex.z()});
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

TEST(Simplify, LeavesOutMostOfADenseSphere) {
  const Mesh sphere = Sphere(0.5, 120);
  const double sagitta_m = 0.5 * (1.0 - std::cos(std::numbers::pi / 120)) * 2.0;
  std::size_t num_before = sphere.triangles.size();
  for (const double tolerance_m : {0.0025, 0.01}) {
    const Mesh made = Simplified(sphere, tolerance_m);
    ExpectWithin(made, sphere, tolerance_m);
    EXPECT_LT(made.triangles.size(), num_before / 2) << tolerance_m;
    num_before = made.triangles.size();
    // Every place on it, against the sphere itself.
    for (const auto& [a, b, c] : made.triangles) {
      const Vector3 middle =
          (made.vertices[a] + made.vertices[b] + made.vertices[c]).cast<double>() / 3.0;
      EXPECT_NEAR(middle.norm(), 0.5, tolerance_m + sagitta_m);
    }
  }
}

TEST(Simplify, KeepsNormalsWithinTheirAngle) {
  const Mesh sphere = Sphere(0.5, 100);
  // The tolerance alone would let far fewer triangles stand for the sphere.
  const Mesh made = Simplified(sphere, 0.1);
  ExpectWithin(made, sphere, 0.1);
  EXPECT_LT(made.triangles.size(), sphere.triangles.size() / 4);
  const double of_its_own_deg = 360.0 / 100;
  for (const auto& triangle : made.triangles) {
    const Vector3 normal = NormalOf(made, triangle);
    for (const std::uint32_t corner : triangle) {
      EXPECT_LT(Angle_deg(normal, made.vertices[corner].cast<double>()),
                kNormal_deg + of_its_own_deg);
    }
  }
}

TEST(Simplify, LeavesFewTrianglesOfAPlateAndItsHole) {
  const Mesh plate = Plate(1.0, 100, 0.2);
  const Mesh made = Simplified(plate, 0.0025);
  ExpectWithin(made, plate, 0.0025);
  EXPECT_LE(made.triangles.size(), 16);
  EXPECT_NEAR(Area(made), 1.0 - 0.04, 1e-5);
  EXPECT_NEAR(Bounds(made).sizes().norm(), std::sqrt(2.0), 1e-6);
}

TEST(Simplify, LeavesTwelveTrianglesOfABox) {
  const Mesh dense = DenseBox(1.0, 32);
  const Mesh made = Simplified(dense, 0.0025);
  ExpectWithin(made, dense, 0.0025);
  EXPECT_EQ(made.triangles.size(), 12);
  EXPECT_NEAR(Area(made), 6.0, 1e-5);
}

TEST(Simplify, LeavesABoxOfTwelveAsItIs) {
  const Mesh box = MakeBox(Eigen::AlignedBox3d(Vector3(0, 0, 0), Vector3(4, 2, 1)));
  const Mesh made = Simplified(box, 0.1);
  EXPECT_EQ(made.triangles, box.triangles);
  EXPECT_EQ(made.vertices, box.vertices);
}

/// A sheet with steps of 45 degrees: any collapse turns a normal by more than it may.
TEST(Simplify, LeavesAMeshAsItIsIfNothingKeepsToTheTolerance) {
  const Mesh folded = Bent(Plate(1.0, 20), [](double x, double y) {
    return 0.05 * std::abs(std::remainder(x / 0.05, 2.0)) +
           0.05 * std::abs(std::remainder(y / 0.05, 2.0));
  });
  const Mesh made = Simplified(folded, 0.0005);
  EXPECT_EQ(made.triangles, folded.triangles);
  EXPECT_EQ(made.vertices, folded.vertices);
}

TEST(Simplify, KeepsThePointsOfBordersThatAreNotStraight) {
  Mesh saw = Plate(1.0, 40);
  std::vector<Eigen::Vector3f> teeth;
  for (std::size_t v = 0; v < saw.vertices.size(); ++v) {
    Eigen::Vector3f& vertex = saw.vertices[v];
    if (vertex.y() < 0.499F) continue;
    if (v % 2 == 0) vertex.y() += 0.004F;
    teeth.push_back(vertex);
  }
  const Mesh made = Simplified(saw, 0.005);
  ExpectWithin(made, saw, 0.005);
  EXPECT_LT(made.triangles.size(), saw.triangles.size() / 4);
  for (const Eigen::Vector3f& tooth : teeth) {
    EXPECT_THAT(made.vertices, testing::Contains(tooth));
  }
}

TEST(Simplify, KeepsThePointsWherePartsMeet) {
  const Mesh plate = Plate(1.0, 30);
  std::vector<Mesh> halves(2, {.vertices = plate.vertices, .triangles = {}});
  for (std::size_t t = 0; t < plate.triangles.size(); ++t) {
    halves[2 * t / plate.triangles.size()].triangles.push_back(plate.triangles[t]);
  }
  const SimplifiedParts made =
      Simplified(halves, {.deviation_m = 0.0025, .normal_deg = kNormal_deg});
  for (std::size_t p = 0; p < 2; ++p) {
    ExpectWithin(made.parts[p], halves[p], 0.0025);
    EXPECT_LT(made.parts[p].triangles.size(), 40);
    const auto num_at_seam =
        std::count_if(made.parts[p].vertices.begin(), made.parts[p].vertices.end(),
                      [](const Eigen::Vector3f& vertex) { return std::abs(vertex.y()) < 1e-6F; });
    EXPECT_EQ(num_at_seam, 31);
  }
}

/// Three plates meet at an edge, which OpenMesh cannot hold.
TEST(Simplify, KeepsToTheToleranceWhereThreePlatesMeet) {
  Mesh star = Plate(1.0, 20);
  star.Append(Plate(1.0, 20),
              Transform(Eigen::Translation3d(0, 0, 0.5)) *
                  Transform(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3::UnitX())));
  const Mesh made = Simplified(star, 0.0025);
  ExpectWithin(made, star, 0.0025);
  EXPECT_LT(made.triangles.size(), star.triangles.size() / 4);
}

TEST(Simplify, KeepsRandomTrianglesWithinTheTolerance) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<float> place(-1.0F, 1.0F);
  Mesh soup;
  for (int v = 0; v < 300; ++v) {
    soup.vertices.emplace_back(place(generator), place(generator), place(generator));
  }
  std::uniform_int_distribution<std::uint32_t> vertex(0, 299);
  while (soup.triangles.size() < 400) {
    const std::array<std::uint32_t, 3> triangle = {vertex(generator), vertex(generator),
                                                   vertex(generator)};
    if (NormalOf(soup, triangle).norm() > 1e-3) soup.triangles.push_back(triangle);
  }
  ExpectWithin(Simplified(soup, 0.05), soup, 0.05);
}

TEST(Simplify, GivesTheSameAtAnyNumberOfThreads) {
  std::vector<Mesh> parts;
  for (int i = 0; i < 3; ++i) {
    parts.push_back(Bent(Plate(1.0, 24 + i), [i](double x, double y) {
      return 0.1 * std::sin(3.0 * x + i) * std::cos(4.0 * y) + 5.0 * i;
    }));
  }
  const SimplifyLimits limits{.deviation_m = 0.002, .normal_deg = kNormal_deg};
  const SimplifiedParts many = Simplified(parts, limits);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const SimplifiedParts alone = Simplified(parts, limits);
  EXPECT_EQ(many.deviation_m, alone.deviation_m);
  EXPECT_GT(many.deviation_m, 0.0);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    EXPECT_EQ(many.parts[p].triangles, alone.parts[p].triangles);
    EXPECT_EQ(SortedPlaces(many.parts[p]), SortedPlaces(alone.parts[p]));
  }
}

TEST(SimplifyOnce, MakesAMeshOnceForEachToleranceAndContent) {
  const std::vector<Mesh> parts = {Plate(1.0, 30)};
  const SimplifyLimits limits{.deviation_m = 0.0025, .normal_deg = kNormal_deg};
  const auto first = SimplifiedOnce(parts, limits);
  EXPECT_EQ(SimplifiedOnce(std::vector<Mesh>(parts), limits), first);
  EXPECT_NE(SimplifiedOnce(parts, {.deviation_m = 0.003, .normal_deg = kNormal_deg}), first);
  EXPECT_NE(SimplifiedOnce({Plate(1.0, 31)}, limits), first);
  EXPECT_EQ(first->parts.at(0).triangles, Simplified(parts, limits).parts.at(0).triangles);
}

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
