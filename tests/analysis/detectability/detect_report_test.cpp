#include "analysis/detectability/detect_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/detectability/object_detection.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

using testing::HasSubstr;

/// A run that approaches a person from 200 m at 10 m/s, 1 m per frame, with 5 points per frame from
/// `first_m` on.
DetectRun MadeRun(std::uint64_t seed,
                  double first_m,
                  double gradient = 0.0,
                  bool is_in_way = true) {
  RunCourses courses;
  ObjectCourse course{.type = "person", .label = "person", .sightings = {}};
  for (std::uint32_t i = 0; i < 190; ++i) {
    const double distance_m = 200.0 - i;
    course.sightings.push_back({.frame = i,
                                .distance_m = distance_m,
                                .points = distance_m <= first_m ? 5U : 1U,
                                .speed_mps = 10.0,
                                .gradient = gradient,
                                .approach_mps = 0.0,
                                .is_in_way = is_in_way,
                                .from_axis_m = is_in_way ? 0.0 : 2.1});
  }
  courses.num_frames = 190;
  courses.objects["person"] = course;
  return DetectInRun("run" + std::to_string(seed), seed, courses, {});
}

const Table& TableOf(const Report& report, const std::string& key) {
  for (const Section& section : report.sections) {
    for (const Table& table : section.tables) {
      if (table.key == key) return table;
    }
  }
  throw std::out_of_range(key);
}

const Section& SectionOf(const Report& report, const std::string& key) {
  return *std::ranges::find(report.sections, key, &Section::key);
}

Cell CellOf(const Table& table, std::size_t row, const std::string& column) {
  const auto found = std::ranges::find(table.columns, column, &TableColumn::key);
  return table.rows.at(row).at(static_cast<std::size_t>(found - table.columns.begin()));
}

Report ReportOf(const std::vector<DetectRun>& runs) {
  return MakeDetectReport(runs, {}, "railcast-analyze detect", {}, {"footprint", true});
}

TEST(DetectReport, GivesTheFirstDetectionOfEachRun) {
  const Report report = ReportOf({MadeRun(1, 150.0), MadeRun(2, 130.0)});
  const Table& runs = TableOf(report, "runs");
  ASSERT_EQ(runs.rows.size(), 2U);
  // The third frame with five points is 2 m nearer. The distance needed is 20 m + 100 m + 15 m.
  EXPECT_EQ(std::get<double>(CellOf(runs, 0, "detected_at_m")), 148.0);
  EXPECT_EQ(std::get<double>(CellOf(runs, 0, "needed_m")), 135.0);
  EXPECT_EQ(std::get<double>(CellOf(runs, 0, "spare_m")), 13.0);
  EXPECT_EQ(std::get<std::string>(CellOf(runs, 0, "outcome")), "in time");
  EXPECT_EQ(std::get<std::string>(CellOf(runs, 1, "outcome")), "too late");
  EXPECT_NEAR(std::get<double>(CellOf(runs, 1, "speed_kmph")), 36.0, 1e-12);
  const Table& verdicts = TableOf(report, "verdicts");
  EXPECT_EQ(std::get<std::string>(CellOf(verdicts, 0, "verdict")), "too late in 1 of 2 runs");
  EXPECT_EQ(std::get<double>(CellOf(verdicts, 0, "least_spare_m")), -7.0);
  EXPECT_EQ(std::get<double>(CellOf(verdicts, 0, "least_detected_at_m")), 128.0);
}

TEST(DetectReport, HasAnIntervalOverManySeedsOnly) {
  std::vector<DetectRun> runs;
  for (std::uint64_t seed = 1; seed <= 9; ++seed) {
    runs.push_back(MadeRun(seed, 140.0 + static_cast<double>(seed)));
  }
  const Report few = ReportOf(runs);
  EXPECT_FALSE(std::get<Estimate>(CellOf(TableOf(few, "means"), 0, "spare_m")).is_enough());
  EXPECT_THAT(SectionOf(few, "rules").paragraphs.back(), HasSubstr("give no interval"));
  runs.push_back(MadeRun(10, 150.0));
  const Report many = ReportOf(runs);
  const auto spare = std::get<Estimate>(CellOf(TableOf(many, "means"), 0, "spare_m"));
  // Distances 141 to 150 m minus 2 m minus 135 m: 8.5 m on average, s = 3.028 m; Student's t for 9
  // degrees of freedom is 2.262.
  EXPECT_NEAR(spare.value, 8.5, 1e-9);
  EXPECT_NEAR(spare.high - spare.value, 2.2622 * 3.02765 / std::sqrt(10.0), 1e-3);
  const auto share = std::get<Estimate>(CellOf(TableOf(many, "means"), 0, "in_time_percent"));
  EXPECT_EQ(share.value, 100.0);
  EXPECT_GT(share.low, 60.0);
}

