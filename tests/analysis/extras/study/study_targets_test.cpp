#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/extras/study/approach_record.h"
#include "analysis/extras/study/study_factors.h"
#include "analysis/extras/study/study_report.h"

namespace railcast {
namespace {

/// Approaches to a person, each with its distance of detection; 0 = never.
std::vector<ApproachRecord> ApproachesThatDetectAt(const std::vector<double>& detected_m,
                                                   double needed_m) {
  std::vector<ApproachRecord> approaches;
  for (const double distance_m : detected_m) {
    StudiedObject object;
    object.name = "person";
    object.is_detected = distance_m > 0.0;
    object.distance_m = object.is_detected ? distance_m : std::numeric_limits<double>::quiet_NaN();
    object.nearest_m = 5.0;
    object.farthest_m = 200.0;
    object.needed_m = needed_m;
    ApproachRecord approach{.scenario = static_cast<std::uint32_t>(approaches.size()),
                            .objects = {object}};
    approaches.push_back(std::move(approach));
  }
  return approaches;
}

TargetResult TargetThatIsDetectedAt(const std::vector<double>& detected_m, double needed_m) {
  const std::vector<ApproachRecord> approaches = ApproachesThatDetectAt(detected_m, needed_m);
  return TargetsOf(ObservationsOf(approaches)).at(0);
}

/// 91, 92, ... in no order.
std::vector<double> DistancesBeyond90(int num) {
  std::vector<double> distances_m;
  for (int i = 0; i < num; ++i) distances_m.push_back(91.0 + (i * 27) % num);
  return distances_m;
}

TEST(StudyTargets, AreDetectedInTimeWhereAllApproachesDetectThemFartherAway) {
  const TargetResult target = TargetThatIsDetectedAt(DistancesBeyond90(64), 77.0);
  EXPECT_EQ(target.d90_95_m, 93.0);  // The third nearest of 64.
  EXPECT_EQ(AnswerOf(target), "yes");
}

TEST(StudyTargets, AreDetectedTooLateOnlyIfTheRanksShowIt) {
  // The 10th of 64 distances is what 90 % do not exceed with 95 % confidence, or the 11th.
  EXPECT_EQ(AnswerOf(TargetThatIsDetectedAt(DistancesBeyond90(64), 150.0)), "no");
  EXPECT_EQ(AnswerOf(TargetThatIsDetectedAt(DistancesBeyond90(64), 95.0)), "not shown");
}

TEST(StudyTargets, HaveNoDistanceWhereTooManyApproachesDetectNothing) {
  std::vector<double> detected_m = DistancesBeyond90(64);
  detected_m[3] = detected_m[17] = 0.0;
  EXPECT_EQ(TargetThatIsDetectedAt(detected_m, 77.0).d90_95_m, 91.0);
  detected_m[40] = 0.0;
  const TargetResult target = TargetThatIsDetectedAt(detected_m, 77.0);
  EXPECT_TRUE(std::isnan(target.d90_95_m));
  EXPECT_EQ(AnswerOf(target), "not shown");
}

TEST(StudyTargets, HaveNoAnswerOfFewerThan60Approaches) {
  const TargetResult target = TargetThatIsDetectedAt(DistancesBeyond90(59), 77.0);
  EXPECT_TRUE(std::isnan(target.d90_95_m));
  EXPECT_EQ(AnswerOf(target), "too few approaches: 60 are needed");
}

TEST(StudyTargets, StandBesideTheDriverWhereHisDistanceIsPublished) {
  std::vector<TargetResult> targets(3);
  targets[0] = {.name = "walker", .type = "person", .d90_95_m = 120.0};
  targets[1] = {.name = "cube of 20 cm", .type = "box", .d90_95_m = 35.0};
  targets[2] = {.name = "wagon", .type = "open_wagon", .d90_95_m = 180.0};
  const Section section = YardsticksSection(targets);
  const Table& table = section.tables.at(0);
  ASSERT_EQ(table.rows.size(), 2U);  // No driver's distance of wagons is published.
  EXPECT_EQ(std::get<double>(table.rows[0][2]), 240.0);
  EXPECT_EQ(std::get<double>(table.rows[0][3]), 50.0);
  EXPECT_EQ(std::get<double>(table.rows[1][2]), 175.0);
  EXPECT_EQ(std::get<double>(table.rows[1][3]), 20.0);
}

}  // namespace
}  // namespace railcast
