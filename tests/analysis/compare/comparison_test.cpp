#include "analysis/compare/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "analysis/compare/compare_report.h"
#include "analysis/report/formats.h"
#include "core/base/units.h"
#include "core/points/point_alignment.h"
#include "tests/analysis/compare/made_clouds.h"
#include "tests/analysis/held_recording.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pair;
using testing::StartsWith;

constexpr std::int64_t kMillisecond_ns = 1'000'000;

HeldRecording AtTimes(const std::vector<int>& stamps_ms) {
  std::vector<RecordedFrame> frames;
  for (std::size_t i = 0; i < stamps_ms.size(); ++i) {
    frames.push_back(FrameOf({{1, 0, 0}}, stamps_ms[i] * kMillisecond_ns));
    frames.back().frame.index = static_cast<std::uint32_t>(i);
  }
  return HeldRecording(std::move(frames));
}

// Indices of all pairs.
std::vector<std::pair<std::uint32_t, std::uint32_t>> AllPairs(FramePairs& pairs) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
  while (const auto pair = pairs.Next()) {
    found.emplace_back(pair->a.frame.index, pair->b.frame.index);
  }
  return found;
}

TEST(FramePairs, GoByIndexToTheShorterOnesEnd) {
  HeldRecording a = AtTimes({0, 100, 200}), b = AtTimes({7, 8});
  FramePairs pairs(a, b, Pairing::kIndex);
  EXPECT_THAT(AllPairs(pairs), ElementsAre(Pair(0, 0), Pair(1, 1)));
  EXPECT_EQ(pairs.num_alone_a(), 1U);
  EXPECT_EQ(pairs.num_alone_b(), 0U);
}

TEST(FramePairs, GoByTheNearestStamp) {
  HeldRecording a = AtTimes({0, 100, 200, 300}), b = AtTimes({90, 140, 210, 420});
  FramePairs pairs(a, b, Pairing::kStamp);
  // 0 and 300 have no partner within 50 ms; 140 is farther from 100 than 90 is.
  EXPECT_THAT(AllPairs(pairs), ElementsAre(Pair(1, 0), Pair(2, 2)));
  EXPECT_EQ(pairs.num_alone_a(), 2U);
  EXPECT_EQ(pairs.num_alone_b(), 2U);
}

TEST(FramePairs, TakeEverySecondFrameOfOneTwiceAsFast) {
  HeldRecording a = AtTimes({0, 100, 200}), b = AtTimes({0, 50, 100, 150, 200, 250});
  FramePairs pairs(a, b, std::nullopt);
  EXPECT_EQ(pairs.pairing(), Pairing::kStamp);
  EXPECT_THAT(AllPairs(pairs), ElementsAre(Pair(0, 0), Pair(1, 2), Pair(2, 4)));
  EXPECT_EQ(pairs.num_alone_b(), 3U);
}

TEST(FramePairs, GiveAFrameOfTheSlowerOneToTheNearest) {
  HeldRecording a = AtTimes({0, 50, 100, 150, 200}), b = AtTimes({55, 155});
  FramePairs pairs(a, b, Pairing::kStamp);
  EXPECT_THAT(AllPairs(pairs), ElementsAre(Pair(1, 0), Pair(3, 1)));
  EXPECT_EQ(pairs.num_alone_a(), 3U);
}

TEST(FramePairs, FindNothingBetweenClocksThatDiffer) {
  HeldRecording a = AtTimes({0, 100, 200}), b = AtTimes({9000, 9100});
  FramePairs pairs(a, b, Pairing::kStamp);
  EXPECT_THAT(AllPairs(pairs), IsEmpty());
  EXPECT_EQ(pairs.num_alone_a(), 3U);
  EXPECT_EQ(pairs.num_alone_b(), 2U);
}

TEST(FramePairs, GoByIndexWhereStampsAreMissing) {
  HeldRecording a = AtTimes({0, 100}), b = AtTimes({0, 0});
  EXPECT_EQ(FramePairs(a, b, std::nullopt).pairing(), Pairing::kIndex);
  HeldRecording single = AtTimes({5}), none = AtTimes({});
  EXPECT_EQ(FramePairs(single, none, std::nullopt).pairing(), Pairing::kIndex);
}

