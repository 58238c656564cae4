#include "core/rail/track/track_structure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/rail/track/cross_section.h"
#include "tests/core/rail/test_line.h"

namespace railcast {
namespace {

constexpr int kChunk = 2;

Mesh BallastOf(const TestLine& line) {
  Chunk chunk;
  AddBallast(line.Context(kChunk), chunk);
  return MeshOfSurface(chunk, line.surfaces().ballast);
}

struct Heights {
  int count{};
  double mean_m{};
  double sigma_m{};
};

/// Heights of the mesh's vertices at (s, d) selected by `includes`, on a straight from west to
/// east.
Heights HeightsWhere(const TestLine& line, const std::function<bool(double, double)>& includes) {
  Heights heights;
  double sum_of_squares = 0.0;
  for (const Eigen::Vector3f& vertex : BallastOf(line).vertices) {
    const Vector3 world_m = line.WorldFromChunk(kChunk) * vertex.cast<double>();
    if (!includes(world_m.x(), world_m.y())) continue;
    ++heights.count;
    heights.mean_m += world_m.z();
    sum_of_squares += world_m.z() * world_m.z();
  }
  heights.mean_m /= heights.count;
  heights.sigma_m = std::sqrt(sum_of_squares / heights.count - heights.mean_m * heights.mean_m);
  return heights;
}

double DistanceToASleeper(double s_m) {
  return std::abs(std::remainder(s_m, kSleeperSpacing_m));
}

TEST(AddBallast, LiesTwentyMillimetresBelowTheSleepersTopWithItsGrain) {
  const TestLine line(StraightLine(300.0));
  // In the cribs, between the level part of the top and the shoulder.
  const Heights heights = HeightsWhere(line, [](double s_m, double d_m) {
    return DistanceToASleeper(s_m) > 0.19 && std::abs(d_m) > 0.62 && std::abs(d_m) < 1.74;
  });
  ASSERT_GT(heights.count, 1000);
  const double five_errors_m = 5.0 * 0.020 / std::sqrt(heights.count);
  EXPECT_NEAR(heights.mean_m, SeatOf(SleeperType::kConcrete).top_m - 0.020, five_errors_m);
  EXPECT_NEAR(heights.sigma_m, 0.020, five_errors_m / std::sqrt(2.0));
}

TEST(AddBallast, LeavesSleepersUncovered) {
  const TestLine line(StraightLine(300.0));
  const Heights heights = HeightsWhere(line, [](double s_m, double d_m) {
    return DistanceToASleeper(s_m) < 0.01 && std::abs(d_m) > 0.62 && std::abs(d_m) < 1.3;
  });
  EXPECT_NEAR(heights.mean_m, SeatOf(SleeperType::kConcrete).top_m - 0.040,
              5.0 * 0.020 / std::sqrt(heights.count));
}

TEST(AddBallast, EndsNearerOnANarrowerGauge) {
  WorldSpec spec = StraightLine(300.0);
  spec.alignment.gauge_mm = 1000.0;
  const TestLine narrow(spec);
  const TestLine standard(StraightLine(300.0));
  const auto mean_at = [](const TestLine& line, double column_d_m) {
    return HeightsWhere(
        line, [=](double, double d_m) { return std::abs(std::abs(d_m) - column_d_m) < 0.01; });
  };
  // Columns on both slopes, whose shoulders are 0.2175 m apart.
  const Heights inner = mean_at(narrow, 1.92);
  const Heights outer = mean_at(standard, 1.92);
  EXPECT_NEAR(outer.mean_m - inner.mean_m, 0.2175 / 1.5,
              5.0 * 0.020 * std::sqrt(1.0 / inner.count + 1.0 / outer.count));
}

TEST(AddBallast, FallsOneToOneAndAHalfBeyondTheShoulder) {
  const TestLine line(StraightLine(300.0));
  const auto mean_at_column = [&](double column_d_m) {
    return HeightsWhere(
               line,
               [=](double, double d_m) { return std::abs(std::abs(d_m) - column_d_m) < 0.01; })
        .mean_m;
  };
  // Two columns of the 0.16 m grid on the slope.
  const double slope = (mean_at_column(2.40) - mean_at_column(1.92)) / 0.48;
  EXPECT_NEAR(slope, -1.0 / 1.5, 5.0 * 0.020 * std::sqrt(2.0 / 500.0) / 0.48);
}

TEST(AddBallast, IsOneSheetThatFacesUpUnderTwoTracks) {
  WorldSpec spec = CantedArc(300.0, 500.0);
  spec.tracks.push_back(spec.tracks[0]);
  spec.tracks[1].name = "second";
  spec.tracks[1].offset_m = 4.0;
  const TestLine line(spec);
  const Mesh ballast = BallastOf(line);
  double plan_area_m2 = 0.0;
  for (const auto& [a, b, c] : ballast.triangles) {
    const Vector3 normal = (ballast.vertices[b] - ballast.vertices[a])
                               .cast<double>()
                               .cross((ballast.vertices[c] - ballast.vertices[a]).cast<double>());
    EXPECT_GT(normal.z(), 0.0);
    plan_area_m2 += 0.5 * normal.z();
  }
  // 7.5 m from shoulder to shoulder, and slopes of about 0.9 to 1.5 m on either side, without
  // overlap.
  EXPECT_GT(plan_area_m2, 50.0 * 9.3);
  EXPECT_LT(plan_area_m2, 50.0 * 10.5);
}

TEST(AddBallast, StaysWithinItsBudgetOfTriangles) {
  EXPECT_LE(BallastOf(TestLine(StraightLine(300.0))).triangles.size(), 20000U);
}

}  // namespace
}  // namespace railcast
