// What effect footprint makes of what its sub-rays meet, as seen in the frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/detect/base/weather_optics.h"
#include "railcast/simulator.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/same_frames.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr double kSigma_rad = 0.75e-3;

SimulatorSpec SpecOfWideBeams() {
  SimulatorSpec spec{.detector = {.effects = {.footprint = true}}};
  spec.detector.beam.divergence_mrad = {3.0, 3.0};
  return spec;
}

// A wall 50 m away, right of the forward direction; nothing on the left.
std::shared_ptr<SimpleWorld> HalfAWall() {
  return WorldOfParts(
      {{{{{50, -60, -30}, {50, 0, -30}, {50, 0, 30}, {50, -60, 30}}, {{0, 1, 2}, {0, 2, 3}}},
        2,
        1}});
}

double AzimuthOf(const ScanPattern& pattern, const Frame& frame, std::size_t slot) {
  // The middle rows lie near the horizon; a column's azimuth is that of any of its firings.
  for (std::size_t firing = 0; firing < pattern.num_firings(); ++firing) {
    if (pattern.row[firing] == frame.ring[slot] && pattern.column[firing] == frame.column[slot]) {
      return std::atan2(static_cast<double>(pattern.direction_y[firing]),
                        static_cast<double>(pattern.direction_x[firing]));
    }
  }
  return std::nan("");
}

TEST(Footprint, SeesTheShareOfABeamBesideAnEdge) {
  const ScanPattern pattern = MakeRaster(0.4, 0.2, 0.02);
  const Frame frame = ScanOnce(HalfAWall(), pattern, SpecOfWideBeams());
  int num_near = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const double off_edge = -AzimuthOf(pattern, frame, slot) / kSigma_rad;
    if (std::fabs(off_edge) > 2.5) continue;
    const double share = 0.5 * std::erfc(-off_edge / std::sqrt(2.0));
    // SubRays.OfABeamFindTheShareBesideAnEdge has the bound of the pattern.
    EXPECT_NEAR(static_cast<double>(frame.footprint_share[slot]), share, 0.075) << off_edge;
    ++num_near;
  }
  EXPECT_GT(num_near, 80);
}

// By the background's share of the beam: what stands before the sky has little of it.
TEST(Footprint, HasTheSunsNoiseOfAllThatTheBeamMeets) {
  const ScanPattern pattern = MakeRaster(0.4, 0.2, 0.02);
  SimulatorSpec spec = SpecOfWideBeams();
  spec.detector.weather.sun.illuminance_klx = 100.0;
  const Frame night = ScanOnce(HalfAWall(), pattern, spec);
  spec.detector.effects.sunlight = true;
  const Frame day = ScanOnce(HalfAWall(), pattern, spec);
  const double gain = SunBackgroundGain(spec.detector.weather.sun);
  const double reflectivity = TestMaterials().materials().at(2).reflectivity;
  int num = 0;
  for (std::size_t slot = 0; slot < day.num_slots(); ++slot) {
    const auto share = static_cast<double>(night.footprint_share[slot]);
    if (!(share > 0.05 && share < 0.95)) continue;
    EXPECT_NEAR(static_cast<double>(day.power_ratio[slot] / night.power_ratio[slot]),
                1.0 / std::sqrt(1.0 + gain * share * reflectivity), 1e-4);
    ++num;
  }
  EXPECT_GT(num, 40);
}

TEST(Footprint, LeavesThePlainAlone) {
  // Ground at grazing incidence: the ranges of neighbours differ by metres but lie on one plane.
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts.push_back({MakeFloor(-2.0F, 3000.0F), 1, 2});
  SimulatorSpec spec = SpecOfWideBeams();
  const Frame wide = ScanOnce(world, MakeRaster(10, 8, 0.25), spec);
  spec.detector.effects = {.detection = true};
  const Frame single = ScanOnce(world, MakeRaster(10, 8, 0.25), spec);
  int num_compared = 0;
  for (std::size_t slot = 0; slot + 3 * wide.width() < wide.num_slots() / 2; ++slot) {
    ASSERT_EQ(wide.true_range_m[slot], single.true_range_m[slot]) << slot;
    EXPECT_EQ(wide.mixed_share[slot], 0.0F);
    ++num_compared;
  }
  EXPECT_GT(num_compared, 400);
}