std::vector<RecordedFrame> NoisyPlanes(int num, double sigma_m) {
  std::vector<RecordedFrame> frames;
  for (int i = 0; i < num; ++i) {
    frames.push_back(FrameOf(WithNoise(MadePlane(-2.0F), sigma_m * (1.0 + 0.01 * i)),
                             i * 100 * kMillisecond_ns));
  }
  return frames;
}

TEST(CompareAll, TellsHowFarItIsInTheFirstRecording) {
  HeldRecording a = AtTimes({0, 100, 200, 300}), b = AtTimes({90, 140, 210, 420});
  FramePairs pairs(a, b, Pairing::kStamp);
  Comparison comparison({0.1}, false);
  PatchPairs patches;
  std::vector<std::uint64_t> done;
  CompareAll(pairs, comparison, patches, [&](std::uint64_t num) { done.push_back(num); });
  // The frame at 0 has no partner, those at 100 and 200 have one.
  EXPECT_THAT(done, ElementsAre(2, 3));
}

Report ReportOf(std::vector<RecordedFrame> frames_a,
                std::vector<RecordedFrame> frames_b,
                bool registers) {
  HeldRecording a(std::move(frames_a)), b(std::move(frames_b));
  FramePairs pairs(a, b, std::nullopt);
  Comparison comparison({0.1}, registers);
  PatchPairs patches;
  CompareAll(pairs, comparison, patches, [](std::uint64_t) {});
  return MakeCompareReport(comparison, pairs, a.info(), b.info(), "compare");
}

std::string ComparisonReportOf(std::vector<RecordedFrame> frames_a,
                               std::vector<RecordedFrame> frames_b,
                               std::size_t num_threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, num_threads);
  const Report report = ReportOf(std::move(frames_a), std::move(frames_b), false);
  for (const Section& section : report.sections) {
    for (const Table& table : section.tables) {
      for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size()) << table.key;
    }
  }
  return ReportJson(report);
}

TEST(Comparison, IsTheSameAtAnyNumberOfThreads) {
  const std::string one = ComparisonReportOf(NoisyPlanes(12, 0.05), NoisyPlanes(12, 0.1), 1);
  EXPECT_EQ(ComparisonReportOf(NoisyPlanes(12, 0.05), NoisyPlanes(12, 0.1), 2), one);
  EXPECT_EQ(ComparisonReportOf(NoisyPlanes(12, 0.05), NoisyPlanes(12, 0.1), 5), one);
  EXPECT_THAT(one, HasSubstr("\"12, by stamp\""));
}

TEST(Comparison, FindsNoDifferenceBetweenTheSame) {
  Comparison comparison({0.1});
  for (const RecordedFrame& frame : NoisyPlanes(12, 0.1)) {
    comparison.Add(comparison.Compare(frame, frame));
  }
  for (std::size_t i = 0; i < comparison.metrics().size(); ++i) {
    const bool is_share = comparison.metrics()[i].key.ends_with("_0.1_m");
    EXPECT_EQ(comparison.summaries()[i].largest, is_share ? 100.0 : 0.0)
        << comparison.metrics()[i].key;
    EXPECT_EQ(comparison.summaries()[i].moments.Mean().num, 12U) << comparison.metrics()[i].key;
  }
}

/// Points on a floor and two walls, 0.25 m apart: a corner, which no motion leaves unchanged.
std::vector<MadePoint> MadeCorner() {
  std::vector<MadePoint> points;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      const float u_m = 0.25F * static_cast<float>(i), v_m = 0.25F * static_cast<float>(j);
      points.push_back({u_m, v_m, 0.0F});
      points.push_back({10.0F, u_m, v_m});
      points.push_back({u_m, 10.0F, v_m});
    }
  }
  return points;
}

std::vector<MadePoint> Moved(std::vector<MadePoint> points, const Transform& motion) {
  for (MadePoint& point : points) {
    const Vector3 place_m = motion * Vector3(point.x, point.y, point.z);
    point.x = static_cast<float>(place_m.x());
    point.y = static_cast<float>(place_m.y());
    point.z = static_cast<float>(place_m.z());
  }
  return points;
}

