#include "core/rail/structures/standing_height.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "tests/core/rail/test_line.h"
#include "tests/core/rail/test_tables.h"
#include "tests/support/world_specs.h"

namespace railcast {
namespace {

/// Height of the mesh's highest point on the vertical through (x, y); minus infinity if there is
/// none.
double TopAt(const Mesh& mesh, const Transform& world_from_mesh, const Eigen::Vector2d& at_m) {
  double top_m = -std::numeric_limits<double>::infinity();
  for (const auto& triangle : mesh.triangles) {
    const auto corner = [&](int i) -> Vector3 {
      return world_from_mesh * mesh.vertices[triangle[static_cast<std::size_t>(i)]].cast<double>();
    };
    Eigen::Matrix3d corners;
    corners << corner(0), corner(1), corner(2);
    Eigen::Matrix3d plan = corners;
    plan.row(2).setOnes();
    if (std::abs(plan.determinant()) < 1e-9) continue;
    const Vector3 weights = plan.inverse() * Vector3(at_m.x(), at_m.y(), 1.0);
    if (weights.minCoeff() < 0.0) continue;
    top_m = std::max(top_m, corners.row(2).dot(weights));
  }
  return top_m;
}

/// Height of the surfaces that the chunk draws.
double DrawnHeight_m(const TestLine& line, int chunk, const Eigen::Vector2d& at_m) {
  const Chunk built = line.Build(chunk);
  const Transform world_from_chunk = line.WorldFromChunk(chunk);
  return std::max(TopAt(MeshOfSurface(built, line.surfaces().ground), world_from_chunk, at_m),
                  TopAt(MeshOfSurface(built, line.surfaces().ballast), world_from_chunk, at_m));
}

// Tolerances: ballast has grains of sigma 20 mm on a grid of 0.2 m and hollows around sleepers;
// ground roughness has a wavelength of 2 m on a grid of 0.5 m and coarser.
TEST(StandingHeight, IsThatOfTheDrawnSurfaceOnTheTrackBesideItAndInTheField) {
  for (const WorldSpec& spec : {StraightLine(300.0), CantedArc(300.0, 400.0)}) {
    const TestLine line(spec);
    ChunkContext context = line.Context(2);
    context.chunk_from_world = Transform::Identity();
    for (const double d_m : {0.0, 2.0, 2.6, -3.2, 5.0, -9.0, 14.0, 40.0}) {
      const double s_m = 122.3;
      const StandingPlace point{s_m, d_m, 0.0, {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()}};
      const Vector3 place = line.alignment().WorldFromTrack(s_m, d_m).translation();
      EXPECT_NEAR(StandingHeight_m(context, point), DrawnHeight_m(line, 2, place.head<2>()), 0.08)
          << d_m;
    }
  }
}

TEST(StandingHeight, TakesTheLowestCornerOnASlope) {
  const TestLine line(StraightLine(300.0));
  ChunkContext context = line.Context(2);
  context.chunk_from_world = Transform::Identity();
  // Across the ballast's slope of 1:1.5.
  const StandingPlace wide{
      122.3, 2.0, 0.0, {Eigen::Vector2d(-0.1, -0.2), Eigen::Vector2d(0.1, 0.2)}};
  const StandingPlace lower{
      122.3, 2.2, 0.0, {Eigen::Vector2d(-0.1, 0.0), Eigen::Vector2d(0.1, 0.0)}};
  EXPECT_NEAR(StandingHeight_m(context, wide), StandingHeight_m(context, lower), 1e-9);
  // Turned by 90 degrees, it extends as far to the side as it is long.
  StandingPlace turned = wide;
  turned.heading_rad = std::numbers::pi / 2.0;
  EXPECT_GT(StandingHeight_m(context, turned), StandingHeight_m(context, wide) + 0.05);
}

TEST(RailWorld, StandsObjectsOnTheGroundUnlessAHeightIsGiven) {
  WorldSpec spec = StraightLine(300.0);
  for (const double h_m : {0.0, 1.5}) {
    ObjectSpec object =
        ObjectAt(h_m == 0.0 ? "standing" : "hanging", ObjectType::kPerson, 120.0, -8.0);
    if (h_m > 0.0) object.h_m = h_m;
    spec.objects.push_back(object);
  }
  ObjectSpec wagon = spec.objects.front();
  wagon.name = "wagon";
  wagon.type = TypeNamed("flat_wagon");
  spec.objects.push_back(wagon);
  const RailWorld world(spec, {}, RailLabels(), RailMaterials(), 1);
  const double top_of_rail_m = world.alignment().At(120.0).position_m.z();
  EXPECT_NEAR(world.WorldFromObject(0, 0).translation().z(), top_of_rail_m - 0.7, 0.25);
  EXPECT_NEAR(world.WorldFromObject(1, 0).translation().z(), top_of_rail_m + 1.5, 1e-9);
  EXPECT_NEAR(world.WorldFromObject(2, 0).translation().z(), top_of_rail_m, 1e-9);
}

TEST(StandingHeight, IsThatOfThePlatformOnOne) {
  WorldSpec spec = CantedArc(300.0, 400.0);
  spec.structures = {StructureBeside<PlatformSpec>(TrackSide::kRight, "platform", 0.0, 300.0)};
  const TestLine line(spec);
  ChunkContext context = line.Context(2);
  context.chunk_from_world = Transform::Identity();
  const Eigen::AlignedBox2d feet(Eigen::Vector2d(-0.2, -0.2), Eigen::Vector2d(0.2, 0.2));
  // In the curve, the edge is farther from the axis by 3.75 m^2 / R, and by what its nose leans.
  const double lean = line.alignment().At(120.0).cant_rad;
  const double beside_m = 1.65 + 3.75 / 400.0 - 0.12 * std::sin(lean);
  const double edge_m =
      (line.alignment().WorldFromTrack(120.0) * Vector3(0.0, -beside_m, 0.76)).z();
  EXPECT_NEAR(StandingHeight_m(context, {120.0, -3.0, 0.0, feet}), edge_m, 1e-6);
  // On the other side of the track, on the ground.
  EXPECT_LT(StandingHeight_m(context, {120.0, 3.0, 0.0, feet}), edge_m - 1.0);
}

}  // namespace
}  // namespace railcast