// Ground 2 m below the sensor stretches the pulse; a receiver of energy does not mind. Without
// detection and its fluctuations every beam has its power.
TEST(Footprint, KeepsTheEnergyOfGrazedGroundWhosePeakFalls) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts.push_back({MakeFloor(-2.0F, 3000.0F), 1, 2});
  const ScanPattern pattern = MakeRaster(1.0, 12.0, 0.1);
  for (const Fidelity rung : {Fidelity::kSurface, Fidelity::kFootprint, Fidelity::kReference}) {
    SimulatorSpec spec{.detector = {.effects = EffectsOfRung(rung)}};
    spec.detector.effects.detection = false;
    spec.detector.effects.pointing_jitter = false;
    spec.detector.beam.divergence_mrad = {1.5, 1.5};
    const Frame peak = ScanOnce(world, pattern, spec);
    spec.detector.receiver.signal = EchoSignal::kEnergy;
    const Frame energy = ScanOnce(world, pattern, spec);
    int num = 0;
    int num_whole = 0;
    for (std::size_t slot = 0; slot < peak.num_slots(); ++slot) {
      const auto range_m = static_cast<double>(energy.true_range_m[slot]);
      if (!(range_m > 20.0 && range_m < 120.0)) continue;
      ++num;
      if (energy.footprint_share[slot] < 0.99F) continue;
      ++num_whole;
      const double unstretched = static_cast<double>(energy.intensity[slot]) / (range_m * range_m) *
                                 std::pow(spec.detector.receiver.range_at_10_percent_m, 2.0) / 0.1;
      // 0.3183 m of the pulse; the beam's sigma is a quarter of its full angle.
      const double spread_m = range_m * std::sqrt(range_m * range_m / 4.0 - 1.0) * 1.5e-3 / 4.0;
      const double stretch = 0.3183 / std::hypot(0.3183, spread_m);
      EXPECT_NEAR(static_cast<double>(energy.power_ratio[slot]) / unstretched, 1.0, 0.03)
          << NameOf(rung) << " at " << range_m;
      EXPECT_NEAR(static_cast<double>(peak.power_ratio[slot]) / unstretched / stretch, 1.0, 0.12)
          << NameOf(rung) << " at " << range_m;
    }
    // Rung `reference` splits some beams that reach far beyond the others.
    EXPECT_GT(num, 400) << NameOf(rung);
    EXPECT_GT(num_whole, 0.9 * num) << NameOf(rung);
  }
}

// Two surfaces a quarter of the pulse apart merge into one echo, whose range is between them.
TEST(Footprint, SeesAStepOfATenthOfAMetreAsAMixedPixel) {
  constexpr float kStep_m = 0.1F;
  auto world = HalfAWall();
  world->ground.parts.push_back({MakeWall(50.0F + kStep_m, 60.0F), 2, 1});
  SimulatorSpec spec = SpecOfWideBeams();
  const ScanPattern pattern = MakeRaster(0.4, 0.2, 0.02);
  const Frame frame = ScanOnce(world, pattern, spec);
  int num_mixed = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const double off_edge = -AzimuthOf(pattern, frame, slot) / kSigma_rad;
    if (std::fabs(off_edge) > 1.5) continue;
    const double near_share = 0.5 * std::erfc(-off_edge / std::sqrt(2.0));
    const double step_m = 50.0 + static_cast<double>(kStep_m) * (1.0 - near_share);
    EXPECT_NEAR(static_cast<double>(frame.range_m[slot]), step_m, 0.075 * 0.1 + 1e-3) << off_edge;
    ++num_mixed;
  }
  EXPECT_GT(num_mixed, 40);
}

