#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "analysis/extras/card/dataset_overview.h"
#include "analysis/stats/statistics.h"
#include "tests/analysis/recorded_frames.h"

namespace railcast {
namespace {

DatasetOverview MadeOverview() {
  DatasetOverview overview;
  overview.source = "out/set";
  overview.num_scenarios = 4;
  DatasetReportRecord& report = overview.report;
  report.num_frames = 8;
  report.counts.points = 1000;
  report.frames_without_objects = 2;
  report.splits = {{"test", {1, 2, 100}}, {"train", {2, 4, 700}}, {"val", {1, 2, 200}}};
  report.labels = {{"ground", {400, 0.4, 8}}, {"rail", {600, 0.6, 6}}};
  TypeCountsRecord& cow = report.objects["cow"];
  cow.objects = 1;
  cow.in_frames = 2;
  cow.with_points = 1;
  cow.points = 7;
  cow.by_distance[1] = 2;
  cow.points_by_distance[1] = 7;
  cow.by_occlusion[0] = cow.by_occlusion[4] = 1;
  report.objects["person"].objects = 3;
  report.objects["person"].in_frames = 5;
  report.weathers = {{"dry", 3}, {"rain", 1}};
  report.drawn = {{"season", {{"open", 4}}}};
  report.frames_by_base = {{"line.json", 8}};
  report.frames_by_sensor = {{"VLP-16", 6}, {"HDL-32E", 2}};
  return overview;
}

const Table& TableIn(const Section& section, const std::string& key) {
  for (const Table& table : section.tables) {
    if (table.key == key) return table;
  }
  throw std::out_of_range(key);
}

std::uint64_t CountAt(const Table& table, std::size_t row, std::size_t column) {
  return std::get<std::uint64_t>(table.rows.at(row).at(column));
}

std::string NameAt(const Table& table, std::size_t row) {
  return std::get<std::string>(table.rows.at(row).at(0));
}

TEST(DatasetSection, ListsPartsInTheOrderOfTheirUseAndTypesByFrames) {
  const Section section = MakeDatasetSection(MadeOverview(), "");
  const Table& parts = TableIn(section, "dataset_parts");
  EXPECT_EQ(NameAt(parts, 0) + NameAt(parts, 1) + NameAt(parts, 2), "trainvaltest");
  EXPECT_DOUBLE_EQ(std::get<double>(parts.rows[0][5]), 70.0);
  EXPECT_EQ(NameAt(TableIn(section, "dataset_objects"), 0), "person");
  EXPECT_EQ(NameAt(TableIn(section, "dataset_classes"), 0), "rail");
  EXPECT_DOUBLE_EQ(std::get<double>(TableIn(section, "dataset_classes").rows[0][2]), 60.0);
}

TEST(DatasetSection, HasNoTableOfObjectsWhereThereAreNone) {
  DatasetOverview overview = MadeOverview();
  overview.report.objects.clear();
  const Section section = MakeDatasetSection(overview, "");
  EXPECT_THROW((void)TableIn(section, "dataset_objects"), std::out_of_range);
}

TEST(DatasetSection, HasAColumnForEachBin) {
  const Section section = MakeDatasetSection(MadeOverview(), "");
  const Table& distances = TableIn(section, "dataset_objects_by_distance");
  ASSERT_EQ(distances.columns.size(), 9U);
  EXPECT_EQ(distances.columns[2].key, "10_to_25_m");
  EXPECT_EQ(CountAt(distances, 1, 2), 2U);
  EXPECT_EQ(CountAt(TableIn(section, "dataset_points_by_distance"), 1, 2), 7U);
  const Table& occlusions = TableIn(section, "dataset_objects_by_occlusion");
  ASSERT_EQ(occlusions.columns.size(), 7U);
  EXPECT_EQ(CountAt(occlusions, 1, 5), 1U);
  EXPECT_EQ(section.charts.at(0).series.size(), 2U);
  EXPECT_EQ(section.charts.at(0).x.categories.size(), 8U);
  EXPECT_EQ(section.charts.at(1).x.categories.size(), 6U);
}

TEST(DatasetSection, OfASecondDataSetHasKeysOfItsOwn) {
  const Section section = MakeDatasetSection(MadeOverview(), "_2");
  EXPECT_EQ(section.key, "dataset_2");
  for (const Table& table : section.tables) EXPECT_TRUE(table.key.ends_with("_2")) << table.key;
  for (const Chart& chart : section.charts) EXPECT_TRUE(chart.key.ends_with("_2")) << chart.key;
}

TEST(DatasetSection, SaysHowManyFramesAreEmpty) {
  const Section section = MakeDatasetSection(MadeOverview(), "");
  const Table& frames = TableIn(section, "dataset_frames");
  EXPECT_EQ(NameAt(frames, 2), "without objects");
  EXPECT_EQ(CountAt(frames, 2, 1), 2U);
  EXPECT_DOUBLE_EQ(std::get<double>(frames.rows[2][2]), 25.0);
}

/// A frame of points, each with its range in metres and its label.
RecordedFrame FrameOfRanges(const std::vector<std::pair<float, std::uint32_t>>& points) {
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
  balance.Add(FrameOfRanges({{9.5F, 1}, {10.0F, 1}, {10.5F, 2}, {kNoPoint, 2}, {12.0F, 1}}));
  balance.Add(FrameOfRanges({{200.0F, 3}, {199.0F, 1}, {kNoPoint, 4}}));
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
  RecordedFrame recorded = FrameOfRanges({{5.0F, 1}});
  recorded.fields.erase("label");
  ClassBalance balance;
  balance.Add(recorded);
  EXPECT_TRUE(balance.is_empty());
}

}  // namespace
}  // namespace railcast