double ValueOf(const Comparison& comparison, const std::vector<double>& values, const char* key) {
  const auto at = std::ranges::find(comparison.metrics(), key, &TableColumn::key);
  return values.at(static_cast<std::size_t>(at - comparison.metrics().begin()));
}

TEST(Comparison, RegistersCloudsThatAreTheSameButForAMotion) {
  const Comparison comparison({0.1}, true);
  const Vector3 shift_m(0.3, -0.2, 0.1);
  const double turn_rad = 0.02;
  const Transform motion =
      MakeTransform(Eigen::AngleAxisd(turn_rad, Vector3::UnitZ()).toRotationMatrix(), shift_m);
  const auto part = comparison.Compare(FrameOf(MadeCorner()), FrameOf(Moved(MadeCorner(), motion)));
  ASSERT_EQ(part.figures.values.size(), comparison.metrics().size());
  const auto value = [&](const char* key) { return ValueOf(comparison, part.figures.values, key); };
  // The cells of thinned clouds hold other points after the motion: places on planes are right to
  // less than a millimetre, nearest points to half a cell.
  constexpr double kTolerance_m = 0.005;
  EXPECT_NEAR(value("registration_shift_m"), shift_m.norm(), kTolerance_m);
  EXPECT_NEAR(value("registration_turn_deg"), DegFromRad(turn_rad),
              DegFromRad(kTolerance_m / 10.0));
  EXPECT_LT(value("registration_residual_m"), 0.5 * ThinnedCloud::kCell_m);
  EXPECT_LT(value("chamfer_m"), kTolerance_m);
}

TEST(Comparison, HasNoRegistrationOfAllClouds) {
  const Report report = ReportOf({FrameOf(MadeCorner())}, {FrameOf(MadeCorner())}, true);
  int num = 0;
  for (const Section& section : report.sections) {
    for (const Table& table : section.tables) {
      if (table.key != "metrics") continue;
      EXPECT_TRUE(std::isnan(std::get<double>(table.rows.back().back())));
      ++num;
    }
  }
  EXPECT_EQ(num, 1);
}

TEST(Comparison, RefusesToRegisterCloudsOfTooFewPoints) {
  RecordedFrame few = FrameOf({{1, 0, 0}});
  few.name = "few.pcd";
  EXPECT_EQ(MessageOf([&] { (void)Comparison({0.1}, true).Compare(FrameOf(MadeCorner()), few); }),
            "few.pcd: must have, like its partner, at least 100 points in cells of 0.4 m to be "
            "registered (got 0)");
}

TEST(Comparison, KeepsEveryMetricInItsPlace) {
  const Comparison comparison({0.1, 0.5});
  const RecordedFrame frame = FrameOf(MadePlane(0.0F));
  EXPECT_EQ(comparison.Compare(frame, frame).figures.values.size(), comparison.metrics().size());
  const RecordedFrame empty = FrameOf({});
  const Comparison::Part none = comparison.Compare(empty, frame);
  EXPECT_EQ(none.figures.values.size(), comparison.metrics().size());
  for (const double value : none.figures.values) EXPECT_TRUE(std::isnan(value));
}

TEST(Comparison, KnowsNoDivergenceOfFieldsThatAreMissing) {
  RecordedFrame bare = FrameOf(MadePlane(0.0F));
  bare.fields = {"x", "y", "z"};
  Comparison comparison({0.1});
  comparison.Add(comparison.Compare(bare, FrameOf(MadePlane(0.0F))));
  for (const char* const metric : {"jsd_ring", "jsd_velocity", "velocity_error_mps"}) {
    EXPECT_EQ(std::get<Estimate>(MeanOverPairs(comparison, metric)).num, 0U) << metric;
  }
  EXPECT_EQ(std::get<double>(MeanOverPairs(comparison, "jsd_range")), 0.0);
}

TEST(Comparison, ShowsVelocitiesWhereThereAreAny) {
  const auto without = [] {
    std::vector<RecordedFrame> frames = NoisyPlanes(2, 0.05);
    for (RecordedFrame& frame : frames) frame.fields.erase("radial_velocity_mps");
    return frames;
  };
  EXPECT_THAT(ComparisonReportOf(without(), without(), 1), Not(HasSubstr("velocity_by_range")));
  EXPECT_THAT(ComparisonReportOf(without(), NoisyPlanes(2, 0.05), 1),
              HasSubstr("velocity_by_range"));
}

