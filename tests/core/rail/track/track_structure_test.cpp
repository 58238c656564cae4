#include "core/rail/track/track_structure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "core/rail/line/rail_section.h"
#include "core/rail/track/cross_section.h"
#include "tests/core/rail/model_checks.h"
#include "tests/core/rail/test_line.h"

namespace railcast {
namespace {

/// Intersection of the edge a-b with the plane in which coordinate `axis` is `value`.
std::optional<Vector3> CutEdge(const Vector3& a, const Vector3& b, int axis, double value) {
  if ((a[axis] < value) == (b[axis] < value)) return std::nullopt;
  return a + (value - a[axis]) / (b[axis] - a[axis]) * (b - a);
}

/// Gauge of the triangle mesh: distance between the inner faces of the rails at chainage `s_m`, 14
/// mm below top of rail.
double GaugeOfMesh(const TestLine& line, int chunk_index, double s_m) {
  Chunk chunk;
  AddTracks(line.Context(chunk_index), line.models(), chunk);
  Mesh rails = MeshOfSurface(chunk, line.surfaces().rail_side);
  rails.Append(MeshOfSurface(chunk, line.surfaces().rail_head));
  const Transform track_from_chunk =
      line.alignment().WorldFromTrack(s_m).inverse() * line.WorldFromChunk(chunk_index);
  double left_m = 1.0;
  double right_m = -1.0;
  for (const auto& triangle : rails.triangles) {
    std::vector<Vector3> cut;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3 a = track_from_chunk * rails.vertices[triangle[i]].cast<double>();
      const Vector3 b = track_from_chunk * rails.vertices[triangle[(i + 1) % 3]].cast<double>();
      if (const auto point = CutEdge(a, b, 0, 0.0)) cut.push_back(*point);
    }
    if (cut.size() != 2) continue;
    const auto point = CutEdge(cut[0], cut[1], 2, -kGaugeDepth_m);
    if (!point) continue;
    if (point->y() > 0.0) left_m = std::min(left_m, point->y());
    if (point->y() < 0.0) right_m = std::max(right_m, point->y());
  }
  return left_m - right_m;
}

TEST(AddTracks, LaysRailsAtGaugeOnAStraight) {
  const TestLine line(StraightLine(300.0));
  for (const double s_m : {100.4, 113.77, 149.3}) {
    EXPECT_NEAR(GaugeOfMesh(line, 2, s_m), kGauge_m, 0.01e-3) << s_m;
  }
}

TEST(AddTracks, LaysRailsAtGaugeInACantedCurve) {
  const TestLine line(CantedArc(300.0, -300.0));
  // 150 mm of cant over 1.5 m between rail heads.
  ASSERT_NEAR(line.alignment().At(120.0).cant_rad, 0.1, 0.002);
  // Chords of both rails deviate from their arcs by up to 1 mm to the same side; the cutting plane
  // is perpendicular to the arc, not to the chord.
  for (const double s_m : {100.4, 113.77, 149.3}) {
    EXPECT_NEAR(GaugeOfMesh(line, 2, s_m), kGauge_m, 0.1e-3) << s_m;
  }
}

TEST(AddTracks, LaysRailsAtTheGaugeOfTheLine) {
  for (const double gauge_mm : {600.0, 1000.0, 1668.0}) {
    WorldSpec spec = CantedArc(300.0, -300.0);
    spec.alignment.gauge_mm = gauge_mm;
    const TestLine line(spec);
    EXPECT_NEAR(GaugeOfMesh(line, 2, 113.77), 1e-3 * gauge_mm, 0.1e-3) << gauge_mm;
    // Rails stay on their seats, and sleepers are as much longer than the gauge as B70 are.
    for (const auto& model : {line.models().concrete_sleeper, line.models().wood_sleeper}) {
      EXPECT_NEAR(model->Bounds().sizes().y(), 2.6 + 1e-3 * gauge_mm - 1.435, 1e-6) << gauge_mm;
      for (const Part& part : model->parts) EXPECT_EQ(CountOpenEdges(part.mesh), 0U) << model->name;
    }
    double outermost_m = 0.0;
    for (const Part& part : line.models().concrete_sleeper->parts) {
      if (part.material != line.surfaces().fastening.material) continue;
      for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
        outermost_m = std::max(outermost_m, std::abs(static_cast<double>(vertex.y())));
      }
    }
    const double foot_m = RailFootMiddle_m().x() + RailShift_m(spec.alignment);
    EXPECT_NEAR(outermost_m, foot_m + 0.180, 2e-3) << gauge_mm;
  }
}

TEST(AddTracks, SetsASleeperEverySixtyCentimetresOfTheWholeLine) {
  const TestLine line(StraightLine(300.0));
  std::vector<double> chainages_m;
  for (int chunk_index = 0; chunk_index < 6; ++chunk_index) {
    Chunk chunk;
    AddTracks(line.Context(chunk_index), line.models(), chunk);
    for (const Placement& placement : chunk.placements) {
      EXPECT_EQ(placement.model, line.models().concrete_sleeper);
      chainages_m.push_back(
          (line.WorldFromChunk(chunk_index) * Vector3(placement.chunk_from_model.translation()))
              .x());
    }
  }
  // No chunk contains the end of the line.
  ASSERT_EQ(chainages_m.size(), 500U);
  for (std::size_t k = 0; k < chainages_m.size(); ++k) {
    EXPECT_NEAR(chainages_m[k], kSleeperSpacing_m * static_cast<double>(k), 1e-9);
  }
}

