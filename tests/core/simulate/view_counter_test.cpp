#include "core/simulate/view_counter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/random.h"
#include "core/simulate/beam_tracer.h"
#include "core/simulate/frame_scene.h"
#include "core/simulate/scene_store.h"
#include "railcast/simulator.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/same_frames.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

/// An object of many loose triangles, so that rays pass edges closely and meet it several times.
std::shared_ptr<const Model> Thicket(std::uint32_t number) {
  Mesh mesh;
  const auto corner = [&](std::uint32_t i, std::uint32_t k) {
    const auto place = RandomWords(number, RandomUse::kTreePlacement, k, i);
    return Eigen::Vector3f(UnitFloat(place[0]), UnitFloat(place[1]), UnitFloat(place[2]));
  };
  for (std::uint32_t i = 0; i < 60; ++i) {
    const Eigen::Vector3f middle = 4.0F * corner(i, 0) - Eigen::Vector3f::Constant(2.0F);
    for (std::uint32_t k = 1; k <= 3; ++k) mesh.vertices.emplace_back(middle + corner(i, k));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return std::make_shared<const Model>(Model{"thicket", {{mesh, 3, 3}}});
}

struct Thing {
  std::shared_ptr<const Model> model;
  Transform place;
  Vector3 velocity_mps;
};

/// One behind another; every other one moves, and some are out of range or out of sight.
std::vector<Thing> Crowd() {
  std::vector<Thing> crowd;
  const auto model = Thicket(1);
  for (std::uint32_t i = 0; i < 40; ++i) {
    const auto place = RandomWords(7, RandomUse::kTreePlacement, 0, i);
    const auto turn = static_cast<double>(UnitFloat(place[3]));
    const Vector3 position_m(5.0 + 110.0 * static_cast<double>(UnitFloat(place[0])),
                             30.0 * static_cast<double>(UnitFloat(place[1])) - 15.0,
                             4.0 * static_cast<double>(UnitFloat(place[2])) - 2.0);
    crowd.push_back({i % 5 == 0 ? Thicket(i) : model,
                     MakeTransform(RotationFromYawPitchRoll(6.0 * turn, 0.0, 0.0), position_m),
                     i % 2 == 0 ? Vector3::Zero() : Vector3(-20.0 * turn, 8.0, 0.0)});
  }
  crowd[3].place.translation() = Vector3(-30.0, 0.0, 0.0);
  crowd[4].place.translation() = Vector3(400.0, 0.0, 0.0);
  crowd[5].place.translation() = Vector3(400.0, 0.0, 0.0);
  return crowd;
}

std::shared_ptr<SimpleWorld> WorldOf(const std::vector<Thing>& things) {
  auto world = std::make_shared<SimpleWorld>();
  world->velocity_chunk_mps = {15.0, 0.0, 0.0};
  for (const Thing& thing : things) world->AddObject(thing.model, thing.place, thing.velocity_mps);
  return world;
}

const ScanPattern& Pattern() {
  static const ScanPattern pattern = MakeRaster(50.75, 21, 0.35);
  return pattern;
}

std::vector<std::uint32_t> FiringsAlone(const std::vector<ObjectView>& views) {
  std::vector<std::uint32_t> firings;
  for (const ObjectView& view : views) firings.push_back(view.firings_alone);
  return firings;
}

// The slow and obvious way: a scan of a world that holds nothing else.
std::uint32_t FiringsOn(const Thing& thing, std::uint32_t frame_index) {
  const Frame frame = ScanOnce(WorldOf({thing}), Pattern(), {}, frame_index);
  return static_cast<std::uint32_t>(std::count(frame.instance.begin(), frame.instance.end(), 1U));
}

TEST(ViewCounter, CountsFiringsAloneAsInAWorldOfTheObjectsOwn) {
  ASSERT_NE(Pattern().num_firings() % kPacketSize, 0U) << "the last packet is not full";
  const std::vector<Thing> crowd = Crowd();
  std::vector<std::uint32_t> expected;
  for (const Thing& thing : crowd) expected.push_back(FiringsOn(thing, 2));
  EXPECT_GT(std::count_if(expected.begin(), expected.end(), [](auto n) { return n > 20; }), 10);
  EXPECT_GT(std::count(expected.begin(), expected.end(), 0U), 2);
  for (const int num_threads : {1, 3}) {
    auto world = WorldOf(crowd);
    world->ground.parts = {{MakeWall(2.0F, 100.0F), 1, 1}};  // Hides all of them.
    Simulator simulator(world, Pattern(), TestMaterials(), {}, num_threads);
    EXPECT_EQ(FiringsAlone(simulator.ViewObjects(2)), expected);
  }
}

TEST(ViewCounter, CountsFiringsAloneWhileTheWindMovesTrees) {
  const std::vector<Thing> crowd = Crowd();
  SimulatorSpec windy;
  windy.detector.weather.wind_speed_mps = 12.0;
  auto world = WorldOf(crowd);
  world->placements = {{Thicket(99), Eigen::Affine3d(Eigen::Translation3d(6.0, 0.0, 0.0)), 0, 4.0}};
  Simulator simulator(world, Pattern(), TestMaterials(), windy, 2);
  const std::vector<std::uint32_t> alone = FiringsAlone(simulator.ViewObjects(2));
  ASSERT_EQ(alone.size(), crowd.size());
  for (std::size_t i = 0; i < crowd.size(); ++i) EXPECT_EQ(alone[i], FiringsOn(crowd[i], 2)) << i;
}

/// A world without its first object.
class WithoutTheFirst final : public World {
 public:
  explicit WithoutTheFirst(std::shared_ptr<const World> whole)
      : whole_(std::move(whole)), objects_(whole_->objects()) {
    objects_.erase(objects_.begin());
  }
  [[nodiscard]] Transform WorldFromVehicle(std::int64_t time_ns) const override {
    return whole_->WorldFromVehicle(time_ns);
  }
  [[nodiscard]] int HomeChunk(std::int64_t time_ns) const override {
    return whole_->HomeChunk(time_ns);
  }
  [[nodiscard]] std::vector<int> ChunksInReach(int chunk, double range_m) const override {
    return whole_->ChunksInReach(chunk, range_m);
  }
  [[nodiscard]] Transform WorldFromChunk(int chunk) const override {
    return whole_->WorldFromChunk(chunk);
  }
  [[nodiscard]] Chunk BuildChunk(int chunk) const override { return whole_->BuildChunk(chunk); }
  [[nodiscard]] const std::vector<SceneObject>& objects() const override { return objects_; }
  [[nodiscard]] Transform WorldFromObject(std::size_t object, std::int64_t time_ns) const override {
    return whole_->WorldFromObject(object + 1, time_ns);
  }

 private:
  std::shared_ptr<const World> whole_;
  std::vector<SceneObject> objects_;
};

TEST(ViewCounter, KeepsItsCountsWhenAnotherObjectIsRemoved) {
  const auto world = WorldOf(Crowd());
  Simulator simulator(world, Pattern(), TestMaterials(), {}, 1);
  const auto before = FiringsAlone(simulator.ViewObjects(2));
  simulator.UseWorld(std::make_shared<const WithoutTheFirst>(world));
  const auto after = FiringsAlone(simulator.ViewObjects(2));
  EXPECT_EQ(after, std::vector<std::uint32_t>(before.begin() + 1, before.end()));
}

// One ray per firing: the frame of the rung geometry has the first object of each.
TEST(ViewCounter, CountsVisibleFiringsAsTheFrameShowsThem) {
  auto world = WorldOf(Crowd());
  world->ground.parts = {{MakeWall(60.0F, 10.0F), 1, 1}};
  Simulator simulator(world, Pattern(), TestMaterials(), {}, 2);
  const Frame frame = FrameBy(simulator, 2);
  const std::vector<ObjectView> views = simulator.ViewObjects(2);
  std::size_t num_partly_hidden = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto instance = static_cast<std::uint32_t>(i + 1);
    EXPECT_EQ(views[i].firings_visible,
              std::count(frame.instance.begin(), frame.instance.end(), instance));
    EXPECT_EQ(views[i].rays_visible, views[i].firings_visible);
    EXPECT_EQ(views[i].rays_alone, views[i].firings_alone);
    const double occlusion = views[i].occlusion().value_or(0.0);
    if (occlusion > 0.0 && occlusion < 1.0) ++num_partly_hidden;
  }
  EXPECT_GT(num_partly_hidden, 10U);
}

