// Tests the effects of the sensor's window and stray light through the whole simulator.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/units.h"
#include "railcast/effects.h"
#include "railcast/simulator.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/frame_bytes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr std::uint16_t kPlainWall = 1;
constexpr std::uint16_t kSheeting = 2;
constexpr std::uint32_t kWallLabel = 1;
constexpr std::uint32_t kBoardLabel = 2;
constexpr std::uint32_t kHaloLabel = 28;
constexpr float kBoard_m = 40.0F;

MaterialLibrary BoardMaterials() {
  return MaterialLibrary({{.name = "grey", .reflectivity = 0.5},
                          {.name = "sheet", .reflectivity = 0.2, .retroreflectance = 500.0}});
}

// A wall at 80 m, and 40 m before the sensor a small board.
std::shared_ptr<SimpleWorld> BoardBeforeAWall() {
  return WorldOfParts({{MakeWall(80.0F, 100.0F), kPlainWall, kWallLabel},
                       {MakeWall(kBoard_m, 0.1F), kSheeting, kBoardLabel}});
}

SimulatorSpec WithHalo(double share) {
  SimulatorSpec spec{
      .detector = {.effects = {.surface_response = true, .detection = true, .halo = true}}};
  spec.detector.receiver.halo_share_at_1_deg = share;
  spec.detector.clutter_labels.halo = kHaloLabel;
  return spec;
}

Frame ScanBoard(const SimulatorSpec& spec, int num_threads = 0) {
  return FrameBy(Simulator(BoardBeforeAWall(), MakeRaster(8.0, 8.0, 0.05), BoardMaterials(), spec,
                           num_threads));
}

double OffAxis_deg(const Frame& frame, std::size_t slot) {
  const double azimuth_deg = 4.0 - 0.05 * (frame.column[slot] + 0.5);
  const double elevation_deg = 0.05 * (frame.ring[slot] + 0.5) - 4.0;
  return std::hypot(azimuth_deg, elevation_deg);
}

// The board has a power ratio of 500 / 40^2 / 2.5e-6 = 125,000 and is 0.14 deg from its middle to
// its edges. A halo wins over the wall behind it, of power ratio 31, where the share exceeds 31 /
// 125,000: within (1e-6 / 2.5e-4)^(1/4) = 0.251 deg of the board.
TEST(HaloInFrames, SurroundsABoardUpToTheAngleOfTheClosedForm) {
  const Frame frame = ScanBoard(WithHalo(1e-6));
  const double wall = 0.5 / (80.0 * 80.0) / 2.5e-6;
  const double board = 500.2 / (40.0 * 40.0) / 2.5e-6;
  const double radius_deg = std::pow(1e-6 * board / wall, 0.25);
  EXPECT_NEAR(radius_deg, 0.251, 0.001);
  const double half_deg = DegFromRad(std::atan(0.1 / 40.0));
  std::size_t num_halo = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const double away_deg = OffAxis_deg(frame, slot);
    if (frame.label[slot] == kHaloLabel) {
      ++num_halo;
      EXPECT_EQ(frame.outcome[slot], Outcome::kClutter);
      // The board is flat: towards its corners its range is up to a quarter of a millimetre more.
      EXPECT_NEAR(frame.range_m[slot], kBoard_m, 3e-4F);
      EXPECT_LT(away_deg, half_deg * std::sqrt(2.0) + radius_deg);
    } else if (frame.label[slot] == kWallLabel) {
      // The board's outermost beams are up to one cell inside its edge.
      EXPECT_GT(away_deg, half_deg + radius_deg - 0.05 * std::sqrt(2.0));
    }
  }
  // The cells within the radius of a square of half the side 0.125 deg (the last cells' centres)
  // less the square itself: (4 x 0.25 x 0.251 + pi 0.251^2 - 0.0188) / 0.05^2.
  EXPECT_NEAR(static_cast<double>(num_halo), 172.0, 20.0);
}

