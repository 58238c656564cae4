#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/extras/study/study_report.h"
#include "analysis/report/formats.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

/// An approach to an object, its distance of detection (0 = never), and what was drawn for it.
ApproachRecord DrawnApproach(const std::string& object_name,
                             double distance_m,
                             double needed_m,
                             std::map<std::string, Json> drawn) {
  StudiedObject object{.name = object_name, .type = "person", .is_detected = distance_m > 0.0};
  object.distance_m = object.is_detected ? distance_m : std::numeric_limits<double>::quiet_NaN();
  object.nearest_m = 5.0;
  object.farthest_m = 200.0;
  object.needed_m = needed_m;
  return {.drawn = std::move(drawn), .objects = {std::move(object)}};
}

/// Two kinds of weather with two sensors. In three cells, 64 approaches detect at 91, 92, ..., 154
/// m, and need another distance in each; the fourth cell has 11, of which ten detect nothing and
/// one begins too near to tell.
std::vector<ApproachRecord> FourCells() {
  std::vector<ApproachRecord> approaches;
  const auto add = [&](const char* weather, const char* sensor, double distance_m,
                       double needed_m) {
    approaches.push_back(
        DrawnApproach("person", distance_m, needed_m, {{"weather", weather}, {"sensor", sensor}}));
  };
  for (int i = 0; i < 64; ++i) {
    const double distance_m = 91.0 + (i * 27) % 64;
    add("clear", "Pandar64, \"roof\"", distance_m, i == 0 ? 77.0 : 70.0);
    add("clear", "VLS-128", distance_m, 150.0);
    add("fog", "Pandar64, \"roof\"", distance_m, 95.0);
  }
  for (int i = 0; i < 10; ++i) add("fog", "VLS-128", 0.0, 80.0);
  add("fog", "VLS-128", 60.0, 81.0);
  approaches.back().objects[0].is_from_start = true;
  return approaches;
}

Section SectionOf(const std::vector<ApproachRecord>& approaches,
                  const std::vector<std::string>& names) {
  const auto observations = ObservationsOf(approaches);
  const auto factors = FactorsOf(observations);
  return TableSection(observations, NamedFactors(names, factors));
}

std::string WordsOf(const std::vector<Cell>& row) {
  return std::get<std::string>(row[0]) + " " + std::get<std::string>(row[1]) + ": " +
         std::get<Judgement>(row[2]).words;
}

TEST(StudyTable, JudgesEachCombinationByItsOwnApproaches) {
  const Section section = SectionOf(FourCells(), {"weather", "sensor"});
  const auto& rows = section.tables.at(0).rows;
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(TableBlocks(section.tables[0]).size(), 1U);  // All columns stand side by side.
  EXPECT_EQ(WordsOf(rows[0]), "clear Pandar64, \"roof\": yes");
  EXPECT_EQ(WordsOf(rows[1]), "clear VLS-128: no");
  EXPECT_EQ(WordsOf(rows[2]), "fog Pandar64, \"roof\": not shown");
  EXPECT_EQ(WordsOf(rows[3]), "fog VLS-128: too few");
  // In time: all 64; those at 150 to 154 m; those from 95 m on; none of the ten that are decided.
  const std::vector<std::pair<double, std::uint64_t>> in_time = {
      {100.0, 64}, {100.0 * 5 / 64, 64}, {100.0 * 60 / 64, 64}, {0.0, 10}};
  const std::vector<std::uint64_t> num_approaches = {64, 64, 64, 11};
  const std::vector<double> needed_m = {77.0, 150.0, 95.0, 81.0};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(std::get<std::uint64_t>(rows[i][3]), num_approaches[i]);
    const auto share = std::get<Estimate>(rows[i][4]);
    EXPECT_NEAR(share.value, in_time[i].first, 1e-9);
    EXPECT_EQ(share.num, in_time[i].second);
    EXPECT_LT(share.low, share.high);
    EXPECT_EQ(std::get<double>(rows[i][6]), needed_m[i]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(std::get<double>(rows[i][5]), 93.0);  // The third nearest of 64.
  }
  EXPECT_TRUE(std::isnan(std::get<double>(rows[3][5])));
}