SimulatorSpec WithWideBeams() {
  SimulatorSpec spec;
  spec.detector.effects = EffectsOfRung(Fidelity::kFootprint);
  spec.detector.beam.divergence_mrad = {3.0, 3.0};
  return spec;
}

/// A board of 4 m x 4 m at 50 m, and at 40 m a screen that hides what is to the left of its edge.
/// @param edge_y_m Where the edge appears on the board.
std::shared_ptr<SimpleWorld> ScreenedBoard(double edge_y_m) {
  constexpr double kScreenWidth_m = 20.0;
  auto world = std::make_shared<SimpleWorld>();
  const auto wall = [](float half_m) {
    return std::make_shared<const Model>(Model{"wall", {{MakeWall(0.0F, half_m), 2, 2}}});
  };
  world->AddObject(wall(2.0F), Transform(Eigen::Translation3d(50.0, 0.0, 0.0)));
  world->AddObject(
      wall(static_cast<float>(kScreenWidth_m / 2.0)),
      Transform(Eigen::Translation3d(40.0, 40.0 / 50.0 * edge_y_m + kScreenWidth_m / 2.0, 0.0)));
  return world;
}

// Beams 0.35 deg apart are 0.3 m apart on the board, and 3 mrad (a standard deviation of 37 mm
// there) wide, so that 13 x 13 beams meet it, of 16 rays each: those within 0.15 m of an edge by
// parts. The share that is hidden is that of the board to within half a column.
TEST(ViewCounter, FindsTheHiddenShareOfABoardInWideBeams) {
  for (const double edge_y_m : {-3.0, -1.0, 0.0, 1.0, 3.0}) {
    Simulator simulator(ScreenedBoard(edge_y_m), Pattern(), TestMaterials(), WithWideBeams(), 2);
    const ObjectView board = simulator.ViewObjects(0).at(0);
    const double expected = std::clamp((2.0 - edge_y_m) / 4.0, 0.0, 1.0);
    EXPECT_NEAR(board.occlusion().value(), expected, 0.5 / 13.0) << edge_y_m;
    EXPECT_GE(board.firings_alone, 13U * 13U);
    EXPECT_NEAR(board.rays_alone, 16.0 * 16.0 / 0.0933, 0.1 * 16.0 * 16.0 / 0.0933);
    EXPECT_GT(board.firings_alone * 16U, board.rays_alone) << "some beams meet it by parts";
  }
}

