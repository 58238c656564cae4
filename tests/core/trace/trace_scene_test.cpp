#include "core/trace/trace_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "core/base/error.h"
#include "core/trace/trace_program.h"
#include "tests/support/analytic_meshes.h"

namespace railcast {
namespace {

constexpr float kWall_m = 20.0F;
constexpr float kTube_m = 0.2F;
constexpr float kRangeMax_m = 50.0F;

/// Part 0 is a wall, part 1 a vertical wire in front of it, part 2 a ball beside it that is not a
/// wire.
Model WallBehindAWire() {
  Mesh wire;
  wire.Append(MakeCylinder(static_cast<double>(kTube_m), 8.0, 16),
              MakeTransform(Eigen::Matrix3d::Identity(), {10.0, 0.0, 0.0}));
  Mesh ball;
  ball.Append(MakeSphere(1.0, 16, 16),
              MakeTransform(Eigen::Matrix3d::Identity(), {10.0, 3.0, 0.0}));
  return {"model",
          {{MakeWall(kWall_m, 9.0F), 1, 1},
           {.mesh = wire, .material = 1, .label = 2, .is_wire = true},
           {ball, 1, 3}}};
}

/// A fan of rays to the left and right of the forward direction.
RayTile MakeFan(std::uint32_t mask) {
  RayTile rays{};
  rays.num_rays = kTileSize;
  rays.mask = mask;
  for (std::size_t i = 0; i < kTileSize; ++i) {
    const float y = 0.8F * ((static_cast<float>(i) + 0.5F) / kTileSize - 0.5F);
    const float scale = 1.0F / std::sqrt(1.0F + y * y);
    rays.direction_x[i] = scale;
    rays.direction_y[i] = y * scale;
    rays.range_m[i] = kRangeMax_m;
  }
  return rays;
}

struct Scene {
  TraceDevice device;
  std::shared_ptr<const TraceModel> model = std::make_shared<TraceModel>(device, WallBehindAWire());
  TraceScene scene{device, {{model, {Eigen::Affine3d::Identity()}, 1}}};
};

TEST(TraceScene, RaysForAllButWiresSeeWhatIsBehindAWire) {
  const Scene scene;
  RayTile all = MakeFan(kAllSurfaces);
  RayTile no_wires = MakeFan(kAllButWires);
  scene.scene.Cast(all);
  scene.scene.Cast(no_wires);
  std::size_t num_on_wire = 0;
  for (std::size_t i = 0; i < kTileSize; ++i) {
    EXPECT_NE(no_wires.surface[i], 2U);
    if (all.surface[i] != 2) continue;
    ++num_on_wire;
    EXPECT_EQ(no_wires.surface[i], 1U);
    EXPECT_NEAR(no_wires.range_m[i], kWall_m / no_wires.direction_x[i], 1e-4F);
  }
  // The tube is 0.4 m wide at 10 m: 0.04 of the fan's 0.8, +-1 ray.
  EXPECT_NEAR(static_cast<double>(num_on_wire), 0.04 / 0.8 * kTileSize, 1.0);
}

TEST(TraceScene, TheMaskChangesNoBitWhereNoWireIsInTheWay) {
  const Scene scene;
  RayTile all = MakeFan(kAllSurfaces);
  RayTile no_wires = MakeFan(kAllButWires);
  scene.scene.Cast(all);
  scene.scene.Cast(no_wires);
  std::size_t num_on_ball = 0;
  for (std::size_t i = 0; i < kTileSize; ++i) {
    if (all.surface[i] == 2) continue;
    num_on_ball += all.surface[i] == 3 ? 1U : 0U;
    EXPECT_EQ(all.surface[i], no_wires.surface[i]);
    EXPECT_EQ(all.range_m[i], no_wires.range_m[i]);
  }
  EXPECT_GT(num_on_ball, 30U);
}

TEST(TraceScene, RangesAloneObeyTheMaskToo) {
  const Scene scene;
  RayTile full = MakeFan(kAllButWires);
  RayTile ranges = MakeFan(kAllButWires);
  scene.scene.Cast(full);
  scene.scene.CastRanges(ranges);
  EXPECT_TRUE(std::equal(full.range_m, full.range_m + kTileSize, ranges.range_m));
}

/// Random leaves of some 0.3 m between 5 and 15 m ahead.
Model Leaves(bool is_foliage) {
  std::mt19937 dice(7);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  const auto point = [&](float size_m) -> Eigen::Vector3f {
    return Eigen::Vector3f{unit(dice), unit(dice), unit(dice)} * size_m;
  };
  Mesh leaves;
  constexpr std::uint32_t kNumLeaves = 3000;
  for (std::uint32_t i = 0; i < kNumLeaves; ++i) {
    const Eigen::Vector3f middle = Eigen::Vector3f(10.0F, 0.0F, 0.0F) + point(5.0F);
    for (int k = 0; k < 3; ++k) leaves.vertices.push_back(middle + point(0.3F));
    leaves.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return {.name = "leaves", .parts = {{leaves, 1, 4}}, .is_foliage = is_foliage};
}

TEST(TraceScene, FoliageIsHitAsOtherModelsAre) {
  const TraceDevice device;
  const auto cast = [&](bool is_foliage) {
    const auto leaves = std::make_shared<TraceModel>(device, Leaves(is_foliage));
    const TraceScene scene(device, {{leaves, {Eigen::Affine3d::Identity()}, 1}});
    std::vector<float> ranges_m;
    for (int tilt = 0; tilt < 20; ++tilt) {
      RayTile rays = MakeFan(kAllSurfaces);
      for (std::size_t i = 0; i < kTileSize; ++i) {
        rays.direction_z[i] = 0.02F * static_cast<float>(tilt - 10);
        const float norm = std::sqrt(1.0F + rays.direction_z[i] * rays.direction_z[i]);
        for (float* axis : {rays.direction_x, rays.direction_y, rays.direction_z}) axis[i] /= norm;
      }
      scene.Cast(rays);
      ranges_m.insert(ranges_m.end(), rays.range_m, rays.range_m + kTileSize);
    }
    return ranges_m;
  };
  const std::vector<float> foliage_m = cast(true);
  const std::vector<float> other_m = cast(false);
  std::size_t num_hits = 0;
  std::size_t num_others = 0;
  for (std::size_t i = 0; i < foliage_m.size(); ++i) {
    num_hits += other_m[i] < kRangeMax_m ? 1U : 0U;
    num_others += std::abs(foliage_m[i] - other_m[i]) > 1e-4F ? 1U : 0U;
  }
  EXPECT_GT(num_hits, foliage_m.size() / 4);
  EXPECT_LE(num_others, 1U);  // A ray at the very edge of a leaf may pass it.
}

TEST(TraceProgram, IsTheOneThatIsAskedFor) {
  EXPECT_EQ(IsaInUse("sse4.2"), "sse4.2");
}

// Compares with the compiler's own detection of the processor's features.
TEST(TraceProgram, UsesTheBestOfTheMachine) {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl")) {
    EXPECT_EQ(IsaInUse(""), "avx512");
  } else if (__builtin_cpu_supports("avx2")) {
    EXPECT_EQ(IsaInUse(""), "avx2");
  } else {
    EXPECT_NE(IsaInUse(""), "");
  }
#else
  EXPECT_NE(IsaInUse(""), "");
#endif
}

TEST(TraceProgram, RefusesWhatTheMachineLacks) {
  try {
    (void)IsaInUse("avx1024");
    FAIL() << "no machine has it";
  } catch (const InputError& error) {
    const std::string line = error.what();
    EXPECT_TRUE(line.starts_with("isa: must be an instruction set of this machine, one of sse2, "))
        << line;
    EXPECT_TRUE(line.ends_with(" (got avx1024)")) << line;
  }
}

TEST(TraceProgram, HasAVersionOfThreeNumbers) {
  const std::string version = EmbreeVersion();
  EXPECT_TRUE(version.starts_with("3.") || version.starts_with("4.")) << version;
  EXPECT_EQ(std::count(version.begin(), version.end(), '.'), 2) << version;
}

}  // namespace
}  // namespace railcast
