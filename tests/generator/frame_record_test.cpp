#include "generator/frame_record.h"

#include <gtest/gtest.h>

#include "tests/core/io/example_frame.h"

namespace railcast {
namespace {

TEST(CountFrame, CountsEveryFiringOnceAndEveryPoint) {
  const Frame frame = ExampleFrame(0);  // 54 slots: each of nine outcomes six times.
  const FrameCounts counts = CountFrame(frame, ExampleLabels());
  for (const std::uint64_t count : counts.outcomes) EXPECT_EQ(count, 6U);
  EXPECT_EQ(counts.points, 12U);
  std::uint64_t labelled = 0;
  for (const auto& [label, count] : counts.points_per_label) labelled += count;
  EXPECT_EQ(labelled, 12U);
}

TEST(CountFrame, CountsAFiringWithTwoReturnsOnceAndItsPointsTwice) {
  Frame frame = ExampleFrame(0, 1, 2);
  frame.columns = 1;
  frame.returns = 2;
  frame.outcome = {Outcome::kReturned, Outcome::kReturned};
  frame.label = {1, 12};
  const FrameCounts counts = CountFrame(frame, ExampleLabels());
  EXPECT_EQ(counts.outcomes[0], 1U);
  EXPECT_EQ(counts.points, 2U);
}

TEST(FrameLine, ReadsBack) {
  FrameRecord record;
  record.frame = 7;
  record.stamp_ns = 700'000'000;
  record.files = {{"frames/000007.pcd", 1234, "0123456789abcdef"}};
  record.records_hash = "fedcba9876543210";
  record.counts = CountFrame(ExampleFrame(7), ExampleLabels());
  const std::string line = FrameLine(record);
  EXPECT_EQ(ParseFrameLine(line), record);
  EXPECT_EQ(line.find('\n'), line.size() - 1);
}

TEST(ParseFrameLine, GivesNothingForATornLine) {
  const std::string line = FrameLine(FrameRecord{});
  for (std::size_t size = 0; size + 1 < line.size(); ++size) {
    EXPECT_FALSE(ParseFrameLine(line.substr(0, size)).has_value()) << size;
  }
  EXPECT_FALSE(ParseFrameLine("{\"frame\": -1}\n").has_value());
}

}  // namespace
}  // namespace railcast