TEST(HaloInFrames, IsTheSameAtAnyNumberOfThreads) {
  const std::string one = FrameBytes(ScanBoard(WithHalo(1e-5), 1));
  EXPECT_EQ(FrameBytes(ScanBoard(WithHalo(1e-5), 3)), one);
  EXPECT_NE(FrameBytes(ScanBoard(WithHalo(0.0), 3)), one);
}

TEST(HaloInFrames, IsExplainedAsItIsScanned) {
  Simulator simulator(BoardBeforeAWall(), MakeRaster(8.0, 8.0, 0.05), BoardMaterials(),
                      WithHalo(1e-6), 0);
  const Frame frame = FrameBy(simulator);
  std::size_t num_checked = 0;
  for (std::uint32_t firing = 80 * 160; firing < 80 * 160 + 160; firing += 2) {
    const FiringStory story = simulator.Explain(0, firing);
    const bool is_halo = frame.label[story.slot] == kHaloLabel;
    num_checked += is_halo ? 1 : 0;
    bool is_told = false;
    for (const FiringStory::Echo& echo : story.echoes) {
      is_told = is_told || (echo.label == kHaloLabel && echo.slot == story.slot);
    }
    EXPECT_EQ(is_told, is_halo) << firing;
  }
  EXPECT_GT(num_checked, 2U);
}

// A small board before a wall, 2.2 m apart, in a sensor with wide beams and two returns.
struct Pair {
  double range_m[2];
  double power_ratio[2];  ///< As it arrives.
};

std::vector<Pair> PairsBeforeAWall(std::optional<double> saturation_power_ratio) {
  const auto world = WorldOfParts({{MakeWall(kBoard_m + 2.2F, 100.0F), kPlainWall, kWallLabel},
                                   {MakeWall(kBoard_m, 0.5F), kSheeting, kBoardLabel}});
  SimulatorSpec spec{.detector = {.effects = {.surface_response = true,
                                              .detection = true,
                                              .saturation = true,
                                              .footprint = true}}};
  spec.detector.beam.divergence_mrad = {6.0, 6.0};
  spec.detector.receiver.return_mode = ReturnMode::kDual;
  spec.detector.receiver.saturation_power_ratio = saturation_power_ratio;
  const Frame frame =
      FrameBy(Simulator(world, MakeRaster(4.0, 4.0, 0.05), BoardMaterials(), spec, 0));
  std::vector<Pair> pairs;
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += 2) {
    if (frame.return_count[slot] != 2) continue;
    Pair pair{};
    for (std::size_t i = 0; i < 2; ++i) {
      const auto range_m = static_cast<double>(frame.range_m[slot + i]);
      pair.range_m[i] = range_m;
      pair.power_ratio[i] =
          static_cast<double>(frame.intensity[slot + i]) / (range_m * range_m) / 2.5e-6;
    }
    pairs.push_back(pair);
  }
  return pairs;
}

// The gap between two pulses of peaks p1 and p2 over the threshold, as long as they touch.
double TouchingGap_m(const Pair& pair) {
  constexpr double kSigma_m = 0.31827;  // Of a pulse of 5 ns.
  return kSigma_m * (std::sqrt(2.0 * std::log(pair.power_ratio[0])) +
                     std::sqrt(2.0 * std::log(pair.power_ratio[1])));
}

TEST(SaturationInFrames, HidesTheWallBehindABoardWhereTheirPulsesTouch) {
  const auto hidden_in = [](const std::vector<Pair>& pairs) {
    return std::count_if(pairs.begin(), pairs.end(), [](const Pair& pair) {
      const double gap_m = std::abs(pair.range_m[1] - pair.range_m[0]);
      return gap_m < TouchingGap_m(pair) - 0.01;
    });
  };
  const std::vector<Pair> linear = PairsBeforeAWall({});
  const std::vector<Pair> saturated = PairsBeforeAWall(1000.0);
  EXPECT_GT(hidden_in(linear), 50);
  EXPECT_EQ(hidden_in(saturated), 0);
  // Those that do not touch stay.
  EXPECT_GT(saturated.size(), 50U);
  EXPECT_NEAR(static_cast<double>(linear.size() - saturated.size()),
              static_cast<double>(hidden_in(linear)), 5.0);
}