TEST(ViewCounter, CountsAWideBeamAsOneFiring) {
  Simulator simulator(ScreenedBoard(-3.0), MakeRaster(0.7, 0.7, 0.35), TestMaterials(),
                      WithWideBeams(), 1);
  // 2 x 2 beams, all of whose rays meet the board and, before it, the screen.
  EXPECT_EQ(simulator.ViewObjects(0), (std::vector<ObjectView>{{4, 0, 64, 0}, {4, 4, 64, 64}}));
}

// What is off, what only aims the rays otherwise, what leaves out surfaces, what makes tiles twice,
// and what casts more rays than one for a beam.
std::vector<SimulatorSpec> SpecsWithOtherRays() {
  std::vector<SimulatorSpec> specs(5);
  specs[1].detector.effects = EffectsOfRung(Fidelity::kSurface);
  specs[1].detector.effects.pointing_jitter = true;
  specs[1].detector.receiver.pointing_jitter_deg = 0.1;
  specs[2].detector.effects = EffectsOfRung(Fidelity::kSurface);
  specs[2].detector.effects.thin_conductors = true;
  specs[3].detector.effects = EffectsOfRung(Fidelity::kSurface);
  specs[3].detector.effects.halo = true;
  specs[3].detector.receiver.halo_share_at_1_deg = 1e-3;
  specs[4] = WithWideBeams();
  return specs;
}

TEST(ViewCounter, CountsTheSameWithTheRaysOfTheFrame) {
  auto world = WorldOf(Crowd());
  world->ground.parts = {{MakeWall(60.0F, 10.0F), 1, 1}};
  for (const SimulatorSpec& spec : SpecsWithOtherRays()) {
    Simulator simulator(world, Pattern(), TestMaterials(), spec, 3);
    Frame expected = FrameBy(simulator, 2);
    Frame frame;
    std::vector<ObjectView> views;
    simulator.Scan(*simulator.Begin(2), frame, views);
    EXPECT_EQ(views, simulator.ViewObjects(2));
    ExpectSameBytes(frame, expected);
  }
}

/// Keeps the firings that it is asked of.
class AskedFirings final : public FiringSurfaces {
 public:
  void Meet(const std::uint32_t* firings, std::size_t num, RayTile&) const override {
    of.insert(of.end(), firings, firings + num);
  }
  void Meet(std::uint32_t firing, BeamRays&) const override { of.push_back(firing); }
  mutable std::vector<std::uint32_t> of;
};

TEST(ViewCounter, AsksOfNoFiringThatWasThereBefore) {
  const auto world = WorldOf({{Thicket(1), Transform(Eigen::Translation3d(10.0, 0.0, 0.0)), {}}});
  FrameScenes scenes(std::make_shared<SceneStore>(world, TestMaterials()), {.range_max_m = 100.0});
  const BeamTracer tracer(SimulatorSpec{}, TestMaterials().materials(), Pattern());
  BegunFrame begun = scenes.Begin(0, 0);
  const FrameScene& scene = scenes.SceneOf(begun);
  const AskedFirings asked;
  CastFrame cast{scene.index,      scene.poses, scene,
                 scene.surfaces(), nullptr,     scene.window->window_from_world};
  cast.besides = &asked;
  const auto middle = static_cast<std::uint32_t>(Pattern().num_firings() / 2);
  const std::vector<std::uint32_t> firings = {middle, middle + 1, middle + 2};
  BeamTracer::Work work(tracer);
  std::ranges::fill(work.echoes.first.firing, 0xFFFFFFFFU);  // Of a longer frame.
  ViewCounter views(cast, *world, scenes.ObjectsAlone(scene));
  views.Add(tracer, FiringTiles(Pattern(), firings), 0, work);
  EXPECT_EQ(asked.of, firings);
  EXPECT_GT(views.Total().front().firings_alone, 0U);
}

}  // namespace
}  // namespace railcast
