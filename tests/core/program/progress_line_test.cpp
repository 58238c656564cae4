#include "core/program/progress_line.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/program/duration_histogram.h"

namespace railcast {
namespace {

TEST(DurationText, HasHoursWhereThereAreAny) {
  EXPECT_EQ(DurationText(0.0), "0:00");
  EXPECT_EQ(DurationText(4.2), "0:05");
  EXPECT_EQ(DurationText(60.0), "1:00");
  EXPECT_EQ(DurationText(499.0), "8:19");
  EXPECT_EQ(DurationText(3599.5), "1:00:00");
  EXPECT_EQ(DurationText(7505.0), "2:05:05");
}

TEST(ProgressText, EstimatesWhatIsLeftFromWhatThisRunDid) {
  EXPECT_EQ(ProgressText("pairs", 0.25, 0.0, 30.0), "25 %, pairs, about 1:30 left");
  // Half of the job was there before, so that this run did a quarter of it in 30 s.
  EXPECT_EQ(ProgressText("pairs", 0.75, 0.5, 30.0), "75 %, pairs, about 0:30 left");
  EXPECT_EQ(ProgressText("pairs", 1.0, 0.5, 60.0), "100 %, pairs, about 0:00 left");
}

TEST(ProgressText, EstimatesNothingBeforeThisRunDidAnything) {
  EXPECT_EQ(ProgressText("pairs", 0.0, 0.0, 0.1), "0 %, pairs");
  EXPECT_EQ(ProgressText("pairs", 0.5, 0.5, 3.0), "50 %, pairs");
}

/// Waits for the lines that a RegularLines prints.
class PrintedLines {
 public:
  void Add(const std::string& line) {
    const std::scoped_lock lock(mutex_);
    lines_.push_back(line);
    added_.notify_all();
  }
  std::vector<std::string> WaitFor(std::size_t num) {
    std::unique_lock lock(mutex_);
    added_.wait(lock, [&] { return lines_.size() >= num; });
    return lines_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable added_;
  std::vector<std::string> lines_;
};

TEST(RegularLines, RepeatWhatIsBeingDoneWhileASingleStepTakesLong) {
  PrintedLines printed;
  RegularLines lines(std::chrono::milliseconds(1),
                     [&](const std::string& line) { printed.Add(line); });
  lines.Show(1, "step 1 of 2");
  for (const std::string& line : printed.WaitFor(3)) {
    EXPECT_TRUE(line.starts_with("after 0:") && line.ends_with(": step 1 of 2")) << line;
  }
}

TEST(RegularLines, SayNothingBetweenTwoJobs) {
  PrintedLines printed;
  RegularLines lines(std::chrono::milliseconds(1),
                     [&](const std::string& line) { printed.Add(line); });
  lines.Show(1, "first job");
  (void)printed.WaitFor(1);
  lines.Show(1, "");
  const std::size_t num_of_first = printed.WaitFor(1).size();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  lines.Show(1, "second job");
  const std::vector<std::string> all = printed.WaitFor(num_of_first + 1);
  for (std::size_t i = num_of_first; i < all.size(); ++i) {
    EXPECT_TRUE(all[i].ends_with(": second job")) << all[i];
  }
}

TEST(RegularLines, JoinAJobWithTheOneThatItIsPartOf) {
  PrintedLines printed;
  RegularLines lines(std::chrono::milliseconds(1),
                     [&](const std::string& line) { printed.Add(line); });
  lines.Show(1, "scenario 3 of 9");
  lines.Show(2, "building the scene");
  const std::size_t num_before = printed.WaitFor(0).size();
  EXPECT_TRUE(
      printed.WaitFor(num_before + 1).back().ends_with(": scenario 3 of 9; building the scene"));
  lines.Show(2, "");
  const std::size_t num_of_both = printed.WaitFor(0).size();
  EXPECT_TRUE(printed.WaitFor(num_of_both + 1).back().ends_with(": scenario 3 of 9"));
}

TEST(RegularLines, LeaveNoLineOfAJobThatIsShorterThanAnInterval) {
  PrintedLines printed;
  {
    RegularLines lines(std::chrono::hours(1), [&](const std::string& line) { printed.Add(line); });
    lines.Show(1, "short job");
  }
  EXPECT_TRUE(printed.WaitFor(0).empty());
}

TEST(DurationHistogram, TellsQuantilesToOnePercent) {
  DurationHistogram histogram;
  for (std::int64_t i = 1; i <= 1000; ++i) histogram.Add(i * 1'000'000);
  EXPECT_EQ(histogram.count(), 1000U);
  EXPECT_EQ(histogram.max_ns(), 1'000'000'000);
  for (const double fraction : {0.01, 0.5, 0.95, 0.99}) {
    const double exact_ns = fraction * 1e9;
    EXPECT_NEAR(static_cast<double>(histogram.QuantileNs(fraction)), exact_ns, 0.0101 * exact_ns);
  }
}

TEST(DurationHistogram, NeverExceedsTheMaximum) {
  DurationHistogram histogram;
  histogram.Add(123'456'789);
  EXPECT_EQ(histogram.QuantileNs(0.5), 123'456'789);
  EXPECT_EQ(histogram.QuantileNs(1.0), 123'456'789);
}

TEST(DurationHistogram, TakesWhatIsNegativeHugeOrAbsent) {
  DurationHistogram histogram;
  EXPECT_EQ(histogram.QuantileNs(0.99), 0);
  histogram.Add(-5);
  EXPECT_EQ(histogram.QuantileNs(0.99), 0);
  histogram.Add(INT64_MAX);
  EXPECT_EQ(histogram.max_ns(), INT64_MAX);
  EXPECT_EQ(histogram.count(), 2U);
}

}  // namespace
}  // namespace railcast