TEST(StudyTable, CountsItsVerdictsAndWhatDidNotOccur) {
  std::vector<ApproachRecord> approaches = FourCells();
  EXPECT_EQ(SectionOf(approaches, {"weather", "sensor"}).paragraphs.at(0),
            "4 cells: yes 1, no 1, not shown 1, too few 1.");
  approaches.resize(3 * 64);
  EXPECT_EQ(SectionOf(approaches, {"weather", "sensor"}).paragraphs.at(0),
            "3 cells: yes 1, no 1, not shown 1. Combinations that did not occur: 1.");
}

TEST(StudyTable, IsReadByOthersAsCsv) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "table.csv";
  WriteFileWhole(file, TableCsv(SectionOf(FourCells(), {"sensor", "weather"}).tables.at(0)));
  const Ended read = RunCommand(
      "python3 -c 'import csv, sys\n"
      "for row in csv.DictReader(open(sys.argv[1], newline=\"\")):\n"
      "  print(*row.values(), sep=\"|\")\nprint(*row, sep=\"|\")' " +
      file.string());
  ASSERT_EQ(read.status, 0) << read.said;
  EXPECT_THAT(read.said, testing::StartsWith("Pandar64, \"roof\"|clear|yes|64|100|"));
  EXPECT_THAT(read.said, testing::HasSubstr("|64|93|77\n"));
  EXPECT_THAT(read.said, testing::HasSubstr("\nVLS-128|fog|too few|11|0|0|"));
  EXPECT_THAT(read.said,
              testing::EndsWith("\nfactor_sensor|factor_weather|answer|approaches|in_time_percent|"
                                "in_time_percent_low|in_time_percent_high|in_time_percent_samples|"
                                "d90_95_m|most_needed_m\n"));
}

TEST(StudyTable, HasWordsAndColoursOnThePage) {
  const std::vector<ApproachRecord> approaches = FourCells();
  const auto targets = TargetsOf(ObservationsOf(approaches));
  const Report report{.title = "Seen?",
                      .headlines = VerdictHeadlines(targets),
                      .sections = {SectionOf(approaches, {"weather", "sensor"})}};
  const std::string page = ReportPage(report, {});
  for (const char* const cell :
       {"<td><span class=\"grade good\">yes</span></td>",
        "<td><span class=\"grade bad\">no</span></td>",
        "<td><span class=\"grade open\">not shown</span></td>",
        "<td><span class=\"grade open\">too few</span></td>",
        // At the head, of all approaches: 150 m are needed at most.
        ("<dt>person: detected in time</dt><dd><span class=\"figure words\"><span class=\"grade "
         "bad\">no</span>"),
        "<dt>person: needed, at most</dt><dd><span class=\"figure number\">150</span>",
        "<th scope=\"row\">clear</th>"}) {
    EXPECT_THAT(page, testing::HasSubstr(cell));
  }
}

TEST(StudyTable, SaysWhichFactorsThereAre) {
  const std::vector<ApproachRecord> approaches = FourCells();
  const auto factors = FactorsOf(ObservationsOf(approaches));
  const auto message = [&](const std::vector<std::string>& names) {
    return MessageOf([&] { static_cast<void>(NamedFactors(names, factors)); });
  };
  EXPECT_EQ(message({"weather", "sensr"}),
            "--table: must be factors of the study: sensor, weather (got \"sensr\")");
  EXPECT_EQ(message({"weather"}),
            "--table: must be two or three different factors (got \"weather\")");
  EXPECT_EQ(message({"weather", "sensor", "weather"}),
            "--table: must be two or three different factors (got \"weather,sensor,weather\")");
  EXPECT_EQ(message({"weather", "sensor"}), "no error");
}

/// Approaches to a person and to a cube, evenly in two kinds of weather and three postures; the
/// obstacle's name follows the target, and fog has a visibility.
std::vector<ApproachRecord> TwelveCells(std::uint32_t num) {
  std::vector<ApproachRecord> approaches;
  for (std::uint32_t i = 0; i < num; ++i) {
    const bool is_person = i % 2 == 0;
    const bool is_fog = i / 2 % 2 == 0;
    std::map<std::string, Json> drawn = {{"obstacle", is_person ? "somebody" : "something"},
                                         {"weather", is_fog ? "fog" : "clear"},
                                         {"posture", i / 4 % 3}};
    if (is_fog) drawn["/weather/visibility_m"] = 60 + i / 4 % 2;
    approaches.push_back(DrawnApproach(is_person ? "person" : "cube", 100.0, 80.0, drawn));
  }
  return approaches;
}

