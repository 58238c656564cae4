// Trees and wires in the wind, as frames see them.
#include "core/simulate/swaying.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/base/units.h"
#include "core/detect/base/wind_velocity.h"
#include "core/scene/shapes.h"
#include "core/simulate/frame_scene.h"
#include "core/simulate/wind.h"
#include "railcast/scenario.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/frame_bytes.h"
#include "tests/support/ray_cast.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr std::uint32_t kTreeLabel = 21;
constexpr std::uint32_t kWireLabel = 22;
constexpr double kTreeHeight_m = 10.0;
constexpr double kWallDistance_m = 20.0;

/// A "tree" like a wall, 20 m ahead of the sensor, which leans about its foot at height 0.
std::shared_ptr<SimpleWorld> WorldWithLeaningWall() {
  auto world = std::make_shared<SimpleWorld>();
  const auto tree =
      std::make_shared<Model>(Model{"tree", {{MakeWall(0.0F, 200.0F), 2, kTreeLabel}}});
  const Eigen::Affine3d chunk_from_tree(Eigen::Translation3d(kWallDistance_m, 0.0, 0.0));
  world->placements.push_back({tree, chunk_from_tree, 7, kTreeHeight_m});
  return world;
}

/// A span of 60 m across the view, 15 m ahead and 5 m up, with a dropper at mid-span.
std::shared_ptr<SimpleWorld> WorldWithSpan() {
  auto world = std::make_shared<SimpleWorld>();
  const WireSpan span{.number = 3,
                      .begin_m = {15.0, -30.0, 5.0},
                      .end_m = {15.0, 30.0, 5.0},
                      .tension_n = 20e3,
                      .mass_kg_per_m = 1.33,
                      .width_m = 0.021};
  const auto add = [&](double radius_m, const std::vector<Vector3>& points_m) {
    world->wires.push_back({1, kWireLabel, radius_m, points_m, span});
  };
  std::vector<Vector3> wire_m;
  for (int i = 0; i <= 12; ++i) wire_m.emplace_back(15.0, -30.0 + 5.0 * i, 5.0);
  add(0.006, wire_m);
  add(0.003, {{15.0, 0.0, 5.0}, {15.0, 0.0, 6.2}});
  Part tubes{{}, 1, kWireLabel, true};
  for (const Wire& wire : world->wires) {
    tubes.mesh.Append(MakeTube(wire.points_m, wire.radius_m, 16));
  }
  world->ground.parts = {{MakeFloor(-2.0F, 500.0F), 3, 1}, tubes};
  return world;
}

SimulatorSpec InWind(double speed_mps, double from_deg, std::uint64_t air_seed = 5) {
  SimulatorSpec spec;
  spec.detector.air_seed = air_seed;
  spec.detector.weather.wind_speed_mps = speed_mps;
  spec.detector.weather.wind_direction_deg = from_deg;
  return spec;
}

Wind WindOf(const SimulatorSpec& spec) {
  return Wind(WindVelocity_mps(spec.detector.weather), spec.detector.air_seed);
}

bool HaveSameBytes(const Frame& a, const Frame& b) {
  return FrameBytes(a) == FrameBytes(b);
}

// Every firing sees the wall where TreeTip_m() has it at the firing's own time.
TEST(Swaying, ATreeLeansAboutItsFootByItsTipsDisplacement) {
  const SimulatorSpec spec = InWind(20.0, 170.0);
  const Wind wind = WindOf(spec);
  const ScanPattern pattern = MakeRaster(60, 20, 2);
  // The tree is the first placement of chunk 0.
  const TreeInWind tree{{kWallDistance_m, 0.0, 0.0}, kTreeHeight_m, 0, 1};
  // Linear interpolation over 0.1 s is off by (2 pi f T)^2 / 8 = 5 % of the amplitude of ringing,
  // which is at most sqrt(6) R 4/3 I = 0.4 of the mean of 0.38 m at 10 m: 0.8 mm per m of height.
  constexpr double kPerMetre = 8e-4;
  double most_m = 0.0;
  for (const std::uint32_t index : {0U, 7U}) {
    const Frame frame = ScanOnce(WorldWithLeaningWall(), pattern, spec, index);
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      const double time_s = 0.1 * index + static_cast<double>(frame.time_ns[slot]) * 1e-9;
      const Vector3 tip_m = TreeTip_m(wind, tree, time_s);
      const Vector3 axis = Vector3::UnitZ().cross(tip_m).normalized();
      const Vector3 normal =
          Eigen::AngleAxisd(tip_m.norm() / kTreeHeight_m, axis) * Vector3::UnitX();
      // n . (x - foot) = 0 at the point that was hit.
      const Vector3 hit_m = PointAt(frame, slot);
      ASSERT_EQ(frame.label[slot], kTreeLabel);
      ASSERT_EQ(frame.instance[slot], 7U);
      const double off_m = normal.dot(hit_m - Vector3(kWallDistance_m, 0.0, 0.0));
      const double from_foot_m = std::hypot(hit_m.y(), hit_m.z());
      EXPECT_NEAR(off_m, 0.0, kPerMetre * from_foot_m + 1e-4);
      most_m = std::max(most_m, std::abs(hit_m.x() - kWallDistance_m));
      // The foot stays.
      if (from_foot_m < 0.5) {
        EXPECT_NEAR(hit_m.x(), kWallDistance_m, 0.05);
      }
      EXPECT_NEAR(static_cast<double>(frame.incidence_rad[slot]),
                  std::acos(std::abs(normal.dot(hit_m.normalized()))), 5e-3);
    }
  }
  EXPECT_GT(most_m, 0.1);
}

