#include "analysis/frontier/frontier_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "analysis/frontier/pareto.h"
#include "analysis/report/formats.h"
#include "tests/analysis/made_results.h"

namespace railcast {
namespace {

using PlainJson = nlohmann::json;

std::vector<RowResult> Results() {
  RowResult footprint = MadeResult("footprint", RowGroup::kLadder, 4.0, 5);
  footprint.times_ms = {30.0, 40.0, 90.0};
  footprint.row.effects.footprint = true;
  footprint.difference->reference_echoes_per_label[4] = {10, 9};
  return {MadeResult("raw_trace", RowGroup::kRawTrace, 1.0, 0), footprint};
}

LabelTable Labels() {
  Label ground;
  ground.id = 4;
  ground.name = "ground";
  return LabelTable({ground});
}

FrontierCircumstances Circumstances() {
  return {"1.2.3",
          "a.json",
          7,
          0.375F,
          R"({"a": 1})",
          "fidelity auto uses nothing\n  tolerance: 1 mm\n",
          "2023-11-14 22:13 UTC",
          "5ce0a410",
          "clear"};
}

// A report with the chart of missed echoes.
Report ChartedReport() {
  return MakeFrontierReport({}, Circumstances(), Labels(),
                            {MadeResult("raw_trace", RowGroup::kRawTrace, 1.0, 0),
                             MadeResult("footprint", RowGroup::kLadder, 4.0, 5),
                             MadeResult("surface+thin_conductors", RowGroup::kLadder, 1.25, 40),
                             MadeResult("brute_force_7", RowGroup::kBruteForce, 4.5, 20),
                             MadeResult("footprint-thin_conductors", RowGroup::kBetween, 3.5, 9),
                             MadeResult("auto", RowGroup::kChosen, 4.1, 5)},
                            "railcast-analyze frontier a.json");
}

TEST(FrontierReport, ChartsTheRungsFromLeftToRight) {
  const Chart chart = ChartedReport().sections[0].charts[0];
  EXPECT_EQ(chart.key, "missed_percent");
  ASSERT_EQ(chart.series.size(), 4U);
  const std::vector<ChartPoint>& rungs = chart.series[0].points;
  ASSERT_EQ(rungs.size(), 2U);
  EXPECT_EQ(rungs[0].x, 1.25);
  EXPECT_DOUBLE_EQ(rungs[0].y, 40.0);
  EXPECT_EQ(rungs[0].label, "surface + wires");
  EXPECT_EQ(rungs[1].x, 4.0);
  EXPECT_EQ(rungs[1].label, "footprint");
}

// Of three rows of which the processor spent a share of the time, and the raw trace varied.
std::vector<RowResult> TimedResults(double processor_share, double raw_spread) {
  std::vector<RowResult> results = Results();
  for (RowResult& result : results) {
    for (const double time_ms : result.times_ms) {
      result.processor_ms.push_back(processor_share * time_ms);
    }
  }
  results[0].spreads = {1.1, raw_spread};
  return results;
}

TEST(FrontierReport, SaysWhereTheMachineWasBusy) {
  const auto said = [](double processor_share, double raw_spread, int num_threads) {
    FrontierPlan plan;
    plan.num_threads = num_threads;
    const std::vector<RowResult> results = TimedResults(processor_share, raw_spread);
    const Report report =
        MakeFrontierReport(plan, Circumstances(), Labels(), results, "railcast-analyze frontier");
    const PlainJson json = PlainJson::parse(FrontierJson(plan, Circumstances(), Labels(), results));
    const std::string busy = BusyText(ConditionsOf(plan, results));
    EXPECT_EQ(json["timing"]["is_busy"], !busy.empty());
    EXPECT_EQ(report.title.ends_with(": busy machine, times not to be used"), !busy.empty());
    EXPECT_EQ(report.sections[0].paragraphs[0] == busy, !busy.empty());
    return busy;
  };
  EXPECT_EQ(said(0.995, 1.2, 1), "");
  EXPECT_EQ(said(0.12, 1.2, 1),
            "Busy machine: times are not to be used (the processor spent 12 % of the time on them; "
            "the raw trace took up to 1.2 times its median).");
  EXPECT_EQ(said(0.97, 3.25, 1),
            "Busy machine: times are not to be used (the processor spent 97 % of the time on them; "
            "the raw trace took up to 3.25 times its median).");
  // Several threads wait for each other, also on an idle machine.
  EXPECT_EQ(said(0.6, 1.2, 4), "");
  EXPECT_NE(said(0.6, 3.25, 4), "");
}

TEST(FrontierReport, CallsBruteForceByItsRays) {
  const Chart chart = ChartedReport().sections[0].charts[0];
  EXPECT_EQ(chart.series[1].points[0].label, "7");
  EXPECT_EQ(chart.series[2].points[0].label, "");
  ASSERT_EQ(chart.series[3].points.size(), 1U) << "what fidelity auto chooses";
  EXPECT_EQ(chart.series[3].points[0].x, 4.1);
}

TEST(FrontierReport, SaysWhatWasFoundAndWhatTheSceneNeeds) {
  const Report report = ChartedReport();
  const std::string text = ReportText(report);
  EXPECT_THAT(text, testing::HasSubstr("No row of brute force is faster and more accurate"));
  EXPECT_THAT(text, testing::HasSubstr("fidelity auto uses nothing\n"));
  const Table& found = report.sections[0].tables[1];
  EXPECT_EQ(found.key, "found");
  EXPECT_EQ(std::get<std::string>(found.rows[0][0]), "footprint");
  EXPECT_NEAR(std::get<Estimate>(found.rows[0][2]).value, 95.0, 1e-12);
  EXPECT_EQ(std::get<Estimate>(found.rows[0][2]).num, 100U);
}

// A row with 30 of 40 points on persons at 50 to 100 m, 30 of 40 steps, and an error there.
RowResult RowAtEdges() {
  RowResult row = MadeResult("footprint", RowGroup::kLadder, 4.0, 5);
  row.difference->persons.bins[1] = {40, 30};
  row.difference->steps = {40, 30};
  row.difference->step_range_m = {0.01, 0.1, 0.2};
  row.difference->bright_edges = {0.3, 0.9, 1.0};
  row.difference->range_m = {0.001, 0.01, 0.02};
  return row;
}

// As of all other figures, fewer than ten are not enough (kMinSamples).
TEST(FrontierReport, DrawsNoErrorsOfLessThanTenEchoes) {
  RowResult row = RowAtEdges();
  row.difference->thin = {9, 6};
  row.difference->second = {10, 4};
  row.difference->reference_echoes = {12, 9};
  const Report report =
      MakeFrontierReport({}, Circumstances(), Labels(), {row}, "railcast-analyze frontier a.json");
  std::map<std::string, double> drawn;
  for (const Chart& chart : report.sections[0].charts) {
    for (const ChartSeries& series : chart.series) drawn[chart.key] = series.points.at(0).y;
  }
  // Neither wires nor the range errors of the nine echoes that are matched.
  ASSERT_EQ(drawn.size(), 2U);
  EXPECT_NEAR(drawn.at("missed_percent"), 25.0, 1e-9);
  EXPECT_NEAR(drawn.at("second_missed_percent"), 60.0, 1e-9);
}

TEST(FrontierReport, TellsPointsOnPersonsByRange) {
  const Report report =
      MakeFrontierReport({}, Circumstances(), Labels(),
                         {MadeResult("raw_trace", RowGroup::kRawTrace, 1.0, 0), RowAtEdges()},
                         "railcast-analyze frontier a.json");
  const Table& targets = report.sections[0].tables[2];
  EXPECT_EQ(targets.key, "targets");
  ASSERT_EQ(targets.rows.size(), 1U);
  EXPECT_EQ(std::get<std::string>(targets.rows[0][1]), "persons");
  EXPECT_EQ(std::get<double>(targets.rows[0][2]), 50.0);
  EXPECT_EQ(std::get<double>(targets.rows[0][5]), 0.75);
  const std::string text = ReportText(report);
  EXPECT_THAT(text, testing::HasSubstr("Range error, 99 %"));
  EXPECT_THAT(text, testing::HasSubstr("Steps"));
}

// A row that misses 4 of 90 echoes near by, 5 of 10 far away, of which are the 8 of a person.
RowResult RowOfParts() {
  RowResult row = MadeResult("footprint", RowGroup::kLadder, 4.0, 9);
  row.difference->parts = {
      {{ScenePart::Kind::kRangeBin, 0, "0 to 50 m"}, {90, 86}, {88, 86}, {0.001, 0.0}, {}},
      {{ScenePart::Kind::kRangeBin, 1, "50 to 100 m"}, {10, 5}, {5, 5}, {0.01, 0.0}, {}},
      {{ScenePart::Kind::kClass, 4, "person"}, {8, 4}, {4, 4}, {}, {}},
      {{ScenePart::Kind::kClass, 5, "wagon"}, {}, {}, {}, {}},
      {{ScenePart::Kind::kObject, 1, "a person"}, {8, 4}, {4, 4}, {}, {}}};
  row.difference->approaches = {{"a person", 1, {{100.0, 1, 1}, {50.0, 25, 4}, {25.0, 99, 25}}}};
  return row;
}

TEST(FrontierReport, TellsErrorsByRangeClassAndObject) {
  const Section section = PartsSection({RowOfParts()});
  ASSERT_EQ(section.tables.size(), 4U);
  const Table& by_range = section.tables[0];
  ASSERT_EQ(by_range.rows.size(), 2U);
  EXPECT_EQ(std::get<Span>(by_range.rows[1][1]).high, 100.0);
  EXPECT_EQ(std::get<std::uint64_t>(by_range.rows[1][2]), 10U);
  const Estimate missed = std::get<Estimate>(by_range.rows[1][3]);
  EXPECT_NEAR(missed.value, 50.0, 1e-9);
  EXPECT_LT(missed.low, 30.0);
  EXPECT_EQ(section.tables[1].key, "by_class");
  EXPECT_EQ(section.tables[1].rows.size(), 1U) << "no wagon was seen";
  EXPECT_EQ(section.tables[2].key, "by_object");
  EXPECT_EQ(section.tables[3].key, "detection_distances");
}

TEST(FrontierReport, ChartsErrorsByRange) {
  const Chart chart = PartsSection({RowOfParts()}).charts[0];
  EXPECT_EQ(chart.key, "missed_percent_by_range");
  ASSERT_EQ(chart.series.size(), 1U);
  ASSERT_EQ(chart.series[0].points.size(), 2U);
  EXPECT_EQ(chart.series[0].points[1].x, 75.0);
  EXPECT_NEAR(chart.series[0].points[1].y, 50.0, 1e-9);
}

// Points grow with the square of the distance here, so that 5 of them are at 100 / sqrt(5) m.
TEST(DetectionDistance, IsInterpolatedBetweenFrames) {
  const RowResult row = RowOfParts();
  const Approach& approach = row.difference->approaches[0];
  const double reference_m = DetectionDistance_m(approach, &ApproachPoints::points_in_reference);
  EXPECT_NEAR(reference_m, 50.0 * std::pow(2.0, std::log(5.0) / std::log(25.0)), 1e-9);
  const double found_m = DetectionDistance_m(approach, &ApproachPoints::points);
  EXPECT_GT(found_m, 25.0);
  EXPECT_LT(found_m, 50.0);
  EXPECT_NEAR(DetectionDistanceError(row.difference->approaches), 1.0 - found_m / reference_m,
              1e-9);
}

TEST(DetectionDistance, IsUnknownIfTheFirstFrameHasEnoughPointsAndZeroIfNoneHas) {
  const Approach approach{"a", 1, {{100.0, 9, 1}, {50.0, 99, 2}}};
  EXPECT_TRUE(std::isnan(DetectionDistance_m(approach, &ApproachPoints::points_in_reference)));
  EXPECT_EQ(DetectionDistance_m(approach, &ApproachPoints::points), 0.0);
  EXPECT_TRUE(std::isnan(DetectionDistanceError({approach})));
}

TEST(FrontierJson, HoldsWhatHappensAtEdges) {
  const PlainJson json =
      PlainJson::parse(FrontierJson({}, Circumstances(), Labels(), {RowAtEdges()}));
  const PlainJson& errors = json["rows"][0]["errors"];
  EXPECT_EQ(errors["range_p99_m"], 0.02);
  EXPECT_EQ(errors["step_missed_share"], 0.25);
  EXPECT_EQ(errors["step_range_median_m"], 0.01);
  EXPECT_EQ(errors["step_range_m"]["p99"], 0.2);
  EXPECT_EQ(errors["bright_edge_intensity_median"], 0.3);
  EXPECT_EQ(errors["person_points_error"], 0.25);
  EXPECT_TRUE(errors["pole_points_error"].is_null());
  EXPECT_EQ(errors["person_points_by_range"][1]["from_m"], 50.0);
  EXPECT_EQ(errors["person_points_by_range"][1]["num"], 30);
}

TEST(FrontierJson, HoldsNumbersAndCircumstances) {
  FrontierPlan plan;
  plan.frames = {0, 10};
  const FrontierCircumstances circumstances = Circumstances();
  const PlainJson json = PlainJson::parse(FrontierJson(plan, circumstances, Labels(), Results()));
  EXPECT_EQ(json["version"], "1.2.3");
  EXPECT_EQ(json["scenario"], "a.json");
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["date"], "2023-11-14 22:13 UTC");
  EXPECT_EQ(json["scenario_xxh3"], "5ce0a410");
  EXPECT_EQ(json["weather"], "clear");
  EXPECT_EQ(json["frames"], (PlainJson{0, 10}));
  EXPECT_EQ(json["matching"]["match_distance_m"], 0.375);
  EXPECT_EQ(json["fidelity_auto"]["a"], 1);
  const PlainJson& row = json["rows"][1];
  EXPECT_EQ(row["p50_ms"], 40.0);
  EXPECT_EQ(row["p99_ms"], 90.0);
  EXPECT_EQ(row["ratio_to_raw_trace"], 4.0);
  EXPECT_EQ(row["effects"], PlainJson{"footprint"});
  EXPECT_NEAR(row["errors"]["missed_share"].get<double>(), 0.05, 1e-12);
  EXPECT_TRUE(row["errors"]["range_median_m"].is_null());
  EXPECT_EQ(row["errors"]["recall_per_label"]["ground"]["num_matched"], 9);
  EXPECT_EQ(json["pareto_front"]["missed_share"], PlainJson{"footprint"});
  EXPECT_FALSE(json["rows"][0].contains("errors"));
}

// 24 frames of 50 first echoes on ground at 50 to 100 m in full detail; in detail `auto` there are
// 51 of them in each, which have half the intensity.
RowResult RowInAutoDetail() {
  const auto scanned = [](std::uint32_t num, float intensity) {
    Frame frame;
    frame.Resize(1, num, 1);
    frame.label.assign(num, 4);
    frame.true_range_m.assign(num, 75.0F);
    frame.intensity.assign(num, intensity);
    frame.outcome.assign(num, Outcome::kReturned);
    EchoesByRange echoes(kDetailBin_m);
    for (int i = 0; i < 24; ++i) echoes.AddFrame(frame);
    return echoes;
  };
  RowResult row = MadeResult("footprint+auto_detail", RowGroup::kAutoDetail, 3.5, 0);
  row.difference.reset();
  row.detail_differences = DifferencesOfDetail(scanned(50, 0.4F), scanned(51, 0.2F));
  return row;
}

TEST(FrontierReport, TellsWhatSceneDetailChangesApartFromMatchedErrors) {
  const RowResult raw = MadeResult("raw_trace", RowGroup::kRawTrace, 1.0, 0);
  FrontierPlan plan;
  plan.detail_frames.resize(24);
  const Report report =
      MakeFrontierReport(plan, Circumstances(), Labels(), {raw, RowInAutoDetail()}, "command");
  ASSERT_EQ(report.sections.size(), 4U);
  const Section& section = report.sections[2];
  EXPECT_THAT(section.paragraphs[0], testing::HasSubstr("over 24 frames"));
  ASSERT_EQ(section.tables[0].rows.size(), 1U);
  const std::vector<Cell>& cells = section.tables[0].rows[0];
  EXPECT_EQ(std::get<std::string>(cells[1]), "ground");
  EXPECT_EQ(std::get<Span>(cells[2]).low, 50.0);
  EXPECT_NEAR(std::get<Estimate>(cells[3]).value, 2.0, 1e-9);
  EXPECT_EQ(std::get<Estimate>(cells[3]).num, 1200U);
  EXPECT_FALSE(std::get<Estimate>(cells[4]).is_enough()) << "there are no further echoes";
  EXPECT_NEAR(std::get<Estimate>(cells[5]).value, -50.0, 1e-4);
  for (const FrontierError& error : kFrontierErrors) {
    EXPECT_TRUE(ParetoFront({RowInAutoDetail()}, error).empty());
  }
}

TEST(FrontierJson, HoldsStatisticalDifferencesInPlaceOfErrors) {
  const PlainJson json =
      PlainJson::parse(FrontierJson({}, Circumstances(), Labels(), {RowInAutoDetail()}));
  const PlainJson& row = json["rows"][0];
  EXPECT_EQ(row["detail"], "auto");
  EXPECT_FALSE(row.contains("errors"));
  const PlainJson& difference = row["statistical_differences_from_full_detail"][0];
  EXPECT_EQ(difference["class"], "ground");
  EXPECT_EQ(difference["to_m"], 100.0);
  EXPECT_NEAR(difference["first_echoes"]["value"].get<double>(), 0.02, 1e-9);
  EXPECT_TRUE(difference["further_echoes"]["value"].is_null());
}

TEST(DifferencesOfDetail, NeedTenFrames) {
  Frame frame;
  frame.Resize(1, 1000, 1);
  frame.label.assign(1000, 4);
  frame.true_range_m.assign(1000, 10.0F);
  frame.intensity.assign(1000, 0.5F);
  frame.outcome.assign(1000, Outcome::kReturned);
  EchoesByRange echoes(kDetailBin_m);
  for (int i = 0; i < 9; ++i) echoes.AddFrame(frame);
  EXPECT_FALSE(DifferencesOfDetail(echoes, echoes)[0].first.is_enough());
  echoes.AddFrame(frame);
  const Estimate first = DifferencesOfDetail(echoes, echoes)[0].first;
  EXPECT_EQ(first.value, 0.0);
  EXPECT_EQ(first.high, 0.0);
}

TEST(FrontierCsv, LeavesEmptyWhatARowLacks) {
  const std::string csv = FrontierCsv(Results());
  EXPECT_THAT(csv, testing::StartsWith("row,group,p50_ms,p99_ms,ratio_to_raw_trace,missed_share,"));
  EXPECT_THAT(csv, testing::HasSubstr("raw_trace,raw_trace,10,10,1,,,,,,,,,,,,,,,,,\n"));
  EXPECT_THAT(csv, testing::HasSubstr("footprint,ladder,40,90,4,"));
}

TEST(RowResult, TakesTheMedianOfTheRoundsRatios) {
  RowResult result;
  result.ratios = {9.0, 1.5, 1.4};
  EXPECT_EQ(result.ratio(), 1.5);
}

}  // namespace
}  // namespace railcast
