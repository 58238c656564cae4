#include "analysis/stats/statistics.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tests/analysis/recorded_frames.h"

namespace railcast {
namespace {

/// A frame of points, each with its range in metres and its label.
RecordedFrame FrameOf(const std::vector<std::pair<float, std::uint32_t>>& points) {
  Frame frame;
  frame.Resize(1, static_cast<std::uint32_t>(points.size()), 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    frame.range_m[i] = points[i].first;
    frame.label[i] = points[i].second;
  }
  return Record(std::move(frame));
}

constexpr float kNoPoint = std::numeric_limits<float>::quiet_NaN();

ClassBalance MadeBalance() {
  ClassBalance balance;
  balance.Add(FrameOf({{9.5F, 1}, {10.0F, 1}, {10.5F, 2}, {kNoPoint, 2}, {12.0F, 1}}));
  balance.Add(FrameOf({{200.0F, 3}, {199.0F, 1}, {kNoPoint, 4}}));
  return balance;
}

Section MadeSection(const ClassBalance& balance) {
  RecordingInfo info;
  std::vector<Label> labels(2);
  labels[0].id = 1;
  labels[0].name = "rail";
  labels[1].id = 2;
  labels[1].name = "person";
  info.labels = LabelTable(labels);
  return balance.MakeSection(Names(info));
}

TEST(ClassBalance, CountsPointsAndFramesOfEachLabelTheMostFrequentFirst) {
  const Section section = MadeSection(MadeBalance());
  const Table& labels = section.tables.at(0);
  ASSERT_EQ(labels.key, "points_by_label");
  ASSERT_EQ(labels.rows.size(), 3U);
  const auto text = [&](std::size_t row) { return std::get<std::string>(labels.rows[row][0]); };
  EXPECT_EQ(text(0), "rail");
  EXPECT_EQ(text(1), "person");
  EXPECT_EQ(text(2), "3");
  EXPECT_EQ(std::get<std::uint64_t>(labels.rows[0][1]), 4U);
  EXPECT_DOUBLE_EQ(std::get<double>(labels.rows[0][2]), 400.0 / 6.0);
  EXPECT_EQ(std::get<std::uint64_t>(labels.rows[0][3]), 2U);
  EXPECT_DOUBLE_EQ(std::get<double>(labels.rows[1][4]), 50.0);
}

// Limits of bins belong to the bin above them.
TEST(ClassBalance, CountsByRangeWithSharesOfTheRange) {
  const Section section = MadeSection(MadeBalance());
  const Table& counts = section.tables.at(1);
  const Table& shares = section.tables.at(2);
  const auto count = [&](std::size_t row, std::size_t bin) {
    return std::get<std::uint64_t>(counts.rows.at(row).at(bin + 1));
  };
  const auto share = [&](std::size_t row, std::size_t bin) {
    return std::get<double>(shares.rows.at(row).at(bin + 1));
  };
  ASSERT_EQ(counts.rows.size(), 4U);
  EXPECT_EQ(counts.columns[1].key, "0_to_10_m");
  EXPECT_EQ(counts.columns.back().key, "200_m_and_more");
  EXPECT_EQ(count(0, 0), 1U);
  EXPECT_EQ(count(0, 1), 2U);
  EXPECT_EQ(count(0, 6), 1U);
  EXPECT_EQ(count(2, 7), 1U);
  EXPECT_EQ(count(3, 1), 3U);
  EXPECT_DOUBLE_EQ(share(0, 1), 200.0 / 3.0);
  EXPECT_DOUBLE_EQ(share(1, 1), 100.0 / 3.0);
  EXPECT_DOUBLE_EQ(share(2, 7), 100.0);
  EXPECT_TRUE(std::isnan(share(0, 3)));
}

TEST(ClassBalance, OfPartsIsThatOfTheWhole) {
  ClassBalance sum = MadeBalance();
  AddTo(sum, MadeBalance());
  const Section section = MadeSection(sum);
  EXPECT_EQ(std::get<std::uint64_t>(section.tables.at(0).rows.at(0).at(1)), 8U);
  EXPECT_EQ(std::get<std::uint64_t>(section.tables.at(0).rows.at(0).at(3)), 4U);
  EXPECT_EQ(section.paragraphs.at(0),
            "12 points in 4 frames with labels. Ranges are the measured ones.");
}

TEST(ClassBalance, LeavesOutFramesWithoutLabels) {
  RecordedFrame recorded = FrameOf({{5.0F, 1}});
  recorded.fields.erase("label");
  ClassBalance balance;
  balance.Add(recorded);
  EXPECT_TRUE(balance.is_empty());
}

}  // namespace
}  // namespace railcast
