#include "analysis/stats/difficulty.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "railcast/lidar.h"
#include "tests/support/scan_once.h"

namespace railcast {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;

/// A person's box before the sensor.
RecordedObject PersonAt(double x_m, double occlusion, std::uint32_t points) {
  RecordedObject object;
  object.label = "person";
  object.size_m = {0.6, 0.6, 1.8};
  object.sensor_from_box.translation() = Vector3(x_m, 0.0, 0.0);
  object.points = points;
  object.firings_alone = 100;
  object.occlusion = occlusion;
  return object;
}

Difficulty OfObjects(const std::vector<RecordedObject>& objects) {
  RecordedFrame recorded;
  recorded.objects = objects;
  Difficulty difficulty;
  difficulty.Add(recorded, nullptr);
  return difficulty;
}

std::vector<std::uint64_t> ObjectsByGrade(const Difficulty& difficulty, Difficulty::Scale scale) {
  std::vector<std::uint64_t> counts;
  for (const Difficulty::Count& count :
       difficulty.by_label().at("person").at(static_cast<std::size_t>(scale))) {
    counts.push_back(count.objects);
  }
  return counts;
}

// 1.8 m appear as 40 px at 721.5377 * 1.8 / 40 = 32.5 m, as 25 px at 52.0 m.
TEST(KittiGradeOf, AsksForHeightOcclusionAndTruncationTogether) {
  EXPECT_EQ(KittiGradeOf(PersonAt(32.4, 0.0, 9), 0.0), KittiGrade::kEasy);
  EXPECT_EQ(KittiGradeOf(PersonAt(32.6, 0.0, 9), 0.0), KittiGrade::kModerate);
  EXPECT_EQ(KittiGradeOf(PersonAt(51.9, 0.0, 9), 0.0), KittiGrade::kModerate);
  EXPECT_EQ(KittiGradeOf(PersonAt(52.0, 0.0, 9), 0.0), KittiGrade::kHarder);
  EXPECT_EQ(KittiGradeOf(PersonAt(20.0, 0.09, 9), 0.15), KittiGrade::kEasy);
  EXPECT_EQ(KittiGradeOf(PersonAt(20.0, 0.1, 9), 0.0), KittiGrade::kModerate);
  EXPECT_EQ(KittiGradeOf(PersonAt(20.0, 0.5, 9), 0.0), KittiGrade::kHard);
  EXPECT_EQ(KittiGradeOf(PersonAt(20.0, 0.0, 9), 0.16), KittiGrade::kModerate);
  EXPECT_EQ(KittiGradeOf(PersonAt(20.0, 0.0, 9), 0.31), KittiGrade::kHard);
  EXPECT_EQ(KittiGradeOf(PersonAt(20.0, 0.0, 9), 0.51), KittiGrade::kHarder);
  EXPECT_EQ(KittiGradeOf(PersonAt(20.0, 0.0, 0), 0.0), KittiGrade::kNoPoints);
}

TEST(Difficulty, CountsObjectsAndTheirPointsByGrade) {
  const Difficulty difficulty =
      OfObjects({PersonAt(20.0, 0.0, 101), PersonAt(20.0, 0.25, 100), PersonAt(60.0, 0.5, 20),
                 PersonAt(60.0, 0.99, 5), PersonAt(160.0, 1.0, 0)});
  using Counts = std::vector<std::uint64_t>;
  using Scale = Difficulty::Scale;
  EXPECT_EQ(ObjectsByGrade(difficulty, Scale::kKitti), (Counts{1, 1, 0, 2, 1}));
  EXPECT_EQ(ObjectsByGrade(difficulty, Scale::kOcclusion), (Counts{1, 1, 1, 1, 1}));
  EXPECT_EQ(ObjectsByGrade(difficulty, Scale::kTruncation), (Counts{5, 0, 0, 0, 0}));
  EXPECT_EQ(ObjectsByGrade(difficulty, Scale::kPoints), (Counts{1, 1, 1, 1, 1}));
  const auto& kitti = difficulty.by_label().at("person").at(0);
  EXPECT_EQ(kitti.at(0).points, 101U);
  EXPECT_EQ(kitti.at(1).points, 100U);
  EXPECT_EQ(kitti.at(3).points, 25U);
  EXPECT_EQ(kitti.at(3).by_distance.at(3), 2U);  // 50 to 75 m.
  EXPECT_EQ(kitti.at(4).by_distance.at(6), 1U);  // 150 to 200 m.
}

TEST(Difficulty, LeavesOutWhatIsOutOfSight) {
  RecordedObject behind = PersonAt(-20.0, 0.0, 0);
  behind.firings_alone = 0;
  behind.occlusion.reset();
  EXPECT_TRUE(OfObjects({behind}).is_empty());
}

TEST(Difficulty, SumsUpFrames) {
  Difficulty sum = OfObjects({PersonAt(20.0, 0.0, 7)});
  AddTo(sum, OfObjects({PersonAt(20.0, 0.0, 8), PersonAt(30.0, 0.6, 1)}));
  EXPECT_EQ(ObjectsByGrade(sum, Difficulty::Scale::kKitti),
            (std::vector<std::uint64_t>{2, 0, 1, 0, 0}));
  EXPECT_EQ(sum.by_label().at("person").at(0).at(0).points, 15U);
}

TEST(Difficulty, ReportsARowForEachGradeWithSharesOfAll) {
  const Section section =
      OfObjects({PersonAt(20.0, 0.0, 30), PersonAt(60.0, 0.3, 10)}).MakeSection();
  const Table& table = section.tables.at(0);
  ASSERT_EQ(table.rows.size(), 20U);
  EXPECT_EQ(std::get<std::string>(table.rows[0][1]), "easy");
  EXPECT_EQ(std::get<double>(table.rows[0][3]), 50.0);
  EXPECT_EQ(std::get<double>(table.rows[0][5]), 75.0);
  EXPECT_EQ(std::get<std::string>(table.rows[6][1]), "25-50 %");
  EXPECT_EQ(std::get<std::uint64_t>(table.rows[6][4]), 10U);
}

// Of the five places across the box, two are beyond the field's edge, on which its middle lies.
TEST(TruncationOf, IsTheShareOutsideTheFieldOfView) {
  const auto scan = MakeScanTable(MakeRaster(60.0, 30.0, 0.5));
  ASSERT_TRUE(scan);
  RecordedObject object = PersonAt(20.0, 0.0, 9);
  EXPECT_EQ(TruncationOf(object, *scan), 0.0);
  object.size_m = {0.01, 2.0, 0.1};
  object.sensor_from_box = Transform(Eigen::AngleAxisd(30.0 * kDegree_rad, Vector3::UnitZ())) *
                           Eigen::Translation3d(20.0, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(TruncationOf(object, *scan), 0.4);
  object.size_m = {0.01, 0.1, 2.0};
  object.sensor_from_box = Transform(Eigen::AngleAxisd(15.0 * kDegree_rad, Vector3::UnitY())) *
                           Eigen::Translation3d(20.0, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(TruncationOf(object, *scan), 0.4);
  EXPECT_EQ(TruncationOf(PersonAt(-20.0, 0.0, 9), *scan), 1.0);
}

LabelTable MadeLabels() {
  Label person;
  person.id = 1;
  person.name = "person";
  person.osdar23 = "person";
  return LabelTable({person});
}

TEST(OsdarBalance, CountsObjectsWithPointsByClass) {
  Difficulty objects = OfObjects({PersonAt(20.0, 0.0, 7), PersonAt(20.0, 0.0, 0)});
  RecordedObject box = PersonAt(20.0, 0.0, 3);
  box.label = "object";
  AddTo(objects, OfObjects({box, box, box}));
  const Section section = MakeOsdarBalanceSection(objects, MadeLabels());
  std::map<std::string, const std::vector<Cell>*> rows;
  for (const auto& row : section.tables.at(0).rows) rows[std::get<std::string>(row[0])] = &row;
  EXPECT_EQ(std::get<std::uint64_t>(rows.at("person")->at(1)), 1U);
  EXPECT_EQ(std::get<double>(rows.at("person")->at(2)), 25.0);
  EXPECT_EQ(std::get<std::uint64_t>(rows.at("none of OSDaR23")->at(1)), 3U);
  EXPECT_EQ(std::get<std::uint64_t>(rows.at("catenary_pole")->at(1)), 0U);
}

TEST(OsdarBalance, HasTheCuboidsOfOsdarsOwnLabels) {
  const std::string path =
      RAILCAST_SHARED_DATA_DIR "/osdar23_openlabel/1_calibration_1.1_labels.json";
  std::ifstream file(path);
  if (!file) GTEST_SKIP() << "needs " << path;
  const auto scene = nlohmann::json::parse(file).at("openlabel");
  std::map<std::string, std::uint64_t> cuboids;
  for (const auto& frame : scene.at("frames")) {
    for (const auto& [id, object] : frame.at("objects").items()) {
      const auto& data = object.at("object_data");
      if (!data.contains("cuboid")) continue;
      cuboids[scene.at("objects").at(id).at("type")] += data.at("cuboid").size();
    }
  }
  const Section section = MakeOsdarBalanceSection(OfObjects({}), MadeLabels());
  std::map<std::string, std::uint64_t> stated;
  for (const auto& row : section.tables.at(0).rows) {
    stated[std::get<std::string>(row[0])] = std::get<std::uint64_t>(row[3]);
  }
  EXPECT_EQ(stated, cuboids);
}

}  // namespace
}  // namespace railcast