TEST(Swaying, FiringsSeeTheSwayWithinTheFrame) {
  const SimulatorSpec spec = InWind(20.0, 180.0);
  const Frame frame = ScanOnce(WorldWithLeaningWall(), MakeRaster(60, 20, 1), spec, 3);
  // The uppermost row looks at 9.5 degrees: 3.3 m up and more towards the sides.
  const Wind wind = WindOf(spec);
  const TreeInWind tree{{kWallDistance_m, 0.0, 0.0}, kTreeHeight_m, 0, 1};
  const double begin_m = TreeTip_m(wind, tree, 0.3).x();
  const double end_m = TreeTip_m(wind, tree, 0.3 + SecondsFromNs(frame.duration_ns)).x();
  ASSERT_GT(std::abs(end_m - begin_m), 5e-3);
  const auto lean_at = [&](std::size_t column) {
    const std::size_t slot = (frame.num_slots() / 60 - 1) * 60 + column;
    return (static_cast<double>(frame.x[slot]) - kWallDistance_m) /
           static_cast<double>(frame.z[slot]) * kTreeHeight_m;
  };
  // Across the wind, the wall leans in its own plane, but for second order: lean^2 of 10 m.
  EXPECT_NEAR(lean_at(59) - lean_at(0), end_m - begin_m, 0.25 * std::abs(end_m - begin_m));
}

/// What sways of a world's only window.
struct SwayedWindow {
  explicit SwayedWindow(const std::shared_ptr<SimpleWorld>& world)
      : store(std::make_shared<SceneStore>(world, TestMaterials())), windows(store, 300.0) {
    windows.UseWind(true);
    window = windows.Get(0);
  }
  [[nodiscard]] SwayedThings At(const Wind& wind,
                                double stamp_s,
                                double duration_s = 0.1,
                                std::optional<std::uint32_t> first_own_surface = {}) const {
    return Sway(window->swaying, wind,
                {.stamp_s = stamp_s,
                 .duration_s = duration_s,
                 .window_from_world = window->window_from_world,
                 .reach_m = 300.0,
                 .first_own_surface = first_own_surface});
  }

  std::shared_ptr<SceneStore> store;
  WindowSource windows;
  std::shared_ptr<const Window> window;
};

TEST(Swaying, WiresAreBlownOffByTheirParabolaAndSupportsStay) {
  const SwayedWindow swayed(WorldWithSpan());
  const Wind wind = WindOf(InWind(15.0, 180.0));
  const SwayedThings now = swayed.At(wind, 12.3);
  const WireSpan& span = swayed.window->swaying.spans.front();
  // The way from begin to end is +y, whose left is -x; the wind blows towards +x.
  const double middle_m = -SpanBlowOff_m(wind, span, 12.3);
  const double later_m = -SpanBlowOff_m(wind, span, 12.4);
  EXPECT_GT(middle_m, 0.03);
  ASSERT_EQ(now.wires.segments.size(), 13U);
  for (std::size_t i = 0; i < 12; ++i) {
    const WireSegment& wire = now.wires.segments[i];
    const double x_m = 5.0 * static_cast<double>(i);
    const double share = 4.0 * x_m * (60.0 - x_m) / 3600.0;
    EXPECT_NEAR(static_cast<double>(wire.begin_m.x()), 15.0 + share * middle_m, 2e-6);
    EXPECT_NEAR(static_cast<double>(SegmentAt(wire, 1.0F).begin_m.x()), 15.0 + share * later_m,
                2e-6);
    EXPECT_FLOAT_EQ(wire.begin_m.y(), static_cast<float>(-30.0 + x_m));
  }
  EXPECT_EQ(now.wires.segments[0].begin_m.x(), 15.0F);
  EXPECT_EQ(now.wires.segments[11].end_m.x(), 15.0F);
  // The dropper follows with both ends and stays upright.
  const WireSegment& dropper = now.wires.segments[12];
  EXPECT_NEAR(static_cast<double>(dropper.begin_m.x()), 15.0 + middle_m, 2e-6);
  EXPECT_EQ(dropper.end_m.x(), dropper.begin_m.x());
}