TEST(AddTracks, TiltsSleepersWithTheCant) {
  const TestLine line(CantedArc(300.0, 400.0));
  Chunk chunk;
  AddTracks(line.Context(1), line.models(), chunk);
  ASSERT_FALSE(chunk.placements.empty());
  const Eigen::Matrix3d rotation = chunk.placements[3].chunk_from_model.linear();
  // In a left curve, the right side is raised.
  EXPECT_NEAR(rotation(2, 1), std::sin(line.alignment().At(60.0).cant_rad), 1e-9);
  EXPECT_LT(rotation(2, 1), -0.09);
}

TEST(AddTracks, ClosesRailsWhereTheTrackBeginsAndEnds) {
  WorldSpec spec = CantedArc(300.0, 400.0);
  spec.tracks[0].start_s_m = 57.3;
  spec.tracks[0].end_s_m = 92.1;
  const TestLine line(spec);
  Chunk chunk;
  AddTracks(line.Context(1), line.models(), chunk);
  Mesh rails = MeshOfSurface(chunk, line.surfaces().rail_side);
  EXPECT_GT(CountOpenEdges(rails), 0U);
  rails.Append(MeshOfSurface(chunk, line.surfaces().rail_head));
  EXPECT_EQ(CountOpenEdges(rails), 0U);

  Chunk next;
  AddTracks(line.Context(2), line.models(), next);
  EXPECT_TRUE(next.ground.parts.empty());
  EXPECT_TRUE(next.placements.empty());
}

TEST(AddTracks, MakesOnlyClosedSleepers) {
  const TestLine line(StraightLine(100.0));
  for (const auto& model : {line.models().concrete_sleeper, line.models().wood_sleeper}) {
    for (const Part& part : model->parts) EXPECT_EQ(CountOpenEdges(part.mesh), 0U) << model->name;
  }
}

TEST(AddTracks, RestsRailsOnTheirSeats) {
  const TestLine line(StraightLine(100.0));
  const Eigen::AlignedBox3d concrete = line.models().concrete_sleeper->Bounds();
  EXPECT_NEAR(concrete.sizes().y(), 2.6, 1e-6);
  EXPECT_NEAR(concrete.sizes().x(), 0.3, 1e-6);
  // Fastenings reach 0.1 m above the seat, which is 10 mm below the foot.
  EXPECT_NEAR(concrete.max().z(), RailFootMiddle_m().y() - 0.010 + 0.100, 5e-3);
  EXPECT_NEAR(SeatOf(SleeperType::kConcrete).top_m, RailFootMiddle_m().y() - 0.010, 0.2e-3);
  EXPECT_NEAR(line.models().wood_sleeper->Bounds().min().z(), -0.190 - 0.160, 1e-6);
}

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

TEST(AddBallast, LiesAndSpreadsAsTheWorldSays) {
  WorldSpec spec = StraightLine(300.0);
  spec.ballast = {.below_sleepers_m = -0.015, .grain_sigma_m = 0.008};
  const Heights heights = HeightsWhere(TestLine(spec), [](double s_m, double d_m) {
    return DistanceToASleeper(s_m) > 0.19 && std::abs(d_m) > 0.62 && std::abs(d_m) < 1.74;
  });
  const double five_errors_m = 5.0 * 0.008 / std::sqrt(heights.count);
  EXPECT_NEAR(heights.mean_m, SeatOf(SleeperType::kConcrete).top_m + 0.015, five_errors_m);
  EXPECT_NEAR(heights.sigma_m, 0.008, five_errors_m / std::sqrt(2.0));
}

TEST(AddBallast, LiesOutsideTheRailsAndFillsBesideThemAsTheWorldSays) {
  WorldSpec spec = StraightLine(300.0);
  spec.ballast = {.outside_below_sleepers_m = -0.030, .shoulder_m = 1.2, .grain_sigma_m = 0.0};
  const TestLine line(spec);
  const auto mean_m = [&](double least_m, double most_m) {
    return HeightsWhere(line,
                        [=](double s_m, double d_m) {
                          return DistanceToASleeper(s_m) > 0.19 && std::abs(d_m) > least_m &&
                                 std::abs(d_m) < most_m;
                        })
        .mean_m;
  };
  const double sleeper_m = SeatOf(SleeperType::kConcrete).top_m;
  EXPECT_NEAR(mean_m(0.62, 0.74), sleeper_m - 0.020, 1e-4);
  EXPECT_NEAR(mean_m(0.92, 2.4), sleeper_m + 0.030, 1e-4);  // The shoulder ends at 2.5 m.
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
