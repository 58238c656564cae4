// Where effect footprint casts sub-rays, as deduced from the frames.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "railcast/simulator.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr double kSigma_rad = 0.75e-3;

SimulatorSpec WideBeams() {
  SimulatorSpec spec{.detector = {.effects = {.footprint = true}}};
  spec.detector.beam.divergence_mrad = {3.0, 3.0};
  return spec;
}

// A wall 50 m away, right of the forward direction; nothing on the left.
std::shared_ptr<SimpleWorld> HalfAWall() {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {
      {{{{50, -60, -30}, {50, 0, -30}, {50, 0, 30}, {50, -60, 30}}, {{0, 1, 2}, {0, 2, 3}}}, 2, 1}};
  return world;
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

TEST(SubRayNeeds, SeesAnEdgeHalfABeamAwayWhereFiringsStandClose) {
  // 0.35 mrad between firings: adjacent firings do not reveal an edge at a beam's radius.
  const ScanPattern pattern = MakeRaster(0.4, 0.2, 0.02);
  const Frame frame = ScanOnce(HalfAWall(), pattern, WideBeams());
  int num_near = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const double off_edge = -AzimuthOf(pattern, frame, slot) / kSigma_rad;
    if (off_edge < 0.0 || off_edge > 1.1) continue;
    const double share = 0.5 * std::erfc(-off_edge / std::sqrt(2.0));
    // Sixteen sub-rays in rings have errors of up to 0.137, as do sixteen in Vogel's spiral. If a
    // beam wrongly counted as filled, its error would be larger up to 1.1 sigma from the edge.
    EXPECT_NEAR(static_cast<double>(frame.footprint_share[slot]), share, 0.14) << off_edge;
    ++num_near;
  }
  EXPECT_EQ(num_near, 20);
}

TEST(SubRayNeeds, LeavesThePlainAlone) {
  // Ground at grazing incidence: the ranges of neighbours differ by metres but lie on one plane.
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts.push_back({MakeFloor(-2.0F, 3000.0F), 1, 2});
  SimulatorSpec spec = WideBeams();
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

}  // namespace
}  // namespace railcast