TEST(Swaying, WiresHaveTheVelocityOfTheirBlowOffWhereItIsAskedFor) {
  const SwayedWindow swayed(WorldWithSpan());
  const Wind wind = WindOf(InWind(15.0, 180.0));
  const SwayedThings now = swayed.At(wind, 12.3, 0.1, 1000U);
  const SwayedThings shared = swayed.At(wind, 12.3);
  EXPECT_TRUE(shared.own_surfaces.empty());
  const WireSpan& span = swayed.window->swaying.spans.front();
  // Both wires are of one part and one span.
  ASSERT_EQ(now.own_surfaces.size(), 1U);
  EXPECT_EQ(now.own_surfaces[0], shared.wires.segments[0].surface);
  for (const WireSegment& wire : now.wires.segments) {
    ASSERT_EQ(wire.surface, 1000U);
    for (const float shutter : {0.0F, 1.0F}) {
      const double time_s = 12.3 + 0.1 * static_cast<double>(shutter);
      const double rate_mps =
          (SpanBlowOff_m(wind, span, time_s + 1e-4) - SpanBlowOff_m(wind, span, time_s - 1e-4)) /
          2e-4;
      const Vector3 place_m = SegmentAt(wire, shutter).begin_m.cast<double>();
      const double share = 4.0 * (place_m.y() + 30.0) * (30.0 - place_m.y()) / 3600.0;
      // Its left is -x.
      EXPECT_LT((now.motions.VelocityOf_mps(wire.surface, static_cast<double>(shutter), place_m) -
                 Vector3(-share * rate_mps, 0.0, 0.0))
                    .norm(),
                1e-4 * std::abs(rate_mps) + 1e-9);
    }
  }
}

TEST(Swaying, AWireThatIsPartOfNoSpanHangsStillBesideOthers) {
  auto world = WorldWithSpan();
  for (Wire& wire : world->wires) wire.span.number = 0;
  world->wires.insert(world->wires.begin(), {1, kWireLabel, 0.006, {{9, 0, 5}, {9, 4, 5}}});
  const SwayedThings now = SwayedWindow(world).At(WindOf(InWind(15.0, 180.0)), 12.3);
  EXPECT_EQ(now.wires.segments[0].travel_m, 0.0F);
  EXPECT_EQ(now.wires.segments[0].end_m, Eigen::Vector3f(9.0F, 4.0F, 5.0F));
  EXPECT_GT(now.wires.segments[1 + 6].begin_m.x(), 15.03F);
}