TEST(DetectReport, SaysThatOneRunHasNoInterval) {
  const Report report = ReportOf({MadeRun(1, 150.0)});
  EXPECT_THAT(SectionOf(report, "rules").paragraphs.back(), HasSubstr("One run: no interval"));
  EXPECT_EQ(std::get<std::string>(CellOf(TableOf(report, "verdicts"), 0, "verdict")),
            "in time in the one run");
}

// If the object is seen from the first frames on, the run only gives a lower bound of the distance
// of detection.
TEST(DetectReport, LeavesOpenWhatARunThatBeginsTooNearCannotTell) {
  DetectRun near = MadeRun(1, 300.0);
  const Report enough = ReportOf({near});
  EXPECT_EQ(std::get<std::string>(CellOf(TableOf(enough, "verdicts"), 0, "verdict")),
            "in time in the one run");
  EXPECT_EQ(std::get<std::string>(CellOf(TableOf(enough, "runs"), 0, "outcome")),
            "in time, at once");
  DetectSpec fast;
  fast.speed_mps = 20.0;  // The train needs 455 m to stop.
  near = DetectInRun("run", 1, near.courses, fast);
  const Report report = ReportOf({near});
  const Table& verdicts = TableOf(report, "verdicts");
  EXPECT_EQ(std::get<std::string>(CellOf(verdicts, 0, "verdict")),
            "not known, begun too near in the one run");
  EXPECT_TRUE(std::isnan(std::get<double>(CellOf(verdicts, 0, "least_spare_m"))));
  EXPECT_EQ(std::get<std::uint64_t>(CellOf(verdicts, 0, "begun_too_near")), 1U);
  EXPECT_EQ(std::get<Estimate>(CellOf(TableOf(report, "means"), 0, "in_time_percent")).num, 0U);
  // Series of the points, the rule and the distance needed, but none of a detection.
  EXPECT_EQ(SectionOf(report, "points").charts[0].series.size(), 3U);
}

TEST(DetectReport, TellsWhatWasNeverSeenOrNeverApproached) {
  DetectRun run = MadeRun(1, 0.0);
  ObjectCourse behind = run.courses.objects.at("person");
  std::ranges::reverse(behind.sightings);
  run.courses.objects["train"] = behind;
  run = DetectInRun("run", 1, run.courses, {});
  const Report report = ReportOf({run});
  const Table& verdicts = TableOf(report, "verdicts");
  EXPECT_EQ(std::get<std::string>(CellOf(verdicts, 0, "verdict")), "not detected in the one run");
  EXPECT_TRUE(std::isnan(std::get<double>(CellOf(verdicts, 0, "least_spare_m"))));
  EXPECT_EQ(std::get<double>(CellOf(verdicts, 0, "needed_m")), 135.0);
  EXPECT_EQ(std::get<std::string>(CellOf(verdicts, 1, "verdict")), "never approached");
  EXPECT_TRUE(std::isnan(std::get<double>(CellOf(TableOf(report, "runs"), 1, "needed_m"))));
  // One chart only: the other object is no reason to brake.
  EXPECT_EQ(SectionOf(report, "points").charts.size(), 1U);
}

