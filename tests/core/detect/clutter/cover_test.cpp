#include "core/detect/clutter/cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "core/base/random.h"
#include "tests/core/detect/facing_beams.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

constexpr double kPi = std::numbers::pi;

/// A window with spots of one kind.
CoverSpec Dirty(double coverage, double diameter_mm) {
  return {.dirt_coverage = coverage, .dirt_diameter_mm = diameter_mm};
}

/// 2000 directions all around, which see parts of the window that hardly overlap.
ScanPattern AllAround() {
  SpinningSpec spec;
  spec.cycle_us = 1000.0;
  spec.columns = 100;
  for (int row = 0; row < 20; ++row) {
    // Equal steps of the sine cover equal areas.
    const double elevation_deg = std::asin((row + 0.5) / 10.0 - 1.0) * 180.0 / kPi;
    spec.channels.push_back({.elevation_deg = elevation_deg});
  }
  return BuildScanPattern({.rate_hz = 10.0, .pattern = spec});
}

/// The shares of the aperture that stay free in every direction, for many windows.
std::vector<std::vector<double>> FreeShares(const CoverSpec& cover, std::uint32_t num_windows) {
  static const ScanPattern pattern = AllAround();
  std::vector<std::vector<double>> shares(num_windows);
  for (std::uint32_t window = 0; window < num_windows; ++window) {
    const Cover spots({.seed = window + 1, .cover = cover}, pattern);
    Cover::Drops drops;
    DetectTile tile;
    tile.frame = 0;
    for (std::uint32_t begin = 0; begin < pattern.num_firings(); begin += kTileSize) {
      tile.num_rays = std::min<std::size_t>(kTileSize, pattern.num_firings() - begin);
      for (std::uint32_t i = 0; i < tile.num_rays; ++i) {
        tile.firing[i] = begin + i;
        tile.direction_x[i] = pattern.direction_x[begin + i];
        tile.direction_y[i] = pattern.direction_y[begin + i];
        tile.direction_z[i] = pattern.direction_z[begin + i];
      }
      spots.Fill(tile, drops);
      for (std::size_t i = 0; i < tile.num_rays; ++i) {
        shares[window].push_back(std::sqrt(static_cast<double>(tile.cover[i])));
      }
    }
  }
  return shares;
}

/// Expects the mean of `value` over all windows to be `expected`, within four standard errors as
/// the windows' own means scatter.
void ExpectMean(const std::vector<std::vector<double>>& shares,
                const std::function<double(double)>& value,
                double expected) {
  std::vector<double> means;
  double sum = 0.0;
  for (const std::vector<double>& window : shares) {
    double mean = 0.0;
    for (const double share : window) mean += value(share) / static_cast<double>(window.size());
    means.push_back(mean);
    sum += mean;
  }
  const auto n = static_cast<double>(means.size());
  double square = 0.0;
  for (const double mean : means) square += std::pow(mean - sum / n, 2);
  const double error = std::sqrt(square / (n - 1.0) / n);
  EXPECT_LT(error, 0.02);
  EXPECT_NEAR(sum / n, expected, 4.0 * error);
}

// Counts the points of a fine grid that are in both discs.
TEST(CoveredShare, IsTheCommonAreaOfTwoDiscs) {
  const auto counted = [](double distance, double disc, double cover) {
    constexpr int kHalf = 400;
    int in_disc = 0;
    int in_both = 0;
    for (int i = -kHalf; i < kHalf; ++i) {
      for (int k = -kHalf; k < kHalf; ++k) {
        const double x = disc * (i + 0.5) / kHalf;
        const double y = disc * (k + 0.5) / kHalf;
        if (std::hypot(x, y) > disc) continue;
        ++in_disc;
        in_both += std::hypot(x - distance, y) <= cover ? 1 : 0;
      }
    }
    return static_cast<double>(in_both) / in_disc;
  };
  for (const double distance : {0.001, 0.02, 0.05, 0.08, 0.11, 0.14, 0.2}) {
    for (const double cover : {0.03, 0.1, 0.15}) {
      const float share =
          CoveredShare(static_cast<float>(distance), 0.1F, static_cast<float>(cover));
      // 800 lines, each with an end that is off by half a step: 1 / (800 sqrt(800)) and more.
      EXPECT_NEAR(static_cast<double>(share), counted(distance, 0.1, cover), 5e-4)
          << distance << " " << cover;
    }
  }
}