// Rays at the middles and the edges of the swayed segments meet the tubes, and just beside them
// they do not: tubes and segments agree within a hundredth of the radius.
TEST(Swaying, TubesAndSegmentsOfWiresMoveTogether) {
  const SwayedWindow swayed(WorldWithSpan());
  const SwayedThings now = swayed.At(WindOf(InWind(25.0, 160.0)), 47.0);
  const TraceScene tubes(swayed.store->device(), now.placements);
  for (const float shutter : {0.0F, 0.37F, 1.0F}) {
    for (const WireSegment& moving : now.wires.segments) {
      const WireSegment wire = SegmentAt(moving, shutter);
      const Eigen::Vector3f along = (wire.end_m - wire.begin_m).normalized();
      const Eigen::Vector3f middle_m = 0.5F * (wire.begin_m + wire.end_m);
      const Eigen::Vector3f ahead = along.unitOrthogonal();
      const Eigen::Vector3f side = along.cross(ahead);
      RayTile rays{};
      rays.num_rays = kPacketSize;
      const auto aim = [&](std::size_t i, float offset) {
        const Eigen::Vector3f origin_m = middle_m - 2.0F * ahead + offset * wire.radius_m * side;
        SetRay(rays, i, {origin_m, ahead}, 100.0F);
        rays.shutter[i] = shutter;
      };
      for (std::size_t i = 0; i < kPacketSize; ++i) aim(i, 0.0F);
      // Corners are 1 % outside the true surface, the middles of faces 1 % inside.
      aim(1, 0.97F);
      aim(2, -0.97F);
      aim(3, 1.03F);
      aim(4, -1.03F);
      tubes.Cast(rays);
      for (std::size_t i : {0U, 1U, 2U}) EXPECT_EQ(rays.surface[i], wire.surface);
      for (std::size_t i : {3U, 4U}) EXPECT_EQ(rays.surface[i], 0U);
      EXPECT_NEAR(rays.range_m[0], 2.0F - wire.radius_m, 0.02F * wire.radius_m + 1e-5F);
      const Surface& surface = swayed.window->surfaces[wire.surface];
      EXPECT_EQ(surface.label, kWireLabel);
      EXPECT_EQ(surface.material, 1);
      const Eigen::Vector3f normal(rays.normal_x[0], rays.normal_y[0], rays.normal_z[0]);
      EXPECT_GT(std::abs(normal.normalized().dot(ahead)), 0.97F);  // Within half a face.
    }
  }
}

TEST(Swaying, OnlyTheSwayingWiresAreInTheScene) {
  const SwayedWindow swayed(WorldWithSpan());
  EXPECT_TRUE(swayed.window->wires.segments.empty());
  RayTile rays{};
  rays.num_rays = kPacketSize;
  for (std::size_t i = 0; i < kPacketSize; ++i) {  // At the wire's place at rest.
    rays.direction_x[i] = 15.0F;
    rays.direction_z[i] = 5.0F;
    rays.range_m[i] = 10.0F;
  }
  swayed.window->scene->Cast(rays);
  EXPECT_EQ(rays.surface[0], 0U);
}

TEST(Swaying, AFrameIsTheSameAloneAndAfterOthersAtAnyNumberOfThreads) {
  const SimulatorSpec spec = InWind(14.0, 30.0);
  auto world = WorldWithSpan();
  world->placements = WorldWithLeaningWall()->placements;
  const ScanPattern pattern = MakeRaster(60, 40, 0.5);
  Simulator simulator(world, pattern, TestMaterials(), spec, 3);
  Frame frame;
  for (std::uint32_t index = 0; index <= 4; ++index) simulator.Scan(index, frame);
  EXPECT_TRUE(HaveSameBytes(frame, ScanOnce(world, pattern, spec, 4, 1)));
  EXPECT_FALSE(HaveSameBytes(frame, ScanOnce(world, pattern, spec, 5, 1)));
}

TEST(Swaying, AllSensorsSeeTheSameSway) {
  const ScanPattern pattern = MakeRaster(60, 20, 1);
  SimulatorSpec front = InWind(14.0, 30.0);
  front.detector.seed = 11;
  SimulatorSpec roof = front;
  roof.detector.seed = 99;
  const auto world = WorldWithLeaningWall();
  const Frame a = ScanOnce(world, pattern, front, 6);
  EXPECT_TRUE(HaveSameBytes(a, ScanOnce(world, pattern, roof, 6)));
  roof.detector.air_seed = 6;
  EXPECT_FALSE(HaveSameBytes(a, ScanOnce(world, pattern, roof, 6)));
}

TEST(Swaying, WithoutWindNothingSwaysWhateverItsDirection) {
  const ScanPattern pattern = MakeRaster(60, 20, 1);
  const auto world = WorldWithLeaningWall();
  const Frame still = ScanOnce(world, pattern, {}, 3);
  EXPECT_TRUE(HaveSameBytes(still, ScanOnce(world, pattern, InWind(0.0, 77.0), 3)));
  EXPECT_FALSE(HaveSameBytes(still, ScanOnce(world, pattern, InWind(5.0, 77.0), 3)));
  for (std::size_t slot = 0; slot < still.num_slots(); ++slot) {
    EXPECT_NEAR(static_cast<double>(still.x[slot]), kWallDistance_m, 1e-4);
  }
}