TEST(DetectReport, ChartsPointsBesideWhatIsNeeded) {
  const Report report = ReportOf({MadeRun(1, 150.0), MadeRun(2, 130.0)});
  const Chart& chart = SectionOf(report, "points").charts.at(0);
  EXPECT_EQ(chart.key, "points_person");
  EXPECT_TRUE(chart.y.is_log);
  ASSERT_EQ(chart.series.size(), 4U);
  // Bins of 10 m from 10 to 200 m, with 20 frames each.
  EXPECT_EQ(chart.series[0].points.size(), 20U);
  EXPECT_EQ(chart.series[0].points.front().x, 15.0);
  EXPECT_EQ(chart.series[0].points.front().y, 5.0);
  EXPECT_EQ(chart.series[0].points[18].y, 1.0);
  // What is enough is a level line.
  ASSERT_EQ(chart.series[1].points.size(), 2U);
  EXPECT_EQ(chart.series[1].points[0].y, 5.0);
  EXPECT_EQ(chart.series[1].points[1].y, 5.0);
  EXPECT_EQ(chart.series[2].title, "needed: 135 m");
  EXPECT_EQ(chart.series[2].points[0].x, 135.0);
  EXPECT_EQ(chart.series[3].title, "detected at: 138 m");
  const Table& points = TableOf(report, "points_by_distance");
  EXPECT_EQ(std::get<Span>(CellOf(points, 0, "distance_m")).low, 10.0);
  EXPECT_EQ(std::get<Span>(CellOf(points, 0, "distance_m")).high, 20.0);
  EXPECT_EQ(std::get<std::uint64_t>(CellOf(points, 0, "frames")), 18U);
}

std::vector<std::string> HeadlinesOf(const Report& report) {
  std::vector<std::string> lines;
  for (const Headline& headline : report.headlines) {
    std::string line = headline.title + ": ";
    if (const auto* const text = std::get_if<std::string>(&headline.value)) line += *text;
    if (const auto* const num = std::get_if<std::uint64_t>(&headline.value)) {
      line += std::to_string(*num);
    }
    lines.push_back(line);
  }
  return lines;
}

TEST(DetectReport, JudgesOnlyWhatIsInTheWay) {
  DetectRun run = MadeRun(1, 150.0);
  const DetectRun beside = MadeRun(1, 30.0, 0.0, false);
  run.courses.objects["man_beside"] = beside.courses.objects.at("person");
  run = DetectInRun("run", 1, run.courses, {});
  const Report report = ReportOf({run});
  // The verdicts come first and are unfolded.
  const Table& verdicts = report.sections.at(0).tables.at(0);
  EXPECT_EQ(verdicts.key, "verdicts");
  EXPECT_TRUE(verdicts.is_open);
  ASSERT_EQ(verdicts.rows.size(), 1U);
  EXPECT_EQ(std::get<std::string>(CellOf(verdicts, 0, "object")), "person");
  const Table& apart = TableOf(report, "beside_the_track");
  ASSERT_EQ(apart.rows.size(), 1U);
  EXPECT_EQ(std::get<std::string>(CellOf(apart, 0, "object")), "man_beside");
  EXPECT_EQ(std::get<double>(CellOf(apart, 0, "from_axis_m")), 2.1);
  EXPECT_EQ(std::get<std::string>(CellOf(TableOf(report, "runs"), 0, "outcome")),
            "beside the track");
  EXPECT_TRUE(std::isnan(std::get<double>(CellOf(TableOf(report, "runs"), 0, "spare_m"))));
  // Detected at 28 m, which is 107 m too late.
  EXPECT_THAT(HeadlinesOf(report),
              testing::ElementsAre(
                  "person: in time in the one run", "In the way, and judged: 1",
                  "Always detected in time: 1",
                  "Least distance to spare, person: ", "Beside the track, not judged: man_beside"));
}

TEST(DetectReport, NamesWhatBeganTooNearAndDoesNotCountIt) {
  DetectSpec fast;
  fast.speed_mps = 20.0;  // The train needs 455 m, but the approach begins at 200 m.
  const DetectRun run = DetectInRun("run", 1, MadeRun(1, 300.0).courses, fast);
  EXPECT_THAT(HeadlinesOf(ReportOf({run})),
              testing::ElementsAre("In the way, and judged: 0", "Always detected in time: 0",
                                   "Begun too near to judge: person"));
  // Another run that detects the person later is decisive.
  DetectRun later = DetectInRun("later", 2, MadeRun(2, 150.0).courses, fast);
  EXPECT_THAT(HeadlinesOf(ReportOf({run, later})),
              testing::ElementsAre("person: too late in 1 of 2 runs, not known, begun too near in "
                                   "1 of 2 runs",
                                   "In the way, and judged: 1", "Always detected in time: 0",
                                   "Least distance to spare, person: "));
}

