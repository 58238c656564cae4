#include "analysis/stats/dataset_overview.h"

#include <gtest/gtest.h>

#include <string>

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

}  // namespace
}  // namespace railcast