TEST(Swaying, AChangeOfTheWindTakesEffect) {
  const ScanPattern pattern = MakeRaster(60, 20, 1);
  auto world = WorldWithSpan();
  world->placements = WorldWithLeaningWall()->placements;
  const Frame still = ScanOnce(world, pattern, {}, 3);
  const Frame swayed = ScanOnce(world, pattern, InWind(12.0, 10.0), 3);
  Simulator simulator(world, pattern, TestMaterials(), {}, 1);
  Frame frame = FrameBy(simulator, 3);
  SimulatorSpec spec = simulator.spec();
  spec.detector.weather.wind_speed_mps = 12.0;
  spec.detector.weather.wind_direction_deg = 10.0;
  spec.detector.air_seed = 5;
  simulator.Use(spec);
  simulator.Scan(3, frame);
  EXPECT_TRUE(HaveSameBytes(frame, swayed));
  spec.detector.weather.wind_speed_mps = 0.0;
  simulator.Use(spec);
  simulator.Scan(3, frame);
  EXPECT_TRUE(HaveSameBytes(frame, still));
}

// The wind drives the patches of fog, too. At time 0 nothing has drifted yet.
TEST(Swaying, FogDriftsWithTheWind) {
  SimulatorSpec spec = InWind(10.0, 120.0);
  spec.detector.effects = {
      .surface_response = true, .extinction = true, .detection = true, .fog_echo = true};
  spec.detector.weather.visibility_m = 25.0;
  spec.detector.weather.fog_variation = 0.8;
  SimulatorSpec calm = spec;
  calm.detector.weather.wind_speed_mps = 0.0;
  const auto world = WorldOfParts({{MakeWall(60.0F, 500.0F), 2, 1}});
  const ScanPattern pattern = MakeRaster(60, 20, 1);
  EXPECT_TRUE(HaveSameBytes(ScanOnce(world, pattern, spec, 0), ScanOnce(world, pattern, calm, 0)));
  EXPECT_FALSE(HaveSameBytes(ScanOnce(world, pattern, spec, 9), ScanOnce(world, pattern, calm, 9)));
}

// The vehicle passes from one chunk to the next: what it sees sway does not jump. The windows are
// those of a real line, whose frames have different headings.
TEST(Swaying, AChangeOfTheWindowMovesNothing) {
  const ScenarioSpec scenario =
      ReadScenario(std::string(RAILCAST_SOURCE_DIR "/scenarios/st_gallen_approach.json"));
  const auto world = MakeSimulator(scenario, 1)->shared_world();
  const auto store = std::make_shared<SceneStore>(world, MaterialLibrary(scenario.materials));
  const Wind wind({6.0, -10.0, 0.0}, 1);
  using Key = std::pair<std::uint32_t, std::uint32_t>;
  std::map<Key, Vector3> tips_m[2];
  std::vector<Vector3> wires_m[2];
  for (const int i : {0, 1}) {
    WindowSource windows(store, 30.0);
    windows.UseWind(true);
    const auto window = windows.Get(45 + i);
    const Transform world_from_window = window->window_from_world.inverse();
    const SwayedThings swayed = Sway(window->swaying, wind,
                                     {.stamp_s = 8.1,
                                      .duration_s = 0.1,
                                      .window_from_world = window->window_from_world,
                                      .reach_m = 1e4});
    for (std::size_t t = 0; t < window->swaying.trees.size(); ++t) {
      const TreeInWind& tree = window->swaying.trees[t].in_wind;
      const Vector3 top_m = swayed.placements[t].window_from_model[1] * Vector3(0.0, 0.0, 6.0);
      tips_m[i][{tree.chunk, tree.number}] = world_from_window * top_m;
    }
    for (const WireSegment& wire : swayed.wires.segments) {
      wires_m[i].emplace_back(world_from_window * SegmentAt(wire, 1.0F).begin_m.cast<double>());
    }
  }
  std::size_t num_trees = 0;
  for (const auto& [key, tip_m] : tips_m[0]) {
    const auto same = tips_m[1].find(key);
    if (same == tips_m[1].end()) continue;
    EXPECT_LT((same->second - tip_m).norm(), 1e-6);
    ++num_trees;
  }
  EXPECT_GT(num_trees, 20U);
  std::size_t num_same = 0;
  for (const Vector3& point_m : wires_m[0]) {
    // float32 in a window of 100 m.
    num_same += std::any_of(wires_m[1].begin(), wires_m[1].end(), [&](const Vector3& other_m) {
      return (other_m - point_m).norm() < 3e-5;
    });
  }
  EXPECT_GT(num_same, 100U);
  // All but those of the one chunk, of three or four, that only the first window has.
  EXPECT_GT(static_cast<double>(num_same), 0.6 * static_cast<double>(wires_m[0].size()));
}

}  // namespace
}  // namespace railcast