TEST(DetectReport, ChartsBinsOfFewFramesWithoutAnInterval) {
  DetectRun run = MadeRun(1, 150.0);
  std::erase_if(run.courses.objects.at("person").sightings,
                [](const Sighting& sighting) { return sighting.frame % 2 == 1; });
  const Report report = ReportOf({DetectInRun("run", 1, run.courses, {})});
  const ChartSeries& points = SectionOf(report, "points").charts[0].series[0];
  ASSERT_EQ(points.points.size(), 20U);
  EXPECT_EQ(points.points[5].y, 5.0);
  EXPECT_TRUE(std::isnan(points.points[5].low));
  EXPECT_TRUE(std::isnan(points.points[5].high));
}

TEST(DetectReport, SaysWhichRunCannotStop) {
  EXPECT_EQ(MessageOf([] { (void)MadeRun(4, 100.0, -0.06); }),
            "run4: object person: cannot stop: deceleration + g x gradient must be > 0 (got -0.088 "
            "m/s2 at -60 permil)");
}

/// Runs whose detections fall off as 1 / (1 + (d / 100 m)^8), in no order.
std::vector<DetectRun> RunsOfAKnownProbability(std::uint64_t num) {
  std::vector<DetectRun> runs;
  for (std::uint64_t i = 0; i < num; ++i) {
    const double share = std::fmod((static_cast<double>(i) + 0.5) * std::numbers::sqrt2, 1.0);
    const double detected_m = 100.0 * std::pow(1.0 / share - 1.0, 1.0 / 8.0);
    runs.push_back(MadeRun(i + 1, detected_m + 2.0));  // The rule asks for three frames.
  }
  return runs;
}

TEST(DetectReport, GivesTheDistanceOfAProbabilityWithConfidence) {
  const Report report = ReportOf(RunsOfAKnownProbability(300));
  const Table& table = TableOf(report, "probability");
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(std::get<std::uint64_t>(CellOf(table, 0, "inspections")), 300U);
  const double d90_m = 100.0 * std::pow(1.0 / 9.0, 1.0 / 8.0);
  EXPECT_NEAR(std::get<double>(CellOf(table, 0, "curve_d90_m")), d90_m, 0.08 * d90_m);
  EXPECT_LT(std::get<double>(CellOf(table, 0, "curve_d90_95_m")),
            std::get<double>(CellOf(table, 0, "curve_d90_m")));
  // Nearer than the truth, which the ranks tell better than single inspections do.
  EXPECT_LT(std::get<double>(CellOf(table, 0, "d90_95_m")), d90_m);
  EXPECT_GT(std::get<double>(CellOf(table, 0, "d90_95_m")),
            std::get<double>(CellOf(table, 0, "curve_d90_95_m")));
  ASSERT_EQ(SectionOf(report, "probability").charts.size(), 1U);
  const Chart& chart = SectionOf(report, "probability").charts[0];
  ASSERT_EQ(chart.series.size(), 4U);
  const auto& steps = chart.series[0].points;
  ASSERT_EQ(steps.size(), 2U * 300U + 1U);
  EXPECT_EQ(steps.front().y, 0.0);
  EXPECT_EQ(steps.back().x, 0.0);
  EXPECT_EQ(steps.back().y, 1.0);
  EXPECT_EQ(chart.series[1].points.at(0).x, std::get<double>(CellOf(table, 0, "d90_95_m")));
}

TEST(DetectReport, SaysThatRunsAreTooFewForAProbability) {
  const Report report = ReportOf(RunsOfAKnownProbability(59));
  const Section& section = SectionOf(report, "probability");
  ASSERT_EQ(section.paragraphs.size(), 1U);
  EXPECT_THAT(section.paragraphs[0], HasSubstr("requires 60, one per run: person (59)."));
  EXPECT_TRUE(section.tables.empty());
}

}  // namespace
}  // namespace railcast
