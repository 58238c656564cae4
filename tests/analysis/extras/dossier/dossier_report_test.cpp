#include "analysis/extras/dossier/dossier_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "analysis/extras/study/kept_files.h"
#include "analysis/limits/limit_sections.h"
#include "analysis/report/provenance.h"
#include "core/base/input_file.h"
#include "tests/analysis/extras/study/study_project.h"
#include "tests/analysis/report/browser.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

/// Makes a study of a few approaches, which are alike but for what the recipe draws.
/// @param settings Of every scenario, by pointer.
FinishedStudy MakeStudyIn(const std::filesystem::path& folder, const nlohmann::json& settings) {
  nlohmann::json recipe = StudiedRecipe(12);
  recipe["set"] = settings;
  // As many rays as tell the rungs apart, and a frame every 6 m.
  recipe["set"]["/lidar/beam"] = {{"reference_rays", 16}};
  recipe["num_frames"] = 20;
  recipe["stride"] = 3;
  const StudySpec spec = ReadStudy(WriteStudy(folder, recipe));
  const Recipe read = ReadStudyRecipe(spec);
  const ScenarioDrawer drawer(read);
  StudyChoices choices{.directory = folder / "made"};
  const StudyResult result = RunStudy(spec, drawer, choices, NoStudyHooks());
  KeepFiles(
      spec, [&](std::uint32_t number) { return drawer.Draw(number); }, {},
      SampleOf(ObservationsOf(result.approaches)), choices.directory);
  return ReadFinishedStudy(choices.directory);
}

ModelError ErrorOf(const FinishedStudy& study) {
  return MeasureModelError(study, ReadSample(study), 2, [](double) {});
}

const std::string& Text(const Cell& cell) {
  return std::get<std::string>(cell);
}

const std::vector<Cell>& RowOf(const Table& table, std::size_t column, const std::string& text) {
  const auto row = std::ranges::find_if(
      table.rows, [&](const std::vector<Cell>& cells) { return Text(cells.at(column)) == text; });
  if (row == table.rows.end()) throw std::runtime_error("no row " + text);
  return *row;
}

// The reference is compared with itself: whatever differs would be a fault of the comparison.
TEST(ModelErrorOf, IsNothingForTheReferenceItself) {
  const TemporaryDirectory directory;
  const ModelError error = ErrorOf(MakeStudyIn(directory.path(), {{"/fidelity", "reference"}}));
  EXPECT_EQ(error.rung, "reference");
  ASSERT_GE(error.approaches.size(), 10U);
  std::uint32_t points = 0;
  for (const ComparedApproach& compared : error.approaches) {
    EXPECT_EQ(compared.target, "person");
    for (const ApproachPoints& frame : compared.approach.points) {
      EXPECT_EQ(frame.points, frame.points_in_reference);
      points += frame.points;
    }
  }
  EXPECT_GT(points, 100U);
  const Section section = ModelErrorSection(error);
  for (const std::vector<Cell>& row : section.tables.at(0).rows) {
    const auto shift_m = std::get<Estimate>(row.at(4));
    EXPECT_EQ(shift_m.value, 0.0);
    EXPECT_EQ(std::get<double>(row.at(6)), 0.0);
  }
}

class DossierOfAStudy : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new TemporaryDirectory;
    study_ = new FinishedStudy(MakeStudyIn(directory_->path(), nlohmann::json::object()));
  }
  static void TearDownTestSuite() {
    delete study_;
    delete directory_;
  }

  static TemporaryDirectory* directory_;
  static FinishedStudy* study_;
};
TemporaryDirectory* DossierOfAStudy::directory_ = nullptr;
FinishedStudy* DossierOfAStudy::study_ = nullptr;

// One ray a beam counts a person's beams by their centres alone (RungUsed::Warning).
TEST_F(DossierOfAStudy, ShowsThatSingleRaysSeeFewerPointsFarAway) {
  const ModelError error = ErrorOf(*study_);
  EXPECT_EQ(error.rung, "surface");
  std::uint64_t points = 0;
  std::uint64_t points_in_reference = 0;
  for (const ComparedApproach& compared : error.approaches) {
    for (const ApproachPoints& frame : compared.approach.points) {
      if (frame.distance_m < 50.0) continue;
      points += frame.points;
      points_in_reference += frame.points_in_reference;
    }
  }
  ASSERT_GT(points_in_reference, 100U);
  EXPECT_LT(static_cast<double>(points), 0.95 * static_cast<double>(points_in_reference));
}

TEST_F(DossierOfAStudy, NamesTheMachineThatMadeIt) {
  const Section section = TraceabilitySection(*study_);
  const auto& rows = section.tables.at(0).rows;
  const auto row =
      std::ranges::find_if(rows, [](const auto& cells) { return Text(cells.at(0)) == "Machine"; });
  ASSERT_NE(row, rows.end());
  EXPECT_TRUE(Text(row->at(1)).starts_with(ProcessorName() + ", "));
}

