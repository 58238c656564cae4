#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/scene/shapes.h"
#include "railcast/effects.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/frame_checks.h"
#include "tests/support/ray_cast.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"
#include "tests/support/triangle_search.h"

namespace railcast {
namespace {

// Foreign meshes may be wound inside out, or each triangle its own way, and sensors may end up
// inside of objects or on their surface. The habits of renderers fail there: they drop faces seen
// from behind, trust the sign of the normal, and start rays a little away from the sensor.

enum class Winding { kOutwards, kInwards, kMixed };

Mesh Wound(Mesh mesh, Winding winding) {
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const bool flips =
        winding == Winding::kInwards ||
        (winding == Winding::kMixed && RandomWords(1, RandomUse::kPlantShape, 0, i)[0] % 2 == 0);
    if (flips) std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  }
  return mesh;
}

/// A ground with a box and a sphere on it, in front of the sensor.
std::vector<Part> Things(Winding winding) {
  return {{Wound(MakeFloor(-2.0F, 200.0F), winding), 1, 1},
          {Wound(MakeBox({Vector3(14.0, 1.0, -2.0), Vector3(20.0, 6.0, 3.0)}), winding), 2, 2},
          {Wound(MakeSphere(1.7, 40, 80), winding), 3, 3}};
}

Frame ScanThings(Winding winding) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = Things(winding);
  world->chunk_from_vehicle.translation() = Vector3(-9.0, 0.0, 0.3);
  return ScanOnce(world, MakeRaster(60, 30, 0.25));
}

TEST(InsideOut, WindingChangesNeitherRangesNorLabelsNorIncidence) {
  const Frame outwards = ScanThings(Winding::kOutwards);
  ExpectSoundSlots(outwards, 0.5F, 300.0F);
  for (const Winding winding : {Winding::kInwards, Winding::kMixed}) {
    const Frame frame = ScanThings(winding);
    ExpectSoundSlots(frame, 0.5F, 300.0F);
    EXPECT_EQ(frame.outcome, outwards.outcome);
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      ASSERT_EQ(frame.label[slot], outwards.label[slot]);
      if (frame.label[slot] == 0) continue;
      // Another order of the corners rounds differently; a beam on an edge may take the
      // neighbouring facet, which on the sphere leans by 0.08 rad.
      ASSERT_NEAR(frame.range_m[slot], outwards.range_m[slot], 1e-4F);
      ASSERT_NEAR(frame.incidence_rad[slot], outwards.incidence_rad[slot],
                  frame.label[slot] == 3 ? 0.1F : 1e-5F);
    }
  }
}

TEST(InsideOut, ARendererLosesFacesOrTurnsTheCosineNegative) {
  const std::vector<Part> parts = Things(Winding::kMixed);
  const ScanPattern pattern = MakeRaster(60, 30, 1);
  const Frame truth = [&] {
    auto world = std::make_shared<SimpleWorld>();
    world->ground.parts = parts;
    world->chunk_from_vehicle.translation() = Vector3(-9.0, 0.0, 0.3);
    return ScanOnce(world, pattern);
  }();
  std::size_t num_hits = 0;
  std::size_t num_wrong = 0;
  std::size_t num_negative = 0;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t slot = pattern.row[i] * pattern.columns + pattern.column[i];
    if (truth.label[slot] == 0) continue;
    ++num_hits;
    const Eigen::Vector3f direction(pattern.direction_x[i], pattern.direction_y[i],
                                    pattern.direction_z[i]);
    const Eigen::Vector3f origin_m(-9.0F, 0.0F, 0.3F);
    const auto culled =
        SearchTriangles<float>(parts, Eigen::Isometry3f::Identity(), origin_m, direction, true);
    num_wrong += std::abs(culled.range_m - truth.range_m[slot]) > 0.1F ? 1 : 0;
    const auto hit =
        SearchTriangles<float>(parts, Eigen::Isometry3f::Identity(), origin_m, direction);
    num_negative += hit.normal.dot(-direction) < 0.0F ? 1 : 0;
  }
  const auto percent = [&](std::size_t count) {
    return 100.0 * static_cast<double>(count) / static_cast<double>(num_hits);
  };
  RecordRegime("meshes of mixed winding",
               {"back faces dropped: " + TwoDigits(percent(num_wrong)) +
                    " % of the hits wrong; signed normals: " + TwoDigits(percent(num_negative)) +
                    " % of the cosines negative",
                "as if all were wound alike"});
  EXPECT_GT(percent(num_wrong), 20.0);
  EXPECT_GT(percent(num_negative), 20.0);
}

TEST(InsideOut, ASensorInsideASphereSeesItsWallAllRound) {
  const auto world = WorldOfParts({{MakeSphere(5.0, 90, 180), 2, 2}});
  const Frame frame = ScanOnce(world, MakeRaster(360, 60, 1));
  ExpectSoundSlots(frame, 0.5F, 300.0F);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    ASSERT_EQ(frame.outcome[slot], Outcome::kReturned);
    // Facets of 2 degrees lie inside the sphere by at most 2 x 5 m x (1 - cos 1 deg) = 1.5 mm.
    ASSERT_NEAR(frame.range_m[slot], 5.0F, 0.002F);
    ASSERT_LE(frame.incidence_rad[slot], 0.04F);
  }
}

TEST(InsideOut, ASensorInsideAThingTooNearIsBlockedAllRound) {
  const auto world =
      WorldOfParts({{MakeSphere(0.3, 40, 80), 2, 2}, {MakeFloor(-2.0F, 100.0F), 1, 1}});
  const Frame frame = ScanOnce(world, MakeRaster(360, 60, 1));
  ExpectSoundSlots(frame, 0.5F, 300.0F);
  EXPECT_EQ(static_cast<std::size_t>(
                std::count(frame.outcome.begin(), frame.outcome.end(), Outcome::kNearRange)),
            frame.num_slots());
}