TEST(CoveredShare, IsAllOrNothingWhereTheDiscsDoNotCut) {
  EXPECT_EQ(CoveredShare(0.3F, 0.1F, 0.2F), 0.0F);
  EXPECT_EQ(CoveredShare(0.05F, 0.1F, 0.2F), 1.0F);
  EXPECT_EQ(CoveredShare(0.0F, 0.1F, 0.1F), 1.0F);
  EXPECT_EQ(CoveredShare(0.02F, 0.1F, 0.05F), 0.25F);
}

TEST(Cover, LeavesTheShareOfTheApertureThatIsNotCoveredWhateverTheSizeOfSpots) {
  for (const double diameter_mm : {2.0, 10.0, 20.0}) {
    ExpectMean(
        FreeShares(Dirty(0.3, diameter_mm), 30), [](double f) { return f; }, 0.7);
  }
}

// With n spots per area: E[f^2] = exp(-n int (2 a - a^2) dA), a the share that a spot covers.
TEST(Cover, LeavesTheMeanPowerOfTheClosedForm) {
  for (const double diameter_mm : {2.0, 6.0, 20.0}) {
    const double spot = 0.5 * diameter_mm;
    const double per_mm2 = -std::log(0.7) / (kPi * spot * spot);
    constexpr double kStep_mm = 0.01;
    double exponent = 0.0;
    for (double t_mm = 0.5 * kStep_mm; t_mm < spot + 5.0; t_mm += kStep_mm) {
      const auto a = static_cast<double>(
          CoveredShare(static_cast<float>(t_mm), 5.0F, static_cast<float>(spot)));
      exponent += (2.0 * a - a * a) * 2.0 * kPi * t_mm * kStep_mm;
    }
    ExpectMean(
        FreeShares(Dirty(0.3, diameter_mm), 30), [](double f) { return f * f; },
        std::exp(-per_mm2 * exponent));
  }
}

TEST(Cover, LeavesTheShareOfBeamsUntouchedThatNoSpotReaches) {
  for (const double diameter_mm : {2.0, 6.0, 20.0}) {
    const double expected = UntouchedShare(Dirty(0.1, diameter_mm));
    EXPECT_NEAR(expected, std::pow(0.9, std::pow(1.0 + 10.0 / diameter_mm, 2)), 1e-12);
    ExpectMean(
        FreeShares(Dirty(0.1, diameter_mm), 30), [](double f) { return f == 1.0 ? 1.0 : 0.0; },
        expected);
  }
}

// A spot of radius b blocks all beams of radius a whose centre is within b - a of its own.
TEST(Cover, BlocksTheBeamsThatALargeSpotHides) {
  ExpectMean(
      FreeShares(Dirty(0.3, 20.0), 30), [](double f) { return f == 0.0 ? 1.0 : 0.0; },
      1.0 - std::pow(0.7, 0.25));
}

TEST(Cover, AddsUpItsKinds) {
  const CoverSpec all{.drop_coverage = 0.2, .dirt_coverage = 0.1, .snow_coverage = 0.3};
  ExpectMean(
      FreeShares(all, 30), [](double f) { return f; }, 0.8 * 0.9 * 0.7);
}

