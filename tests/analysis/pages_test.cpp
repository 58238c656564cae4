#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"
#include "tests/analysis/made_dataset.h"
#include "tests/analysis/report/browser.h"

namespace railcast {
namespace {

using PlainJson = nlohmann::json;

/// The reports of the commands that write one, on scenarios and a study of the project, each made
/// when it is first asked for. Only their sensor is a coarse one, and the study is small. That of
/// `dossier` is tested with its study (dossier/dossier_report_test.cpp).
class CommandPages : public testing::Test {
 protected:
  static void SetUpTestSuite() { folder_ = new TemporaryFolder(); }
  static void TearDownTestSuite() { delete folder_; }

  static std::filesystem::path FolderOf(const std::string& name) {
    std::filesystem::path out = Place("of_" + name);
    if (!exists(out)) {
      Make("SOURCE_DATE_EPOCH=1700000000 " RAILCAST_ANALYZE " " + ArgumentsOf(name) + " --out " +
           out.string());
    }
    return out;
  }

  static std::filesystem::path PageOf(const std::string& name) {
    return FolderOf(name) / "report.html";
  }

  static PlainJson JsonOf(const std::string& name) {
    const std::string file = name == "study" ? "report" : name;
    return PlainJson::parse(ReadFileWhole(FolderOf(name) / (file + ".json")));
  }

  static constexpr std::array<const char*, 11> kNames = {
      "stats",  "compare",  "ablation", "fit",    "frontier", "sight",
      "detect", "evaluate", "study",    "preset", "card"};

 private:
  static std::filesystem::path Place(const std::string& name) {
    return folder_->Write("here", "").parent_path() / name;
  }

  static void Make(const std::string& command) {
    const Ended run = RunCommand(command);
    if (run.status != 0) throw std::runtime_error(run.said);
  }

  /// An approach to a person in rain, without plants, of which scenes take long to be built.
  static std::string Scenario(const std::string& resolution_deg) {
    const std::filesystem::path file = ScenariosDir() / "brake_person.json";
    PlainJson world = PlainJson::parse(ReadFileWhole(file)).at("world");
    world["vegetation"] = {{"trees_per_hectare", 0}, {"grass", false}};
    const PlainJson scenario = {{"version", 1},
                                {"file", file.string()},
                                {"world", world},
                                {"weather", {{"rain_rate_mmph", 40}}},
                                {"lidar",
                                 {{"mount", {{"position_m", {2.2, 0, 2.5}}}},
                                  {"scan",
                                   {{"rate_hz", 10},
                                    {"pattern",
                                     {{"type", "raster"},
                                      {"horizontal_fov_deg", 20},
                                      {"vertical_fov_deg", 40},
                                      {"angular_resolution_deg", std::stod(resolution_deg)}}}}}}}};
    return folder_->Write("scenario_" + resolution_deg + ".json", scenario.dump()).string() + " ";
  }

  static std::string RunOf(const std::string& name, const std::string& options) {
    const std::filesystem::path out = Place(name);
    if (!exists(out)) {
      Make(RAILCAST_GENERATE " sequence " + Scenario("0.5") + options + " --out " + out.string());
    }
    return out.string() + " ";
  }

  static std::string StudyFile() {
    const std::filesystem::path studies = ScenariosDir() / "studies";
    PlainJson recipe = PlainJson::parse(ReadFileWhole(studies / "person_recipe.json"));
    recipe["num_scenarios"] = 10;
    recipe["num_frames"] = 40;
    recipe["bases"] = {{{"file", (ScenariosDir() / "brake_person.json").string()}}};
    recipe["set"]["/fidelity"] = "surface";
    recipe["set"]["/lidar/scan/pattern/angular_resolution_deg"] = 1.0;
    recipe["set"]["/world/vegetation/trees_per_hectare"] = 0;
    recipe["set"]["/vehicle/motion/profile"] = {{{"time_s", 0}, {"speed_mps", 10}}};
    recipe["objects"][0]["ahead_m"] = {{"type", "uniform"}, {"min", 30}, {"max", 60}};
    (void)folder_->Write("person_recipe.json", recipe.dump());
    return folder_->Write("study.json", ReadFileWhole(studies / "person.json")).string();
  }