// The sensor's origin is on a plane, on an edge and on a corner of a box, and a micrometre or a
// millimetre off.
TEST(InsideOut, ASensorThatTouchesGeometryGivesNoFalsePoint) {
  const Mesh floor = MakeFloor(0.0F, 50.0F);
  const Mesh box = MakeBox({Vector3(0.0, 0.0, 0.0), Vector3(4.0, 4.0, 4.0)});
  for (const Mesh& mesh : {floor, box}) {
    for (const double off_m : {0.0, 1e-6, -1e-6, 1e-3, -1e-3}) {
      const auto world = WorldOfParts({{mesh, 2, 2}});
      world->chunk_from_vehicle.translation() = Vector3(off_m, off_m, off_m);
      // With 31 rows, the middle one lies in the plane itself.
      const Frame frame = ScanOnce(world, MakeRaster(360, 62, 2));
      ExpectSoundSlots(frame, 0.5F, 300.0F);
      for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
        const Outcome outcome = frame.outcome[slot];
        ASSERT_TRUE(outcome == Outcome::kNearRange || outcome == Outcome::kNoSurface ||
                    outcome == Outcome::kReturned);
        // A plane through the sensor, or just off it, is nearer than the minimum range or not met,
        // except for rows within a degree of it. The box has walls at 4 m and more, up to its far
        // corner.
        if (outcome == Outcome::kReturned) {
          ASSERT_GE(frame.range_m[slot], 0.5F);
          ASSERT_LE(frame.range_m[slot], 4.0F * std::sqrt(3.0F) + 0.01F);
        }
      }
    }
  }
}

// Rays start at range 0, and hits below the minimum range are rejected afterwards. The simple
// method, a start of 1 cm to avoid self-hits, looks through whatever is nearer.
TEST(InsideOut, AStartAwayFromTheSensorLooksThroughWhatBlocksIt) {
  const TraceDevice device;
  const auto scene = SceneOf(
      device, Model{"lens", {{MakeWall(0.005F, 1.0F), 1, 1}, {MakeWall(20.0F, 30.0F), 2, 2}}});
  const Eigen::Vector3f ahead = Eigen::Vector3f::UnitX();
  const std::vector<Ray> rays = {{Eigen::Vector3f::Zero(), ahead}, {0.01F * ahead, ahead}};
  const std::vector<RayHit> hits = CastRays(*scene, rays, 300.0F);
  EXPECT_FLOAT_EQ(hits[0].range_m, 0.005F);
  EXPECT_EQ(hits[0].surface, 1U);
  EXPECT_EQ(hits[1].surface, 2U);
  RecordRegime("something 5 mm before the sensor",
               {"rays that start 1 cm away see what is behind it", "blocked: `near_range`"});
}

// Snow lies on the upper side of things. The sign of a normal does not tell which side that is,
// since meshes are wound either way; the side that the sensor sees does. Without it, snow lies on
// ceilings, the undersides of bridges and canopies.

constexpr std::uint16_t kDarkPaint = 1;  // Reflectivity 0.1.
constexpr std::uint16_t kFreshSnow = 3;
constexpr std::uint32_t kFloorLabel = 4;
constexpr std::uint32_t kCeilingLabel = 5;

Mesh WoundEither(Mesh mesh, bool is_inwards) {
  for (auto& triangle : mesh.triangles) {
    if (is_inwards) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

Frame BetweenFloorAndCeiling(bool is_inwards, Fidelity rung, double snow_cover) {
  const auto world =
      WorldOfParts({{WoundEither(MakeFloor(-2.0F, 60.0F), is_inwards), kDarkPaint, kFloorLabel},
                    {WoundEither(MakeFloor(3.0F, 60.0F), is_inwards), kDarkPaint, kCeilingLabel}});
  SimulatorSpec spec{.detector = {.effects = EffectsOfRung(rung)}, .snow_material = kFreshSnow};
  spec.detector.weather.snow_cover = snow_cover;
  spec.detector.beam.reference_rays = 64;
  return ScanOnce(world, MakeRaster(10.0, 60.0, 1.0), spec);
}

TEST(Undersides, CarryNoSnow) {
  RecordRegime("lying snow and meshes wound either way",
               {"the sign of the normal: snow on ceilings and the undersides of bridges",
                "on upper sides alone"});
  for (const Fidelity rung : {Fidelity::kSurface, Fidelity::kFootprint, Fidelity::kReference}) {
    for (const bool is_inwards : {false, true}) {
      const Frame bare = BetweenFloorAndCeiling(is_inwards, rung, 0.0);
      const Frame snowy = BetweenFloorAndCeiling(is_inwards, rung, 1.0);
      int num_on_floor = 0;
      int num_on_ceiling = 0;
      for (std::size_t slot = 0; slot < bare.num_slots(); ++slot) {
        if (!HasPoint(bare.outcome[slot]) || !HasPoint(snowy.outcome[slot])) continue;
        if (bare.label[slot] == kFloorLabel) {
          EXPECT_GT(snowy.intensity[slot], 2.0F * bare.intensity[slot]);
          ++num_on_floor;
        } else {
          EXPECT_EQ(snowy.intensity[slot], bare.intensity[slot]);
          ++num_on_ceiling;
        }
      }
      EXPECT_GT(num_on_floor, 100) << NameOf(rung);
      EXPECT_GT(num_on_ceiling, 100) << NameOf(rung);
    }
  }
}

}  // namespace
}  // namespace railcast
