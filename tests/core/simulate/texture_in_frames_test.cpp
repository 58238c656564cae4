// Effect texture on things that stand and move, as seen in the frames.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "railcast/simulator.h"
#include "tests/core/simulate/measured_velocities.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr double kTexture = 0.3;

Frame ScanTextured(const std::shared_ptr<const World>& world,
                   const ScanPattern& pattern,
                   double texture,
                   std::uint32_t frame_index) {
  std::vector<Material> materials = TestMaterials().materials();
  materials.erase(materials.begin());  // "none", which the library adds.
  materials[1].texture = texture;
  SimulatorSpec spec{.detector = {.effects = EffectsOfRung(Fidelity::kSurface)}};
  spec.detector.receiver.pointing_jitter_deg = 0.0;
  spec.detector.beam.divergence_mrad = {0.0, 0.0};
  return FrameBy(Simulator(world, pattern, MaterialLibrary(materials), spec, 1), frame_index);
}

using FactorsOfCells = std::map<std::pair<double, double>, float>;

// The factors of the cells of a sheet that moves as `sheet_mps`, by cell; every point of a cell has
// the same.
FactorsOfCells FactorsOfSheet(double distance_m,
                              const Vector3& sheet_mps,
                              std::uint32_t frame_index) {
  const auto world = WorldWithWallAt(distance_m, sheet_mps);
  const ScanPattern pattern = MakeRaster(6, 4, 0.04);
  const Frame even = ScanTextured(world, pattern, 0.0, frame_index);
  const Frame frame = ScanTextured(world, pattern, kTexture, frame_index);
  FactorsOfCells factors;
  ForEachFiring(frame, pattern, [&](std::size_t slot, const Vector3& direction, double time_s) {
    const Vector3 place_m = static_cast<double>(frame.true_range_m[slot]) * direction -
                            time_s * sheet_mps - Vector3(distance_m, 0.0, 0.0);
    const double y = place_m.y() / 0.03 + 0.381966;
    const double z = place_m.z() / 0.03 + 0.381966;
    // Which cell a place is in is not known within rounding of its sides.
    if (std::abs(y - std::round(y)) < 0.01 || std::abs(z - std::round(z)) < 0.01) return;
    const float factor = frame.intensity[slot] / even.intensity[slot];
    const auto [known, is_new] = factors.try_emplace({std::floor(y), std::floor(z)}, factor);
    EXPECT_NEAR(factor, known->second, 2e-6F) << slot;
  });
  return factors;
}

double LogSpreadOf(const FactorsOfCells& factors) {
  double sum = 0.0;
  double squares = 0.0;
  for (const auto& [cell, factor] : factors) {
    sum += std::log(static_cast<double>(factor));
    squares += std::pow(std::log(static_cast<double>(factor)), 2);
  }
  const auto num = static_cast<double>(factors.size());
  return std::sqrt(squares / num - std::pow(sum / num, 2));
}

void ExpectSame(const FactorsOfCells& a, const FactorsOfCells& b) {
  std::size_t num_common = 0;
  for (const auto& [cell, factor] : a) {
    const auto other = b.find(cell);
    if (other == b.end()) continue;
    EXPECT_NEAR(factor, other->second, 2e-6F);
    ++num_common;
  }
  EXPECT_GT(num_common, 300U);
}

TEST(TextureInFrames, IsFixedToTheThingFromWhereverItIsSeenAndHoweverItMoves) {
  const FactorsOfCells standing = FactorsOfSheet(10.0, Vector3::Zero(), 0);
  // The standard error of a spread is it over sqrt(2 n).
  EXPECT_GT(standing.size(), 500U);
  EXPECT_NEAR(LogSpreadOf(standing) / kTexture, 1.0,
              4.0 / std::sqrt(2.0 * static_cast<double>(standing.size())));
  ExpectSame(FactorsOfSheet(7.0, Vector3::Zero(), 3), standing);
  ExpectSame(FactorsOfSheet(10.0, Vector3(1.0, 0.5, 0.2), 2), standing);
}

TEST(TextureInFrames, IsNotThatOfAnotherInstance) {
  auto world = std::make_shared<SimpleWorld>();
  for (const double y_m : {0.0, 0.9}) {
    world->AddObject(SheetModel(0.4F), Transform(Eigen::Translation3d(10.0, y_m, 0.0)));
  }
  const ScanPattern pattern = MakeRaster(12, 2, 0.1);
  const Frame frame = ScanTextured(world, pattern, kTexture, 0);
  FactorsOfCells factors[2];
  ForEachFiring(frame, pattern, [&](std::size_t slot, const Vector3& direction, double) {
    if (frame.instance[slot] == 0) return;
    const std::size_t i = frame.instance[slot] - 1;
    const Vector3 place_m = static_cast<double>(frame.true_range_m[slot]) * direction;
    factors[i][{std::floor((place_m.y() - 0.9 * static_cast<double>(i)) / 0.03 + 0.381966),
                std::floor(place_m.z() / 0.03 + 0.381966)}] = frame.intensity[slot];
  });
  int num_same = 0;
  int num_common = 0;
  for (const auto& [cell, factor] : factors[0]) {
    const auto other = factors[1].find(cell);
    if (other == factors[1].end()) continue;
    ++num_common;
    num_same += std::abs(factor - other->second) < 1e-3F ? 1 : 0;
  }
  EXPECT_GT(num_common, 50);
  EXPECT_LT(num_same, num_common / 10);
}

}  // namespace
}  // namespace railcast
