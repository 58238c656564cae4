#include "core/simulate/window.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "core/scene/shapes.h"
#include "core/simulate/frame_scene.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

constexpr double kChunkLength_m = 50.0;
constexpr double kRange_m = 100.0;  // Two chunks to either side of home.
constexpr int kNumChunks = 30;

/// A straight line of chunks. Each has ground, a post with a label of its own, and a tree that is
/// either shared by all chunks or, on request, its own. Counts the chunks it builds; one chunk may
/// fail to build.
class LineWorld final : public World {
 public:
  int chunks_per_s = 0;  ///< Speed of the vehicle.
  bool own_trees = false;
  bool has_wires = false;
  bool has_coarser_chunks = false;  ///< For rays that are 0.04 m apart at the chunk.
  std::atomic<int> broken_chunk = -1;
  std::atomic<int> delay_ms = 0;
  mutable std::atomic<int> num_built[kNumChunks] = {};
  mutable std::atomic<int> num_coarser[kNumChunks] = {};  ///< Not counted in `num_built`.
  mutable std::atomic<int> num_coarsest[kNumChunks] = {};
  mutable std::atomic<int> num_windows = 0;
  mutable std::weak_ptr<const Model> tree_of_chunk_0;

  [[nodiscard]] Transform WorldFromVehicle(std::int64_t) const override {
    return Transform::Identity();
  }
  [[nodiscard]] int HomeChunk(std::int64_t time_ns) const override {
    return static_cast<int>(chunks_per_s * time_ns / 1'000'000'000);
  }
  [[nodiscard]] std::vector<int> ChunksInReach(int home_chunk, double range_m) const override {
    ++num_windows;
    std::vector<int> chunks;
    for (int chunk = 0; chunk < kNumChunks; ++chunk) {
      if (std::abs(chunk - home_chunk) * kChunkLength_m <= range_m) chunks.push_back(chunk);
    }
    return chunks;
  }
  [[nodiscard]] Transform WorldFromChunk(int chunk) const override {
    return MakeTransform(Eigen::Matrix3d::Identity(), {kChunkLength_m * chunk, 0.0, 0.0});
  }
  [[nodiscard]] Chunk BuildChunk(int chunk) const override {
    ++num_built[chunk];
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
    if (chunk == broken_chunk) throw std::runtime_error("broken " + std::to_string(chunk));
    const auto label = static_cast<std::uint32_t>(100 + chunk);
    const float post_m = 0.5F + 0.1F * static_cast<float>(chunk);
    Chunk built{{"ground", {{MakeFloor(-2.0F, 25.0F), 1, 1}, {MakeWall(9.0F, post_m), 2, label}}},
                {}};
    if (has_wires) AddWire(chunk, built);
    const auto tree = own_trees ? MakeTree() : tree_;
    if (chunk == 0) tree_of_chunk_0 = tree;
    Eigen::Affine3d chunk_from_tree(Eigen::Translation3d(0.0, 5.0 + 0.3 * chunk, 0.0));
    built.placements.push_back({tree, chunk_from_tree, 0});
    return built;
  }
  [[nodiscard]] std::vector<Transform> VehiclePosesIn(int home_chunk) const override {
    std::vector<Transform> poses;
    for (double x_m = -0.5 * kChunkLength_m; x_m <= 0.5 * kChunkLength_m; x_m += 1.0) {
      poses.push_back(MakeTransform(Eigen::Matrix3d::Identity(),
                                    {kChunkLength_m * home_chunk + x_m, 0.0, 0.0}));
    }
    return poses;
  }
  [[nodiscard]] std::vector<CoarserSurfaces> CoarserSurfacesOf(int) const override {
    if (!has_coarser_chunks) return {};
    CoarserSurfaces coarser{.area_m = {Eigen::Vector2d(-0.5 * kChunkLength_m, -10.0),
                                       Eigen::Vector2d(0.5 * kChunkLength_m, 10.0)},
                            .ray_spacing_m = 0.04,
                            .beam_width_m = 0.0,
                            .sight_angle_rad = 0.5};
    CoarserSurfaces coarsest = coarser;
    coarsest.ray_spacing_m = 1.0;
    return {coarser, coarsest};
  }
  [[nodiscard]] Chunk BuildCoarserChunk(int chunk, std::size_t level) const override {
    ++(level == 1 ? num_coarser : num_coarsest)[chunk];
    return {{"coarser ground", {{MakeFloor(-2.0F, 25.0F), 1, 1}}}, {}};
  }
  [[nodiscard]] const std::vector<SceneObject>& objects() const override { return objects_; }
  [[nodiscard]] Transform WorldFromObject(std::size_t, std::int64_t) const override {
    return Transform::Identity();
  }

  void AddStandingObject(std::shared_ptr<const Model> model) {
    objects_.push_back({.name = "thing", .type = "mesh", .instance = 1, .model = std::move(model)});
  }

 private:
  /// Adds a bent wire, longer in each chunk, with its tube as part 3 of the ground. Part 2 has the
  /// same material and label but is not a wire.
  static void AddWire(int chunk, Chunk& built) {
    constexpr std::uint32_t kWireLabel = 50;
    const Wire wire{2, kWireLabel, 0.006, {{0, 1, 5}, {10, 2, 4.5}, {20.0 + chunk, 1, 5}}};
    built.ground.parts.push_back({MakeWall(20.0F, 0.1F), 2, kWireLabel});
    built.ground.parts.push_back({MakeTube(wire.points_m, 0.006, 4), 2, kWireLabel, true});
    built.wires.push_back(wire);
  }
  static std::shared_ptr<const Model> MakeTree() {
    return std::make_shared<const Model>(Model{"tree", {{MakeCylinder(1.0, 6.0, 8), 1, 2}}});
  }

  std::shared_ptr<const Model> tree_ = MakeTree();
  std::vector<SceneObject> objects_;
};

struct Line {
  std::shared_ptr<LineWorld> world = std::make_shared<LineWorld>();
  WindowSource windows{std::make_shared<SceneStore>(world, TestMaterials()), kRange_m};
};

/// What a fan of rays from the home chunk's origin hits: range, label, instance.
using View = std::vector<std::tuple<float, std::uint32_t, std::uint32_t>>;

View LookAround(const Window& window) {
  RayTile rays{};
  rays.num_rays = kTileSize;
  for (std::size_t i = 0; i < kTileSize; ++i) {
    const double azimuth_rad = 2.0 * std::numbers::pi * static_cast<double>(i) / kTileSize;
    rays.direction_x[i] = static_cast<float>(std::cos(azimuth_rad));
    rays.direction_y[i] = static_cast<float>(std::sin(azimuth_rad));
    rays.range_m[i] = static_cast<float>(kRange_m);
  }
  window.scene->Cast(rays);
  View view;
  for (std::size_t i = 0; i < kTileSize; ++i) {
    const Surface& surface = window.surfaces[rays.surface[i]];
    view.emplace_back(rays.range_m[i], surface.label, surface.instance);
  }
  return view;
}

std::size_t NumHits(const View& view) {
  return static_cast<std::size_t>(std::count_if(
      view.begin(), view.end(), [](const auto& seen) { return std::get<1>(seen) != 0; }));
}

std::vector<std::uint32_t> LabelsIn(const Window& window) {
  std::vector<std::uint32_t> labels;
  for (const Surface& surface : window.surfaces) labels.push_back(surface.label);
  return labels;
}

void WaitUntil(const std::function<bool()>& is_done) {
  while (!is_done()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(WindowSource, AWindowDoesNotDependOnThoseBeforeIt) {
  Line line;
  for (const int home : {0, 1, 2, 12, 11, 10, 9, 10, 25, 2, 2, 29, 0}) {
    const auto window = line.windows.Get(home);
    line.windows.Prepare((home + 1) % kNumChunks);
    const auto fresh = Line().windows.Get(home);
    EXPECT_EQ(LabelsIn(*window), LabelsIn(*fresh)) << home;
    EXPECT_EQ(LookAround(*window), LookAround(*fresh)) << home;
    EXPECT_GT(NumHits(LookAround(*window)), 10U) << home;
    EXPECT_TRUE(window->window_from_world.isApprox(line.world->WorldFromChunk(home).inverse()));
  }
}

TEST(WindowSource, DrivingForwardBuildsEachChunkAndEachWindowOnce) {
  Line line;
  for (int home = 0; home < 20; ++home) {
    for (int frame = 0; frame < 5; ++frame) {
      EXPECT_NE(line.windows.Get(home), nullptr);
      WaitUntil([&] {
        line.windows.Prepare(home + 1);  // Ignored until the thread is done with the previous one.
        return line.world->num_windows >= home + 2;
      });
    }
  }
  EXPECT_NE(line.windows.Get(20), nullptr);
  EXPECT_EQ(line.world->num_windows, 21);
  for (int chunk = 0; chunk <= 22; ++chunk) EXPECT_EQ(line.world->num_built[chunk], 1) << chunk;
}

TEST(WindowSource, WhatIsOutOfReachIsForgotten) {
  auto world = std::make_shared<LineWorld>();
  world->own_trees = true;
  WindowSource windows(std::make_shared<SceneStore>(world, TestMaterials()), kRange_m);
  std::weak_ptr<const Window> first = windows.Get(0);
  EXPECT_FALSE(world->tree_of_chunk_0.expired());
  EXPECT_FALSE(first.expired());
  EXPECT_NE(windows.Get(10), nullptr);
  EXPECT_TRUE(world->tree_of_chunk_0.expired());
  EXPECT_TRUE(first.expired());
  EXPECT_NE(windows.Get(0), nullptr);
  EXPECT_EQ(world->num_built[0], 2);
}

TEST(WindowSource, KeepsOnlyTheWindowInUseAndTheLastPrepared) {
  Line line;
  std::weak_ptr<const Window> in_use = line.windows.Get(0);
  for (const int ahead : {5, 10, 15}) {
    const int before = line.world->num_windows;
    WaitUntil([&] {
      line.windows.Prepare(ahead);  // Ignored while the previous one is being built.
      return line.world->num_windows > before;
    });
  }
  EXPECT_FALSE(in_use.expired());
  EXPECT_NE(line.windows.Get(15), nullptr);
  EXPECT_EQ(line.world->num_windows, 4);
  EXPECT_TRUE(in_use.expired());
  EXPECT_NE(line.windows.Get(10), nullptr);
  EXPECT_EQ(line.world->num_windows, 5);
}

TEST(WindowSource, AFailureReachesTheCallerAndTheNextCallTriesAgain) {
  Line line;
  line.world->broken_chunk = 6;
  for (int attempt = 0; attempt < 2; ++attempt) {
    try {
      EXPECT_EQ(line.windows.Get(5), nullptr);
      ADD_FAILURE() << "chunk 6 is broken";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "broken 6");
    }
  }
  EXPECT_NE(line.windows.Get(3), nullptr);
  line.world->broken_chunk = -1;
  EXPECT_EQ(LookAround(*line.windows.Get(5)), LookAround(*Line().windows.Get(5)));
}

TEST(WindowSource, AFailureInTheBackgroundReachesThoseAloneWhoWantThatWindow) {
  Line line;
  const View view = LookAround(*line.windows.Get(3));
  line.world->broken_chunk = 6;
  for (int frame = 0; frame < 5; ++frame) {
    line.windows.Prepare(4);
    WaitUntil([&] { return line.world->num_built[6] == 1; });
    EXPECT_EQ(LookAround(*line.windows.Get(3)), view);
  }
  EXPECT_THROW(static_cast<void>(line.windows.Get(4)), std::runtime_error);
  EXPECT_EQ(line.world->num_built[6], 1);
  line.world->broken_chunk = -1;
  EXPECT_EQ(LookAround(*line.windows.Get(4)), LookAround(*Line().windows.Get(4)));
}

TEST(WindowSource, MayBeAskedByManyThreadsAtOnce) {
  std::map<int, View> expected;
  for (const int home : {0, 1, 2, 3, 20}) expected[home] = LookAround(*Line().windows.Get(home));
  Line line;
  const auto ask = [&](int first) {
    for (int i = 0; i < 25; ++i) {
      const int home = (first + i) % 5 == 4 ? 20 : (first + i) % 5;
      line.windows.Prepare((first + 2 * i) % 4);
      EXPECT_EQ(LookAround(*line.windows.Get(home)), expected[home]);
    }
  };
  std::vector<std::thread> threads;
  for (int first = 0; first < 4; ++first) threads.emplace_back(ask, first);
  for (std::thread& thread : threads) thread.join();
}

TEST(WindowSource, AWindowOnItsWayIsWaitedForAndNotBuiltTwice) {
  Line line;
  line.world->delay_ms = 20;
  line.windows.Prepare(10);
  EXPECT_NE(line.windows.Get(10), nullptr);
  EXPECT_EQ(line.world->num_windows, 1);
}

TEST(WindowSource, MayBeDestroyedWhileAWindowIsOnItsWay) {
  Line line;
  line.world->delay_ms = 20;
  line.windows.Prepare(10);
}

TEST(WindowSource, IsNotAskedForWhatOnlyFramesAfterTheLastNeed) {
  const auto world = std::make_shared<LineWorld>();
  world->chunks_per_s = 1;
  FrameScenes scenes(std::make_shared<SceneStore>(world, TestMaterials()),
                     {.range_max_m = kRange_m});
  scenes.UseLastStamp(900'000'000);
  static_cast<void>(scenes.Begin(0, 0));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(world->num_windows, 1);
  scenes.UseLastStamp(1'000'000'000);
  static_cast<void>(scenes.Begin(1, 500'000'000));
  WaitUntil([&] { return world->num_windows == 2; });
  WaitUntil([&] { return world->num_built[3] == 1; });
}

// A mesh in coordinates of its own: its origin is far away, but its geometry is near.
TEST(WindowSource, AnObjectIsWhereItsGeometryIsAndNotItsOrigin) {
  auto world = std::make_shared<LineWorld>();
  world->AddStandingObject(std::make_shared<const Model>(
      Model{"thing", {{MakeWall(static_cast<float>(29 * kChunkLength_m) + 5.0F, 2.0F), 1, 7}}}));
  WindowSource windows(std::make_shared<SceneStore>(world, TestMaterials()), kRange_m);
  const auto [range_m, label, instance] = LookAround(*windows.Get(29)).front();
  EXPECT_NEAR(range_m, 5.0F, 1e-4F);  // Half a unit in the last place of 1455 m is 6e-5.
  EXPECT_EQ(label, 7U);
  EXPECT_EQ(instance, 1U);
}

TEST(WindowSource, MakesWindowsAnewOfTheChunksItHasWhereWhatStandsChanges) {
  const auto world = std::make_shared<LineWorld>();
  world->AddStandingObject(
      std::make_shared<const Model>(Model{"thing", {{MakeWall(3.0F, 1.0F), 1, 77}}}));
  WindowSource windows(std::make_shared<SceneStore>(world, TestMaterials()), kRange_m);
  const View with = LookAround(*windows.Get(0));
  windows.Prepare(1);
  windows.UseStanding({});
  const View without = LookAround(*windows.Get(0));
  EXPECT_NE(without, with);
  windows.UseStanding({0});
  EXPECT_EQ(LookAround(*windows.Get(0)), with);
  static_cast<void>(windows.Get(1));
  static_cast<void>(windows.Get(2));
  for (int chunk = 0; chunk <= 4; ++chunk) EXPECT_EQ(world->num_built[chunk], 1) << chunk;
}

// The vehicle is within 25 m of its chunk's middle: the next chunk but one is 50 m away.
TEST(WindowSource, TakesTheCoarserFormOfChunksFarFromTheHomeChunk) {
  const auto world = std::make_shared<LineWorld>();
  world->has_coarser_chunks = true;
  WindowSource windows(
      std::make_shared<SceneStore>(world, TestMaterials()), kRange_m,
      {.vehicle_from_sensor = Transform::Identity(), .ray_spacing_rad = 0.04 / 49.0});
  static_cast<void>(windows.Get(10));
  const auto built = [&](int chunk) {
    return std::pair(world->num_built[chunk].load(), world->num_coarser[chunk].load());
  };
  for (const int chunk : {9, 10, 11}) EXPECT_EQ(built(chunk), std::pair(1, 0)) << chunk;
  for (const int chunk : {8, 12}) EXPECT_EQ(built(chunk), std::pair(0, 1)) << chunk;
  static_cast<void>(windows.Get(11));
  for (const int chunk : {10, 11}) EXPECT_EQ(built(chunk), std::pair(1, 0)) << chunk;
  for (const int chunk : {9, 12}) EXPECT_EQ(built(chunk), std::pair(1, 1)) << chunk;
  EXPECT_EQ(built(13), std::pair(0, 1));
}

TEST(WindowSource, TakesTheCoarsestFormOfChunksThatNoFiringMeets) {
  const auto world = std::make_shared<LineWorld>();
  world->has_coarser_chunks = true;
  DetailRule ahead{.vehicle_from_sensor = Transform::Identity(), .ray_spacing_rad = 0.04 / 49.0};
  ahead.sector = {.middle_rad = 0.0, .half_width_rad = RadFromDeg(30.0)};
  WindowSource windows(std::make_shared<SceneStore>(world, TestMaterials()), kRange_m, ahead);
  static_cast<void>(windows.Get(10));
  const auto built = [&](int chunk) {
    return std::array{world->num_built[chunk].load(), world->num_coarser[chunk].load(),
                      world->num_coarsest[chunk].load()};
  };
  const std::array in_full{1, 0, 0};
  const std::array coarser{0, 1, 0};
  const std::array coarsest{0, 0, 1};
  EXPECT_EQ(built(8), coarsest);
  // The sensor at the beginning of its chunk is above the end of this one.
  EXPECT_EQ(built(9), coarsest);
  EXPECT_EQ(built(10), in_full);
  EXPECT_EQ(built(11), in_full);
  EXPECT_EQ(built(12), coarser);
}

TEST(SceneStore, BuildsChunksOnceForSensorsOfDifferentReach) {
  const auto world = std::make_shared<LineWorld>();
  const auto store = std::make_shared<SceneStore>(world, TestMaterials());
  WindowSource far(store, kRange_m);
  WindowSource near(store, kChunkLength_m);
  const auto far_window = far.Get(10);
  const auto near_window = near.Get(10);
  for (int chunk = 8; chunk <= 12; ++chunk) EXPECT_EQ(world->num_built[chunk], 1) << chunk;
  WindowSource alone(std::make_shared<SceneStore>(world, TestMaterials()), kChunkLength_m);
  EXPECT_EQ(LookAround(*near_window), LookAround(*alone.Get(10)));
  EXPECT_EQ(LabelsIn(*near_window), LabelsIn(*alone.Get(10)));
  EXPECT_NE(LabelsIn(*near_window), LabelsIn(*far_window));
}

TEST(WindowSource, AWindowListsTheWiresOfItsChunksWhereTheirTubesAre) {
  Line line;
  line.world->has_wires = true;
  const auto window = line.windows.Get(10);
  ASSERT_EQ(window->wires.segments.size(), 2U * 5U);  // Chunks 8 to 12.
  for (int i = 0; i < 5; ++i) {
    const int chunk = 8 + i;
    const double x_m = kChunkLength_m * (chunk - 10);
    const std::size_t at = 2 * static_cast<std::size_t>(i);
    const WireSegment& first = window->wires.segments[at];
    const WireSegment& second = window->wires.segments[at + 1];
    EXPECT_TRUE(first.begin_m.isApprox(Vector3(x_m, 1.0, 5.0).cast<float>()));
    EXPECT_TRUE(first.end_m.isApprox(Vector3(x_m + 10.0, 2.0, 4.5).cast<float>()));
    EXPECT_EQ(second.begin_m, first.end_m);
    EXPECT_TRUE(second.end_m.isApprox(Vector3(x_m + 20.0 + chunk, 1.0, 5.0).cast<float>()));
    EXPECT_EQ(first.radius_m, 0.006F);
    EXPECT_EQ(second.surface, first.surface);
    // The surface is that of the tube, not of the preceding part with the same material and label.
    EXPECT_EQ(window->surfaces[first.surface].label, 50U);
    EXPECT_EQ(window->surfaces[first.surface].material, 2U);
    EXPECT_EQ(window->surfaces[first.surface - 1].label, 50U);
    EXPECT_EQ(window->surfaces[first.surface - 2].label, static_cast<std::uint32_t>(100 + chunk));
  }
}

// With more threads, chunks are built at once.
std::shared_ptr<const Window> GetOnOneThread(WindowSource& windows, int home_chunk) {
  tbb::task_arena one_thread(1);
  return one_thread.execute([&] { return windows.Get(home_chunk); });
}

TEST(WindowSource, SaysHowFarAWindowIs) {
  Line line;
  std::vector<std::pair<std::size_t, std::size_t>> said;
  line.windows.UseProgress(
      [&](std::size_t num_done, std::size_t num_steps) { said.emplace_back(num_done, num_steps); });
  static_cast<void>(GetOnOneThread(line.windows, 0));
  // The home chunk, two chunks ahead, and the scene.
  EXPECT_EQ(said, (std::vector<std::pair<std::size_t, std::size_t>>{
                      {0, 4}, {1, 4}, {2, 4}, {3, 4}, {4, 4}}));
  static_cast<void>(GetOnOneThread(line.windows, 0));
  EXPECT_EQ(said.size(), 5U) << "it is there";
}

TEST(WindowSource, IsStoppedBetweenTwoChunks) {
  Line line;
  line.windows.UseProgress([](std::size_t num_done, std::size_t) {
    if (num_done == 1) throw std::runtime_error("stopped");
  });
  EXPECT_THROW(static_cast<void>(GetOnOneThread(line.windows, 0)), std::runtime_error);
  EXPECT_EQ(line.world->num_built[0], 1);
  EXPECT_EQ(line.world->num_built[1], 0);
  // An exception while building ahead also reaches the caller that waits for the window.
  line.windows.Prepare(9);
  EXPECT_THROW(static_cast<void>(line.windows.Get(9)), std::runtime_error);
  line.windows.UseProgress([](std::size_t, std::size_t) {});
  EXPECT_GT(NumHits(LookAround(*line.windows.Get(0))), 0U);
}

TEST(WindowSource, BuildsTheChunksThatAFrameWaitsForAtOnce) {
  Line line;
  line.world->delay_ms = 40;
  std::atomic<int> num_building = 0;
  std::atomic<int> most = 0;
  line.windows.UseProgress([&](std::size_t num_done, std::size_t) {
    // Of the chunks that are begun, so many are not done.
    const int now = ++num_building - static_cast<int>(num_done);
    if (now > most) most = now;
  });
  // On a machine with fewer cores TBB would start fewer, and say so.
  const tbb::global_control as_many(tbb::global_control::max_allowed_parallelism, 3);
  tbb::task_arena three_threads(3);
  const auto window = three_threads.execute([&] { return line.windows.Get(3); });
  EXPECT_GT(most, 1);
  // The same window as one that a single thread built.
  Line other;
  EXPECT_EQ(LookAround(*window), LookAround(*GetOnOneThread(other.windows, 3)));
}

TEST(WindowSource, EndsWithoutFinishingWhatNobodyWaitsFor) {
  auto line = std::make_unique<Line>();
  const auto world = line->world;
  world->delay_ms = 20;
  line->windows.Prepare(9);
  WaitUntil([&] { return world->num_windows == 1; });
  line.reset();
  int num_built = 0;
  for (const std::atomic<int>& built : world->num_built) num_built += built;
  EXPECT_LT(num_built, 5) << "of five chunks in reach";
}

}  // namespace
}  // namespace railcast
