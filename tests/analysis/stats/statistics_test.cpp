#include "analysis/stats/statistics.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analysis/stats/bins.h"
#include "core/base/error.h"
#include "tests/analysis/held_recording.h"
#include "tests/analysis/recorded_frames.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

std::vector<RecordedFrame> NoisyFrames(std::uint32_t num) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {{MakeFloor(-2.0F, 100.0F), 2, 1}, {MakeWall(30.0F, 10.0F), 3, 2}};
  SimulatorSpec spec{
      .detector = {.effects = {.threshold = true, .noise = true, .sensor_dropout = true}}};
  spec.detector.plausibility.dropout_probability = 0.1;
  std::vector<RecordedFrame> frames;
  for (std::uint32_t index = 0; index < num; ++index) {
    frames.push_back(Record(ScanOnce(world, MakeRaster(30.0, 20.0, 0.5), spec, index)));
  }
  return frames;
}

void ExpectSame(const Estimate& a, const Estimate& b) {
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.low, b.low);
  EXPECT_EQ(a.high, b.high);
  EXPECT_EQ(a.num, b.num);
}

Statistics Measure(std::vector<RecordedFrame> frames, std::size_t num_threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, num_threads);
  HeldRecording recording(std::move(frames));
  return MeasureStatistics(recording, [](std::size_t) {});
}

TEST(StatisticsReport, SaysThatDropoutIsUnknownWithoutACertainGrid) {
  const auto facts_of = [](bool is_grid) {
    std::vector<RecordedFrame> frames = NoisyFrames(1);
    frames[0].is_grid = is_grid;
    frames[0].fields.erase("outcome");
    const auto report = MakeStatisticsReport(Measure(std::move(frames), 1), {{}}, "");
    return report.facts;
  };
  const std::pair<std::string, std::string> unknown = {
      "Dropout", "unknown: where the sensor fired without a return cannot be told for certain"};
  EXPECT_EQ(std::ranges::count(facts_of(false), unknown), 1);
  EXPECT_EQ(std::ranges::count(facts_of(true), unknown), 0);
}

TEST(Statistics, AreTheSameAtAnyNumberOfThreads) {
  const Statistics one = Measure(NoisyFrames(7), 1);
  const Statistics two = Measure(NoisyFrames(7), 2);
  ExpectSame(one.dropout.Share(), two.dropout.Share());
  ASSERT_EQ(one.coverage.num_frames(), 7U);
  EXPECT_EQ(one.temporal_noise.num_pairs(), 3U);
  int num_compared = 0;
  for (std::size_t i = 0; i < one.noise.truth().size(); ++i) {
    const Estimate bias_m = one.noise.truth()[i].plain.Mean();
    if (!bias_m.is_enough()) continue;
    ExpectSame(bias_m, two.noise.truth()[i].plain.Mean());
    ++num_compared;
  }
  EXPECT_GT(num_compared, 2);
  const std::size_t wall = RangeBins().Find(31.0).value();
  ASSERT_TRUE(one.noise.planes()[wall].RangeSigma_m().is_enough());
  ExpectSame(one.noise.planes()[wall].RangeSigma_m(), two.noise.planes()[wall].RangeSigma_m());
}

TEST(Statistics, AgreeWithTheScenariosOwnNumbers) {
  const Statistics statistics = Measure(NoisyFrames(10), 2);
  // The second share is estimated from the points alone, of the same frames. The tolerance is four
  // standard errors.
  for (const Estimate& share : {statistics.dropout.Share(), statistics.holes.Share()}) {
    ASSERT_GT(share.num, 5000U);
    EXPECT_NEAR(share.value, 0.1, 4.0 * std::sqrt(0.09 / static_cast<double>(share.num)));
  }
}

TEST(Statistics, OfNoFrameHaveNoFigure) {
  const Statistics statistics = Measure({}, 2);
  EXPECT_EQ(statistics.coverage.num_frames(), 0U);
  EXPECT_FALSE(statistics.coverage.PointsPerFrame().is_enough());
  EXPECT_FALSE(statistics.dropout.Share().is_enough());
}

TEST(Statistics, OfFramesWithoutAPointHaveNoFigure) {
  std::vector<RecordedFrame> frames = NoisyFrames(2);
  for (RecordedFrame& recorded : frames) {
    Frame& frame = recorded.frame;
    for (auto* field : {&frame.x, &frame.y, &frame.z, &frame.range_m, &frame.intensity,
                        &frame.true_range_m, &frame.incidence_rad}) {
      std::fill(field->begin(), field->end(), std::nanf(""));
    }
    recorded = RecordPointsOnly(frame);
  }
  const Statistics statistics = Measure(std::move(frames), 2);
  EXPECT_EQ(statistics.coverage.num_frames(), 2U);
  EXPECT_EQ(statistics.coverage.num_points(), 0U);
  EXPECT_FALSE(statistics.holes.Share().is_enough());
  EXPECT_TRUE(statistics.density.is_empty());
  EXPECT_EQ(statistics.temporal_noise.num_pairs(), 0U);
}

TEST(Statistics, PassOnWhatAFramesReaderThrows) {
  class Damaged final : public Recording {
   public:
    [[nodiscard]] const RecordingInfo& info() const override { return info_; }
    [[nodiscard]] std::optional<FrameReader> Next() override {
      return []() -> RecordedFrame { throw InputError("frame.pcd: damaged"); };
    }

   private:
    RecordingInfo info_;
  } damaged;
  EXPECT_THROW((void)MeasureStatistics(damaged, [](std::size_t) {}), InputError);
}

}  // namespace
}  // namespace railcast