TEST(Comparison, GivesFewPairsABareMeanAndNoInterval) {
  Comparison comparison({0.1});
  const RecordedFrame a = FrameOf(MadePlane(0.0F)), b = FrameOf(MadePlane(0.5F));
  for (int i = 0; i < 9; ++i) comparison.Add(comparison.Compare(a, b));
  EXPECT_NEAR(std::get<double>(MeanOverPairs(comparison, "chamfer_m")), 0.5, 1e-6);
  comparison.Add(comparison.Compare(a, b));
  EXPECT_NEAR(std::get<Estimate>(MeanOverPairs(comparison, "chamfer_m")).value, 0.5, 1e-6);
}

TEST(Comparison, KeepsABoundedNumberOfPairs) {
  Comparison comparison({0.1});
  const RecordedFrame point = FrameOf({{1, 0, 0}});
  Comparison::Part part = comparison.Compare(point, point);
  for (std::uint32_t i = 0; i < 9000; ++i) {
    part.figures.index_a = i;
    comparison.Add(part);
  }
  EXPECT_EQ(comparison.num_pairs(), 9000U);
  EXPECT_LT(comparison.pairs().size(), 2000U);
  EXPECT_GE(comparison.pairs().size(), 1000U);
  for (std::size_t i = 0; i < comparison.pairs().size(); ++i) {
    EXPECT_EQ(comparison.pairs()[i].index_a, i * comparison.pair_stride());
    EXPECT_EQ(comparison.pairs()[i].values.size(), comparison.metrics().size()) << i;
  }
}

// Intensities of 1/255, 2/255, ... 255/255, times `scale`, the darker the more of them.
Histogram Counted(double scale) {
  ComparedCloud cloud;
  for (int step = 1; step <= 255; ++step) {
    for (int i = 0; i < 1 + 300 / step; ++i) {
      cloud.intensity.push_back(static_cast<float>(scale * step / 255.0));
    }
  }
  return HistogramsOf(cloud).intensity;
}

// A bin is an eighth octave wide.
const double kBin = std::exp2(1.0 / 8.0);

TEST(IntensityFactor, IsTheFactorBetweenByteAndShare) {
  const auto scale = IntensityFactorOf(Counted(1.0), Counted(255.0));
  ASSERT_TRUE(scale);
  EXPECT_GT(scale->b_over_a, 255.0 / kBin);
  EXPECT_LT(scale->b_over_a, 255.0 * kBin);
  EXPECT_LT(scale->largest_left, kBin);
}

TEST(IntensityFactor, IsInverseTheOtherWayRound) {
  const auto there = IntensityFactorOf(Counted(1.0), Counted(255.0));
  const auto back = IntensityFactorOf(Counted(255.0), Counted(1.0));
  ASSERT_TRUE(there && back);
  EXPECT_NEAR(there->b_over_a * back->b_over_a, 1.0, 1e-12);
  EXPECT_NEAR(there->largest_left, back->largest_left, 1e-12);
}

TEST(IntensityFactor, IsNoneOfWhatIsAlike) {
  EXPECT_FALSE(IntensityFactorOf(Counted(1.0), Counted(1.0)));
  EXPECT_FALSE(IntensityFactorOf(Counted(1.0), Counted(1.05)));
  EXPECT_FALSE(IntensityFactorOf(Histogram(), Counted(1.0)));
}

TEST(IntensityFactor, IsNoneOfWhatIsSpreadOtherwise) {
  ComparedCloud one, wide;
  for (int i = 0; i < 100; ++i) {
    one.intensity.push_back(0.5F);
    wide.intensity.push_back(std::exp2(-0.09F * static_cast<float>(i)));
  }
  EXPECT_FALSE(IntensityFactorOf(HistogramsOf(one).intensity, HistogramsOf(wide).intensity));
}

TEST(IntensityFactor, IsSaidInOneSentence) {
  EXPECT_THAT(InWords({254.7, 1.034}),
              StartsWith("The intensities of B are those of A times 255: scaled by that, their "
                         "deciles differ by 3.4 % at most, "));
}

}  // namespace
}  // namespace railcast