  static std::string ArgumentsOf(const std::string& name) {
    const std::string run = RunOf("run", "--frames 12");
    if (name == "compare") {
      return "compare " + run + RunOf("other", "--frames 12 --fidelity plausibility");
    }
    if (name == "ablation") return "compare --frames 1 --ablate " + Scenario("0.5");
    if (name == "frontier") {
      return "frontier --frames 1 --rows surface,footprint " + Scenario("2.0");
    }
    if (name == "sight") {
      return "sight --step-m 50 " + Scenario("2.0");
    }
    if (name == "detect" || name == "evaluate") {
      return name + " " + RunOf("approach", "--frames 60 --start-frame 180");
    }
    if (name == "study") return "study " + StudyFile();
    if (name == "card") return "card " + MakeSmallDataset(*folder_, "").string();
    if (name == "preset") return "preset " + run + "--scenario " + Scenario("0.5");
    return name + " " + run;
  }

  inline static TemporaryFolder* folder_ = nullptr;
};

TEST_F(CommandPages, AreWrittenByEveryCommand) {
  for (const char* const name : kNames) {
    SCOPED_TRACE(name);
    const PlainJson report = JsonOf(name);
    EXPECT_FALSE(report.at("sections").empty());
    // What a reader sees is what a program reads.
    const std::string page = ReadFileWhole(PageOf(name));
    for (const PlainJson& section : report.at("sections")) {
      EXPECT_THAT(page, testing::HasSubstr("<section id=\"section-" +
                                           section.at("key").get<std::string>() + "\">"));
      for (const PlainJson& chart : section.at("charts")) {
        EXPECT_TRUE(
            exists(FolderOf(name) / "charts" / (chart.at("key").get<std::string>() + ".svg")));
      }
      for (const PlainJson& table : section.at("tables")) {
        EXPECT_TRUE(exists(FolderOf(name) / "csv" / (table.at("key").get<std::string>() + ".csv")));
      }
    }
  }
}

TEST_F(CommandPages, FitTheirWidth) {
  if (!IsInstalled("chromium")) GTEST_SKIP() << "chromium is not installed";
  std::vector<std::filesystem::path> pages;
  for (const char* const name : kNames) pages.push_back(PageOf(name));
  ExpectFitWidths(pages);
}

TEST_F(CommandPages, AreReadableInLightAndDark) {
  if (!IsInstalled("chromium")) GTEST_SKIP() << "chromium is not installed";
  // All pages have one template; this one has most in it.
  ExpectReadable(PageOf("stats"));
}

TEST_F(CommandPages, FitOnTenPagesOfPaper) {
  if (!IsInstalled("chromium")) GTEST_SKIP() << "chromium is not installed";
  if (!IsInstalled("pdftotext")) GTEST_SKIP() << "pdftotext is not installed";
  for (const char* const name : {"stats", "ablation"}) {
    SCOPED_TRACE(name);
    ExpectFitsOnPaper(Printed(PageOf(name)), 10, 12.0);
  }
}

// The axes of all charts, the columns of all tables and the headlines.
void ForEachQuantity(const PlainJson& report, const std::function<void(const PlainJson&)>& visit) {
  for (const PlainJson& headline : report.at("headlines")) visit(headline);
  for (const PlainJson& section : report.at("sections")) {
    for (const PlainJson& chart : section.at("charts")) {
      visit(chart.at("x"));
      visit(chart.at("y"));
    }
    for (const PlainJson& table : section.at("tables")) {
      for (const PlainJson& column : table.at("columns")) visit(column);
    }
  }
}

TEST_F(CommandPages, HaveOneUnitForAQuantity) {
  const std::set<std::string> units = {"",      "%",  "m",    "mm",   "m²",     "1/m²",
                                       "1/sr",  "ms", "s",    "deg",  "bit",    "m/s",
                                       "x raw", "km", "1/km", "km/h", "permil", "MB"};
  for (const char* const name : kNames) {
    SCOPED_TRACE(name);
    ForEachQuantity(JsonOf(name), [&](const PlainJson& quantity) {
      const std::string title = quantity.at("title"), unit = quantity.at("unit");
      EXPECT_TRUE(units.contains(unit)) << title << " in " << unit;
      if (title.find("deviation") != std::string::npos || title.starts_with("Range error") ||
          title.starts_with("Bias")) {
        EXPECT_TRUE(unit == "mm" || unit == "m/s") << title << " in " << unit;
      }
      if (title == "Range" || title == "Distance" || title == "True range") {
        EXPECT_EQ(unit, "m") << title;
      }
    });
  }
}

}  // namespace
}  // namespace railcast