TEST_F(DossierOfAStudy, SaysWhatIsVariedAndWhatIsNot) {
  const Section scope = ScopeSection(*study_, ReadSample(*study_));
  const Table& table = scope.tables.at(0);
  const auto& fog = RowOf(table, 1, "Fog");
  EXPECT_EQ(Text(fog.at(2)), "yes");
  EXPECT_TRUE(Text(fog.at(3)).starts_with("weather: clear (")) << Text(fog.at(3));
  const auto& rain = RowOf(table, 1, "Rain");
  EXPECT_EQ(Text(rain.at(2)), "no");
  EXPECT_EQ(Text(rain.at(3)), "rain_rate_mmph 0.0");
  const auto& look = RowOf(table, 1, "Obstacle: kind and look");
  EXPECT_NE(Text(look.at(3)).find("object /person/physique: child ("), std::string::npos);
  const auto& place = RowOf(table, 1, "Obstacle: place and attitude");
  EXPECT_TRUE(Text(place.at(3)).starts_with("object /d_m: -")) << Text(place.at(3));
}

TEST_F(DossierOfAStudy, BeginsWithTheQuestionAndAnswersOrOpensEachOfTheRules) {
  const Report report = MakeDossier(*study_, ReadSample(*study_), ModelError{}, "command");
  EXPECT_EQ(report.title, "Seen?");
  EXPECT_EQ(report.sections.front().key, "verdict");
  const auto section = std::ranges::find(report.sections, "credibility", &Section::key);
  ASSERT_NE(section, report.sections.end());
  ASSERT_EQ(section->tables.size(), 2U);
  auto rows = section->tables[0].rows;
  rows.insert(rows.end(), section->tables[1].rows.begin(), section->tables[1].rows.end());
  for (const std::vector<Cell>& row : rows) {
    EXPECT_EQ(Text(row.at(2)) == "open", Text(row.at(3)).empty()) << Text(row.at(1));
    // An answer that names a section names one that is there.
    const std::string& answer = Text(row.at(3));
    for (std::size_t at = answer.find("ection "); at != std::string::npos;
         at = answer.find("ection ", at + 1)) {
      const std::string rest = answer.substr(at + 7);
      EXPECT_TRUE(std::ranges::any_of(report.sections, [&](const Section& each) {
        return rest.starts_with(each.title);
      })) << answer;
    }
  }
}

TEST(WithColoredMarks, GivesEachColourDefinitionsOfItsOwn) {
  const std::string page =
      "<p>currentColor</p><svg><defs><path id='k-gpPt0' stroke='currentColor'/>"
      "<use xlink:href='#k-gpPt0' id='k-gpPt1' fill='currentColor'/></defs>"
      "<path stroke='currentColor'/><use xlink:href='#k-gpPt1' x='1' color='#0072b2'/>"
      "<use xlink:href='#k-gpPt0'/></svg><svg><path stroke='#0072b2'/></svg>";
  EXPECT_EQ(WithColoredMarks(page),
            "<p>#17202a</p><svg><defs><path id='k-gpPt0' stroke='#17202a'/>"
            "<use xlink:href='#k-gpPt0' id='k-gpPt1' fill='#17202a'/>"
            "<path id='k-0072b2-gpPt0' stroke='#0072b2'/>"
            "<use xlink:href='#k-0072b2-gpPt0' id='k-0072b2-gpPt1' fill='#0072b2'/></defs>"
            "<path stroke='#17202a'/><use xlink:href='#k-0072b2-gpPt1' x='1' color='#0072b2'/>"
            "<use xlink:href='#k-gpPt0'/></svg><svg><path stroke='#0072b2'/></svg>");
}

TEST_F(DossierOfAStudy, KeepsOutOfTheStudy) {
  const std::string study = study_->directory.string();
  const Ended ended = RunCommand(RAILCAST_ANALYZE " dossier " + study + " --out " + study);
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.said, "--out: must be outside " + std::filesystem::canonical(study).string() +
                            ", which holds nothing but what belongs to its approaches.jsonl (got " +
                            study + ")\n");
}

TEST_F(DossierOfAStudy, IsWrittenWholeAndOnAtMostTwentyPages) {
  if (RunCommand("command -v weasyprint").status != 0) GTEST_SKIP() << "weasyprint is missing";
  const std::filesystem::path out = directory_->path() / "dossier";
  const Ended ended = RunCommand("SOURCE_DATE_EPOCH=1700000000 " RAILCAST_ANALYZE " dossier " +
                                 study_->directory.string() + " --out " + out.string());
  ASSERT_EQ(ended.status, 0) << ended.said;
  ExpectFitsOnPaper(out / "dossier.pdf", 20, 14.0);
  const auto json = nlohmann::json::parse(ReadFileWhole(out / "dossier.json"));
  EXPECT_EQ(json.at("title"), "Seen?");
  std::vector<std::string> keys;
  for (const auto& section : json.at("sections")) {
    keys.push_back(section.at("key").get<std::string>());
  }
  EXPECT_THAT(keys, testing::ElementsAre("verdict", "verdict_by_condition", "scope", "model",
                                         "sensor", "limits", "factors", "conditions", "yardsticks",
                                         "credibility", "traceability", "signatures"));
  if (IsInstalled("chromium")) ExpectFitWidths({out / "report.html"});
}

}  // namespace
}  // namespace railcast
