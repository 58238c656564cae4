#include "core/rail/base/noise_field.h"

#include <gtest/gtest.h>

#include <cmath>

namespace railcast {
namespace {

struct Moments {
  double mean{};
  double sigma{};
};

/// Moments over `num_cells` x `num_cells` lattice cells, with `per_cell` x `per_cell` points in
/// each.
Moments Measure(const NoiseField& field, int num_cells, int per_cell) {
  double sum = 0.0;
  double sum_of_squares = 0.0;
  const int num_points = num_cells * per_cell;
  for (int i = 0; i < num_points; ++i) {
    for (int j = 0; j < num_points; ++j) {
      const double value = field.At((i + 0.5) / per_cell - 100.0, (j + 0.5) / per_cell);
      sum += value;
      sum_of_squares += value * value;
    }
  }
  const double count = static_cast<double>(num_points) * num_points;
  return {.mean = sum / count, .sigma = std::sqrt(sum_of_squares / count)};
}

// A lattice of n points determines mean and sigma to about 1/sqrt(n) and 1/sqrt(2n); tolerances are
// five times that.
TEST(NoiseField, HasMeanZeroAndSigmaOne) {
  constexpr int kCells = 200;
  const Moments moments = Measure(NoiseField(3, RandomUse::kGroundRoughness, 0), kCells, 5);
  EXPECT_NEAR(moments.mean, 0.0, 5.0 * NoiseField::kLatticeSigma / kCells);
  EXPECT_NEAR(moments.sigma, 1.0, 5.0 * NoiseField::kLatticeSigma / (std::sqrt(2.0) * kCells));
}

TEST(NoiseField, HasTheStatedSigmaAtLatticePoints) {
  const NoiseField field(3, RandomUse::kGroundRoughness, 0);
  constexpr int kPoints = 200;
  double sum_of_squares = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    for (int j = 0; j < kPoints; ++j) {
      const double value = field.At(i, j - 50);
      sum_of_squares += value * value;
    }
  }
  EXPECT_NEAR(std::sqrt(sum_of_squares) / kPoints, NoiseField::kLatticeSigma,
              5.0 * NoiseField::kLatticeSigma / (std::sqrt(2.0) * kPoints));
}

TEST(NoiseField, IsContinuousAcrossLatticeLines) {
  const NoiseField field(3, RandomUse::kGroundRoughness, 0);
  constexpr double kStep = 1e-7;
  // The quintic has a slope of at most 15/8, and neighbours differ by at most 8.86.
  constexpr double kSteepest = 15.0 / 8.0 * 8.86;
  for (int line = -3; line <= 3; ++line) {
    EXPECT_NEAR(field.At(line - kStep, 0.4), field.At(line + kStep, 0.4), 2.0 * kStep * kSteepest);
    EXPECT_NEAR(field.At(0.4, line - kStep), field.At(0.4, line + kStep), 2.0 * kStep * kSteepest);
  }
}

TEST(NoiseField, DependsOnSeedUseAndLayer) {
  const double value = NoiseField(3, RandomUse::kGroundRoughness, 0).At(2.5, 7.5);
  EXPECT_EQ(NoiseField(3, RandomUse::kGroundRoughness, 0).At(2.5, 7.5), value);
  EXPECT_NE(NoiseField(4, RandomUse::kGroundRoughness, 0).At(2.5, 7.5), value);
  EXPECT_NE(NoiseField(3, RandomUse::kBallastRoughness, 0).At(2.5, 7.5), value);
  EXPECT_NE(NoiseField(3, RandomUse::kGroundRoughness, 1).At(2.5, 7.5), value);
}

}  // namespace
}  // namespace railcast