SimulatorSpec WithDirt(std::uint64_t seed) {
  SimulatorSpec spec{.detector = {.seed = seed, .effects = {.detection = true, .cover = true}}};
  spec.detector.cover.dirt_coverage = 0.2;
  spec.detector.cover.dirt_diameter_mm = 10.0;
  return spec;
}

// A wall of 50 % at 440 m is 2 % above the threshold where a beam meets it head-on, so that it is
// lost to every beam that a spot touches by more than 1 % of its aperture.
TEST(CoverInFrames, LeavesTheBeamsThatNoSpotTouches) {
  const auto world = WorldOfParts({{MakeWall(440.0F, 100.0F), 2, kWallLabel}});
  const ScanPattern pattern = MakeRaster(8.0, 8.0, 0.5);
  double returned = 0.0;
  double square = 0.0;
  constexpr int kNumWindows = 200;
  for (std::uint64_t seed = 1; seed <= kNumWindows; ++seed) {
    SimulatorSpec spec = WithDirt(seed);
    spec.detector.range_max_m = 1000.0;
    const Frame frame = ScanOnce(world, pattern, spec);
    double share = 0.0;
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      ASSERT_TRUE(frame.outcome[slot] == Outcome::kReturned ||
                  frame.outcome[slot] == Outcome::kCoverBlocked);
      EXPECT_EQ(frame.label[slot], kWallLabel);
      const bool is_returned = frame.outcome[slot] == Outcome::kReturned;
      share += is_returned ? 1.0 / static_cast<double>(frame.num_slots()) : 0.0;
    }
    returned += share / kNumWindows;
    square += share * share / kNumWindows;
  }
  const double error = std::sqrt((square - returned * returned) / kNumWindows);
  // A spot covers less than 1 % of the aperture up to 0.28 mm inside its rim: the beams that keep
  // 2 % to spare are a few more than the untouched ones.
  const double least = std::pow(0.8, 4.0);
  const double most = std::pow(0.8, 4.0 * std::pow(9.5 / 10.0, 2));
  EXPECT_GT(returned, least - 4.0 * error);
  EXPECT_LT(returned, most + 4.0 * error);
  EXPECT_LT(error, 0.04);
}

TEST(CoverInFrames, BlocksTheSameBeamsInEveryFrame) {
  const auto world = WorldOfParts({{MakeWall(440.0F, 2000.0F), 2, kWallLabel}});
  SimulatorSpec spec = WithDirt(1);
  spec.detector.range_max_m = 1000.0;
  const ScanPattern pattern = MakeRaster(40.0, 40.0, 0.5);
  const Frame first = ScanOnce(world, pattern, spec);
  const Frame later = ScanOnce(world, pattern, spec, 1000);
  EXPECT_EQ(first.outcome, later.outcome);
  spec.detector.cover.drop_coverage = 0.1;
  const Frame in_rain = ScanOnce(world, pattern, spec);
  const Frame soon = ScanOnce(world, pattern, spec, 5);  // A tenth of a drop's life later.
  const Frame much_later = ScanOnce(world, pattern, spec, 1000);
  const auto num_changed = [](const Frame& a, const Frame& b) {
    std::size_t num = 0;
    for (std::size_t slot = 0; slot < a.num_slots(); ++slot) {
      num += a.outcome[slot] != b.outcome[slot] ? 1 : 0;
    }
    return num;
  };
  EXPECT_GT(num_changed(in_rain, first), 0U);
  EXPECT_GT(num_changed(in_rain, much_later), 2 * num_changed(in_rain, soon));
}

}  // namespace
}  // namespace railcast