// Sub-rays in a crowd of triangles are fewer, but what they stand for still fills the beam.
TEST(Footprint, FillsTheBeamInACrowd) {
  auto world = std::make_shared<SimpleWorld>();
  Mesh patches;
  for (int row = -40; row < 40; ++row) {
    for (int column = -40; column < 40; ++column) {
      const auto first = static_cast<std::uint32_t>(patches.vertices.size());
      const float y = 0.05F * static_cast<float>(column);
      const float z = 0.05F * static_cast<float>(row);
      if ((row + column) % 2 != 0) continue;
      const float x = 50.0F;
      patches.vertices.insert(
          patches.vertices.end(),
          {{x, y, z}, {x, y + 0.05F, z}, {x, y + 0.05F, z + 0.05F}, {x, y, z + 0.05F}});
      patches.triangles.push_back({first, first + 1, first + 2});
      patches.triangles.push_back({first, first + 2, first + 3});
    }
  }
  world->ground.parts = {{patches, 2, 1}, {MakeWall(53.0F, 60.0F), 2, 1}};
  SimulatorSpec spec = SpecOfWideBeams();
  spec.detector.beam.divergence_mrad = {8.0, 8.0};
  spec.detector.receiver.return_mode = ReturnMode::kDual;
  const Frame frame = ScanOnce(world, MakeRaster(2.5, 2.5, 0.1), spec);
  // The patches fill half of the beam, and 16 sub-rays at least sample it.
  constexpr double kDeviation = 0.125;
  double sum = 0.0;
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += 2) {
    const double first = static_cast<double>(frame.footprint_share[slot]);
    const double second = static_cast<double>(frame.footprint_share[slot + 1]);
    ASSERT_EQ(frame.return_count[slot], 2) << slot;
    EXPECT_NEAR(first + second, 1.0, 1e-5);
    // The strongest comes first.
    const double of_patches = frame.range_m[slot] < 51.5F ? first : second;
    EXPECT_NEAR(of_patches, 0.5, 3.5 * kDeviation);
    sum += of_patches;
  }
  const double num_beams = 0.5 * static_cast<double>(frame.num_slots());
  EXPECT_NEAR(sum / num_beams, 0.5, 3.5 * kDeviation / std::sqrt(num_beams));
}

Mesh Plate(float x, const Eigen::Vector2f& least, const Eigen::Vector2f& most) {
  return {{{x, least.x(), least.y()},
           {x, most.x(), least.y()},
           {x, most.x(), most.y()},
           {x, least.x(), most.y()}},
          {{0, 1, 2}, {0, 2, 3}}};
}

// A host's caster is given all central rays, the simulator's own only those that are needed. Walls
// so black that no light comes back, their edges beside the sky, a plate that is too near and the
// vehicle itself leave many beams to what the central ray meets.
TEST(Footprint, LeavesOutNoCentralRayThatMakesADifference) {
  const auto world = WorldOfParts({{Plate(4.0F, {-9, -9}, {0, 9}), 2, 1},
                                   {Plate(4.5F, {-9, -9}, {0.04F, 9}), 2, 2},
                                   {Plate(280.0F, {-90, -90}, {90, 0}), 3, 3},
                                   {Plate(270.0F, {2, -90}, {4, 0}), 3, 4},
                                   {Plate(0.3F, {-0.02F, -1}, {0.02F, -0.004F}), 2, 5}});
  world->AddObject(
      std::make_shared<Model>(Model{"own", {{Plate(2.0F, {0.02F, 0.01F}, {1, 1}), 1, 6}}}),
      Transform::Identity(), Vector3::Zero(), true);
  SimulatorSpec spec{.detector = {.effects = EffectsOfRung(Fidelity::kFootprint)}};
  spec.detector.effects.thin_conductors = false;  // A host has no wires.
  spec.detector.beam.divergence_mrad = {3.0, 3.0};
  const MaterialLibrary materials({{"dark", 0.1}, {"grey", 0.5}, {"white", 1.0}, {"black", 0.0}});
  Simulator simulator(world, MakeRaster(2, 2, 0.02), materials, spec, 0);
  const Frame frame = FrameBy(simulator);
  for (const Outcome outcome :
       {Outcome::kReturned, Outcome::kNoSurface, Outcome::kNearRange, Outcome::kEgo}) {
    EXPECT_GT(std::ranges::count(frame.outcome, outcome), 100) << static_cast<int>(outcome);
  }
  EXPECT_GT(std::ranges::count(frame.label, 4U), 100);
  simulator.VisitScene(0, [&](const SceneOfFrame& scene) {
    Frame with_all;
    simulator.Scan(0, HostScene{scene.caster, scene.window_from_world, scene.surfaces}, with_all);
    ExpectSameBytes(frame, with_all);
  });
}

}  // namespace
}  // namespace railcast