std::vector<std::string> LargestOf(const std::vector<ApproachRecord>& approaches,
                                   const std::vector<FactorWeight>& weights) {
  const auto observations = ObservationsOf(approaches);
  const auto factors = FactorsOf(observations);
  std::vector<std::string> names;
  for (const Factor* factor : LargestFactors(observations, factors, weights)) {
    names.push_back(factor->name);
  }
  return names;
}

TEST(StudyTable, HasTheTargetAndTheFactorsThatMatterMost) {
  using testing::ElementsAre;
  const std::vector<FactorWeight> weights = {{.name = "distance"},
                                             {.name = "/weather/visibility_m"},
                                             {.name = "posture"},
                                             {.name = "obstacle"},
                                             {.name = "weather"}};
  EXPECT_THAT(LargestOf(TwelveCells(720), weights), ElementsAre("target", "posture", "weather"));
  // With a third factor, a cell would have fewer than 60 approaches.
  EXPECT_THAT(LargestOf(TwelveCells(719), weights), ElementsAre("target", "posture"));
  // Without weights, those with the fewest values.
  EXPECT_THAT(LargestOf(TwelveCells(48), {}), ElementsAre("target", "weather"));
}

TEST(StudyTable, NeverPoolsKindsOfObjects) {
  const auto factors = FactorsOf(ObservationsOf(TwelveCells(48)));
  const auto names_of = [&](const std::vector<std::string>& named) {
    std::vector<std::string> names;
    for (const Factor* factor : NamedFactors(named, factors)) names.push_back(factor->name);
    return names;
  };
  using testing::ElementsAre;
  EXPECT_THAT(names_of({"weather", "posture"}), ElementsAre("target", "weather", "posture"));
  EXPECT_THAT(names_of({"posture", "target"}), ElementsAre("posture", "target"));
  EXPECT_THAT(names_of({}), ElementsAre());
}

TEST(StudyTable, HasNamesBeforeThirdsOfNumbersWhereNothingIsWeighed) {
  std::vector<ApproachRecord> approaches;
  for (int i = 0; i < 48; ++i) {
    approaches.push_back(DrawnApproach(
        "person", 100.0, 80.0,
        {{"mount", std::string("mount ") + "ABCD"[i % 4]}, {"/lidar/mount/roll_deg", 0.1 * i}}));
  }
  EXPECT_THAT(LargestOf(approaches, {}), testing::ElementsAre("mount", "/lidar/mount/roll_deg"));
}

TEST(StudyTable, IsLeftOutWhereLessThanTwoFactorsDiffer) {
  std::vector<ApproachRecord> approaches = FourCells();
  for (ApproachRecord& approach : approaches) approach.drawn.erase("sensor");
  EXPECT_THAT(LargestOf(approaches, {}), testing::IsEmpty());
  EXPECT_TRUE(SaysNothing(SectionOf(approaches, {})));
}

TEST(StudyTable, IsNotRepeatedByTheSectionsBelow) {
  const std::vector<ApproachRecord> approaches = FourCells();
  const auto observations = ObservationsOf(approaches);
  const auto factors = FactorsOf(observations);
  const auto both = NamedFactors({"weather", "sensor"}, factors);
  // Fog with the second sensor fails.
  EXPECT_EQ(ConditionsSection(observations, factors, {}).tables.size(), 2U);
  EXPECT_EQ(ConditionsSection(observations, factors, both).tables.size(), 1U);
  const auto keys_of = [&](const std::vector<const Factor*>& in_table) {
    std::vector<std::string> keys;
    const Section section = PlacementSection(observations, factors, in_table, Json::object());
    for (const TableColumn& column : section.tables.at(0).columns) keys.push_back(column.key);
    return keys;
  };
  EXPECT_EQ(keys_of(both).size(), 7U);  // By weather, too: other rows.
  const std::vector<const Factor*> sensor = {both[1]};
  EXPECT_EQ(keys_of(sensor),
            (std::vector<std::string>{"target", "placement", "detected", "distance_m"}));
}

}  // namespace
}  // namespace railcast
