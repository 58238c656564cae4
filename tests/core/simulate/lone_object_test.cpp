#include "core/simulate/lone_object.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "core/base/random.h"
#include "railcast/simulator.h"
#include "tests/support/analytic_meshes.h"
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

// The slow and obvious way: a scan of a world that holds nothing else.
std::uint32_t FiringsOn(const Thing& thing, std::uint32_t frame_index) {
  const Frame frame = ScanOnce(WorldOf({thing}), Pattern(), {}, frame_index);
  return static_cast<std::uint32_t>(std::count(frame.instance.begin(), frame.instance.end(), 1U));
}

TEST(LoneObjects, AreHitAsOftenAsEachInAWorldOfItsOwn) {
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
    EXPECT_EQ(simulator.FiringsOnObjectAlone(2), expected);
  }
}

TEST(LoneObjects, AreCountedWhileTheWindMovesTrees) {
  const std::vector<Thing> crowd = Crowd();
  SimulatorSpec windy;
  windy.detector.weather.wind_speed_mps = 12.0;
  auto world = WorldOf(crowd);
  world->placements = {{Thicket(99), Eigen::Affine3d(Eigen::Translation3d(6.0, 0.0, 0.0)), 0, 4.0}};
  Simulator simulator(world, Pattern(), TestMaterials(), windy, 2);
  const std::vector<std::uint32_t> alone = simulator.FiringsOnObjectAlone(2);
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

TEST(LoneObjects, KeepTheirCountsWhenAnotherIsRemoved) {
  const auto world = WorldOf(Crowd());
  Simulator simulator(world, Pattern(), TestMaterials(), {}, 1);
  const std::vector<std::uint32_t> before = simulator.FiringsOnObjectAlone(2);
  simulator.UseWorld(std::make_shared<const WithoutTheFirst>(world));
  const std::vector<std::uint32_t> after = simulator.FiringsOnObjectAlone(2);
  EXPECT_EQ(after, std::vector<std::uint32_t>(before.begin() + 1, before.end()));
}

}  // namespace
}  // namespace railcast