// A drop is still there after the time t with the probability 1 - t / lifetime. Until then, what it
// leaves free stays correlated with what it left before. For weak coverage the logarithm of the
// free share is a sum over the spots, whose covariance has exactly that factor.
TEST(Cover, ReplacesDropsAtTheRateOfTheirLifetime) {
  const CoverSpec spec{.drop_coverage = 0.02, .drop_diameter_mm = 6.0, .drop_lifetime_s = 4.0};
  const ScanPattern pattern = AllAround();
  constexpr int kNumWindows = 60;
  for (const double later_s : {0.0, 1.0, 3.0, 4.0, 9.0}) {
    std::vector<double> ratios;
    for (std::uint64_t seed = 1; seed <= kNumWindows; ++seed) {
      const Cover cover({.seed = seed, .cover = spec}, pattern);
      const SpotLayer now = cover.DropsAt(100.0);
      const SpotLayer then = cover.DropsAt(100.0 + later_s);
      double same = 0.0;
      double before = 0.0;
      for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
        const SpotLayer::Center direction{pattern.direction_x[i], pattern.direction_y[i],
                                          pattern.direction_z[i]};
        const double a = static_cast<double>(now.FreeShare(direction)) - 0.98;
        const double b = static_cast<double>(then.FreeShare(direction)) - 0.98;
        same += a * b;
        before += a * a;
      }
      ratios.push_back(same / before);
    }
    double mean = 0.0;
    double square = 0.0;
    for (const double ratio : ratios) mean += ratio / kNumWindows;
    for (const double ratio : ratios) square += std::pow(ratio - mean, 2);
    const double error = std::sqrt(square / (kNumWindows - 1.0) / kNumWindows);
    EXPECT_LT(error, 0.02);
    // Where spots overlap, products of three and four add to the covariance: of the order of the
    // coverage.
    EXPECT_NEAR(mean, std::max(0.0, 1.0 - later_s / 4.0), 4.0 * error + 0.02) << later_s;
  }
}

TEST(Cover, IsAnotherOneForAnotherSeedAndTheSameInEveryFrame) {
  const ScanPattern pattern = MakeRaster(16.0, 16.0, 1.0);
  const DetectorSpec spec{.seed = 1, .cover = Dirty(0.3, 3.0)};
  const auto covers = [&](const DetectorSpec& of, std::uint32_t frame) {
    DetectTile tile;
    tile.num_rays = kTileSize;
    tile.frame = frame;
    for (std::uint32_t i = 0; i < kTileSize; ++i) tile.firing[i] = i;
    Cover::Drops drops;
    Cover(of, pattern).Fill(tile, drops);
    return std::vector<float>(tile.cover, tile.cover + kTileSize);
  };
  EXPECT_EQ(covers(spec, 0), covers(spec, 1'000'000));
  EXPECT_NE(covers(spec, 0), covers({.seed = 2, .cover = Dirty(0.3, 3.0)}, 0));
}

// A beam of which T remains loses what is above the threshold by less than 1 / T.
TEST(CoverLoss, IsToBlameForEchoesThatACleanWindowWouldLetThrough) {
  FacingBeams beams{.num_firings = kTileSize};
  // The reference surface of 10 % is just detected at 200 m, one of 50 % at 447.2 m.
  beams.range_m = [](std::uint32_t firing) { return 10.0 + 3.0 * firing; };
  EchoTiles echoes;
  FillHits(beams, 0, echoes);
  std::fill_n(echoes.first.cover, kTileSize, 0.25F);
  const DetectorSpec spec{.range_max_m = 1000.0,
                          .effects = {.detection = true, .cover = true},
                          .cover = Dirty(0.5, 2.0)};
  const Detector detector(spec);
  detector.Respond(echoes.first);
  const auto rays = std::make_unique<RayTile>();  // No fog looks at them.
  detector.Detect({*rays, Transform::Identity()}, echoes);
  for (std::size_t i = 0; i < kTileSize; ++i) {
    const double range_m = 10.0 + 3.0 * static_cast<double>(i);
    const Outcome expected = range_m < 223.6   ? Outcome::kReturned
                             : range_m < 447.2 ? Outcome::kCoverBlocked
                                               : Outcome::kBelowThreshold;
    EXPECT_EQ(static_cast<Outcome>(echoes.first.outcome[i]), expected) << range_m;
  }
}

}  // namespace
}  // namespace railcast
