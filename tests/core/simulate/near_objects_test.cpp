#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "core/detect/detector/effect_table.h"
#include "core/simulate/beams_near_objects.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

std::shared_ptr<SimpleWorld> WorldWithSphere(const Vector3& place_m, const Vector3& velocity_mps) {
  auto world = std::make_shared<SimpleWorld>();
  const auto model =
      std::make_shared<const Model>(Model{"sphere", {{MakeSphere(1.0, 12, 24), 3, 1}}});
  world->AddObject(model, MakeTransform(Eigen::Matrix3d::Identity(), place_m), velocity_mps);
  return world;
}

TEST(NearObjects, AreMetByAllBeamsThatDoAndFewMore) {
  const auto world = WorldWithSphere({25.0, -3.0, 0.0}, {0.0, 30.0, 0.0});
  world->velocity_chunk_mps = {20.0, 0.0, 0.0};
  const ScanPattern pattern = MakeRaster(60.0, 30.0, 0.5);
  const Frame frame = ScanOnce(world, pattern);
  const NearObjects near(*world, std::array<std::size_t, 1>{}, pattern, {.range_max_m = 300.0});
  const std::vector<std::uint32_t> firings = near.Beams(0.0);
  std::size_t num_hits = 0;
  for (std::uint32_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t slot = std::size_t{pattern.row[i]} * pattern.columns + pattern.column[i];
    if (frame.outcome[slot] != Outcome::kReturned) continue;
    ++num_hits;
    EXPECT_TRUE(std::ranges::binary_search(firings, i));
  }
  ASSERT_GT(num_hits, 30U);
  // The sphere around the box around a sphere has the square root of 3 times its radius.
  EXPECT_LT(firings.size(), 5 * num_hits);
}

TEST(NearObjects, AreMetByTheSameBeamsAmongWiderOnes) {
  const auto world = WorldWithSphere({25.0, -3.0, 0.0}, {0.0, 30.0, 0.0});
  const ScanPattern pattern = MakeRaster(60.0, 30.0, 0.5);
  const NearObjects near(*world, std::array<std::size_t, 1>{}, pattern, {.range_max_m = 300.0});
  const std::vector<std::uint32_t> wide = near.Beams(0.03);
  const std::vector<std::uint32_t> narrow = near.Beams(0.001);
  EXPECT_LT(narrow.size(), wide.size());
  EXPECT_EQ(near.Beams(0.001, wide), narrow);
}

TEST(NearObjects, AreMetByNoBeamBehindTheSensorOrBeyondItsRange) {
  const ScanPattern pattern = MakeRaster(60.0, 30.0, 1.0);
  for (const double ahead_m : {-20.0, 400.0}) {
    const auto world = WorldWithSphere({ahead_m, 0.0, 0.0}, Vector3::Zero());
    const NearObjects near(*world, std::array<std::size_t, 1>{}, pattern, {.range_max_m = 300.0});
    EXPECT_TRUE(near.Beams(0.0).empty());
  }
}

// Frames of which only firings near objects are traced, against whole ones.

ScenarioSpec ReadShipped(const std::string& name) {
  return ReadScenario(std::string(RAILCAST_SOURCE_DIR "/scenarios/") + name);
}

// Slots by value, NaN being the same as NaN.
void ExpectSameSlot(const Frame& whole, const Frame& near, std::size_t slot) {
  ForEachField(whole, [&](const std::string& name, const char* /*unit*/, const auto& of_whole) {
    ForEachField(near, [&](const std::string& other, const char* /*unit*/, const auto& of_near) {
      if constexpr (std::is_same_v<decltype(of_whole), decltype(of_near)>) {
        if (name != other) return;
        const bool are_both_nan =
            of_whole[slot] != of_whole[slot] && of_near[slot] != of_near[slot];
        EXPECT_TRUE(are_both_nan || of_whole[slot] == of_near[slot]) << name << " of slot " << slot;
      }
    });
  });
}

// @return Number of returns on objects.
std::size_t ExpectSameOnObjects(const ScenarioSpec& spec,
                                const std::vector<std::uint32_t>& frames) {
  const auto simulator = MakeSimulator(spec, 2);
  std::set<std::uint32_t> instances;
  std::vector<std::size_t> objects;
  for (const SceneObject& object : simulator->world().objects()) {
    objects.push_back(objects.size());
    if (!object.is_ego) instances.insert(object.instance);
  }
  Frame whole;
  Frame near;
  std::size_t num_on_objects = 0;
  for (const std::uint32_t index : frames) {
    simulator->Scan(index, whole);
    simulator->ScanNearObjects(*simulator->Begin(index), objects, near);
    EXPECT_EQ(near.stamp_ns, whole.stamp_ns);
    EXPECT_EQ(near.duration_ns, whole.duration_ns);
    EXPECT_EQ(near.world_from_sensor_end.matrix(), whole.world_from_sensor_end.matrix());
    for (std::size_t slot = 0; slot < whole.num_slots(); ++slot) {
      EXPECT_EQ(near.time_ns[slot], whole.time_ns[slot]);
      const bool is_untraced = near.outcome[slot - slot % near.returns] == Outcome::kNoSurface;
      if (is_untraced && whole.outcome[slot] != Outcome::kClutter) {
        EXPECT_FALSE(instances.contains(whole.instance[slot])) << slot;
      } else if (!is_untraced) {
        ExpectSameSlot(whole, near, slot);
      }
      num_on_objects +=
          instances.contains(near.instance[slot]) && HasPoint(near.outcome[slot]) ? 1U : 0U;
    }
  }
  return num_on_objects;
}

TEST(NearObjectsScan, HoldsTheSameOfObjectsOnEachRung) {
  for (const Fidelity rung :
       {Fidelity::kGeometry, Fidelity::kPlausibility, Fidelity::kSurface, Fidelity::kFootprint}) {
    ScenarioSpec spec = ReadShipped("st_gallen_approach.json");
    spec.fidelity = rung;
    SCOPED_TRACE(NameOf(rung));
    EXPECT_GT(ExpectSameOnObjects(spec, {0, 40}), 200U);
  }
}

TEST(FiringsNearObjects, AreMoreWhereAVariantHasWiderBeams) {
  ScenarioSpec spec = ReadShipped("st_gallen_approach.json");
  spec.fidelity = Fidelity::kSurface;
  const auto simulator = MakeSimulator(spec, 1);
  const std::array<std::size_t, 1> objects{};
  const auto begun = simulator->Begin(40);
  const std::vector<std::uint32_t> narrow = simulator->FiringsNearObjects(*begun, objects);
  ASSERT_GT(narrow.size(), 0U);
  simulator->UseVariants({{EffectsInRung(Fidelity::kFootprint)}});
  const std::vector<std::uint32_t> wide = simulator->FiringsNearObjects(*begun, objects);
  EXPECT_GT(wide.size(), narrow.size());
  EXPECT_TRUE(std::ranges::includes(wide, narrow));
}

TEST(NearObjectsScan, HoldsTheSameOfWhoWalksInFogBeforeASensorOfSeveralReturns) {
  ScenarioSpec spec = ReadShipped("brake_person.json");
  spec.fidelity = Fidelity::kFootprint;
  spec.weather.visibility_m = 200.0;
  spec.weather.wind_speed_mps = 8.0;
  spec.lidar.receiver.return_mode = ReturnMode::kDual;
  spec.lidar.receiver.pointing_jitter_deg = 0.05;
  spec.vehicle.start_s_m = 560.0;
  EXPECT_GT(ExpectSameOnObjects(spec, {0, 3}), 20U);
}

TEST(NearObjectsScan, HoldsTheSameOfARetroreflectorsHalo) {
  ScenarioSpec spec = ReadShipped("st_gallen_approach.json");
  spec.fidelity = Fidelity::kFootprint;
  spec.lidar.receiver.halo_share_at_1_deg = 1e-3;
  spec.effects["halo"] = true;
  spec.world.objects.back().material = "retro_sheeting";
  (void)ExpectSameOnObjects(spec, {0});
}

TEST(NearObjectsScan, HoldsTheSameOfAPatternThatDoesNotRepeat) {
  ScenarioSpec spec = ReadShipped("st_gallen_approach.json");
  spec.lidar = ReadScenarioText(R"({"version": 1, "file": "minimal.json",
                                    "lidar": {"file": "sensors/mid40_like.json"}})",
                                RAILCAST_SOURCE_DIR "/scenarios/given.json")
                   .lidar;
  spec.lidar.mount.position_m = {2.2, 0.0, 2.5};
  EXPECT_GT(ExpectSameOnObjects(spec, {0, 1, 40}), 20U);
}

// The sensors of docs/results/detection_table.md.
TEST(NearObjectsScan, HoldsTheSameOfAPersonAt100MetresOnRealSensors) {
  for (const std::string sensor : {"pandar64", "vls128", "rosette"}) {
    SCOPED_TRACE(sensor);
    ScenarioSpec spec = ReadShipped("brake_person.json");
    const MountSpec mount = spec.lidar.mount;
    spec.lidar = ReadScenarioText(R"({"version": 1, "file": "minimal.json",
                                      "lidar": {"file": "sensors/)" +
                                      sensor + R"(.json"}})",
                                  RAILCAST_SOURCE_DIR "/scenarios/given.json")
                     .lidar;
    spec.lidar.mount = mount;
    spec.fidelity = Fidelity::kFootprint;
    spec.vehicle.start_s_m = spec.world.objects.at(0).s_m - 100.0;
    EXPECT_GT(ExpectSameOnObjects(spec, {0}), 5U);
  }
}

}  // namespace
}  // namespace railcast
