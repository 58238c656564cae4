#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"
#include "tests/analysis/made_dataset.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::MatchesRegex;
using PlainJson = nlohmann::json;

TEST(CardCommand, ShowsWhatADataSetHoldsAndWhatItWasMadeOf) {
  const TemporaryFolder folder;
  const fs::path set = MakeSmallDataset(folder, "--format mcap --fields x,y,z,label");
  const fs::path out = set.parent_path() / "card";
  const Ended run = Analyze("card " + set.string() + "/ --licence CC-BY-4.0 --out " + out.string());
  ASSERT_EQ(run.status, 0) << run.said;
  EXPECT_THAT(run.said, HasSubstr("README.md in " + out.string()));
  const std::string card = ReadFileWhole(out / "README.md");
  EXPECT_TRUE(card.starts_with("# Data set set\n\n- **Licence**: CC-BY-4.0\n")) << card;
  EXPECT_THAT(card, HasSubstr("- **Frames**: 6\n"));
  EXPECT_THAT(card, HasSubstr("| Seed | 1 |\n"));
  EXPECT_THAT(card, HasSubstr("--format mcap --fields x,y,z,label --isa "));
  EXPECT_THAT(card, HasSubstr("## What is not modelled\n"));
  // Classes with the numbers of the data set's own report.
  const PlainJson report = PlainJson::parse(ReadFileWhole(set / "report.json"));
  ASSERT_GT(report["labels"].size(), 1U);
  for (const auto& [label, counts] : report["labels"].items()) {
    const std::string points = std::to_string(counts["points"].get<int>());
    const std::string name = std::regex_replace(label, std::regex("_"), "\\_");
    const auto row = card.find("| " + name + " | ");
    ASSERT_NE(row, std::string::npos) << label;
    const std::string line = card.substr(row, card.find('\n', row) - row);
    EXPECT_TRUE(std::regex_replace(line, std::regex(","), "")
                    .starts_with("| " + name + " | " + points + " | "))
        << line;
  }
}

// A card is copied with its pictures to wherever the data set is given away.
TEST(CardCommand, RefersOnlyToFilesThatItWrote) {
  const TemporaryFolder folder;
  const fs::path set = MakeSmallDataset(folder, "");
  const fs::path out = set.parent_path() / "card";
  ASSERT_EQ(Analyze("card " + set.string() + " --out " + out.string()).status, 0);
  const std::string card = ReadFileWhole(out / "README.md");
  EXPECT_THAT(card, HasSubstr("- **Licence**: not stated\n"));
  const std::regex link(R"(\]\(([^)]*)\))");
  std::size_t num_pictures = 0;
  for (std::sregex_iterator i(card.begin(), card.end(), link), end; i != end; ++i) {
    const fs::path file = out / (*i)[1].str();
    EXPECT_TRUE(fs::is_regular_file(file)) << file;
    num_pictures += file.extension() == ".png" ? 1 : 0;
  }
  EXPECT_GE(num_pictures, 2U);
  EXPECT_EQ(Analyze("verify " + set.string()).status, 0);
}

TEST(CardCommand, RefusesWhatIsNoWholeDataSetInOneLine) {
  const TemporaryFolder folder;
  const fs::path set = MakeSmallDataset(folder, "--shard 1/2");
  const Ended shard = Analyze("card " + set.string() + " --format text");
  EXPECT_EQ(shard.status, 1);
  EXPECT_EQ(shard.said, set.string() +
                            ": must be a whole data set (got shard 1/2); railcast-generate merge "
                            "makes one of shards\n");
  const fs::path sequence = set / "sequences/000/000000";
  const Ended other = Analyze("card " + sequence.string() + " --format text");
  EXPECT_EQ(other.status, 1);
  EXPECT_EQ(other.said,
            sequence.string() +
                ": must be a data set that railcast-generate dataset made, with frames\n");
}

TEST(CardCommand, KeepsOutOfTheDataSet) {
  const TemporaryFolder folder;
  const fs::path set = MakeSmallDataset(folder, "");
  const fs::path out = set / "card";
  const Ended run = Analyze("card " + set.string() + " --out " + out.string());
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.said, "--out: must be outside " + fs::canonical(set).string() +
                          ", which holds nothing but what belongs to its scenarios.jsonl (got " +
                          out.string() + ")\n");
  EXPECT_FALSE(fs::exists(out));
}

TEST(CardCommand, DoesNotFollowALinkToItself) {
  const TemporaryFolder folder;
  const fs::path set = MakeSmallDataset(folder, "");
  const fs::path out = set.parent_path() / "loop";
  fs::create_symlink("loop", out);
  const Ended run = Analyze("card " + set.string() + " --out " + out.string());
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.said, out.string() + ": too many levels of symbolic links\n");
}

TEST(CardCommand, ReplacesACardButNoOtherReadme) {
  const TemporaryFolder folder;
  const fs::path set = MakeSmallDataset(folder, "");
  const fs::path out = set.parent_path() / "card";
  const std::string command = "card " + set.string() + " --out " + out.string();
  ASSERT_EQ(Analyze(command).status, 0);
  ASSERT_EQ(Analyze(command).status, 0);
  WriteFileWhole(out / "README.md", "My notes");
  const Ended run = Analyze(command);
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.said, (out / "README.md").string() +
                          ": must be absent or an earlier card, which is replaced\n");
  EXPECT_EQ(ReadFileWhole(out / "README.md"), "My notes");
}

// Every kind of key, in the order of the recipe.
TEST(CardCommand, SaysWhatTheRecipeSays) {
  const TemporaryFolder folder;
  const std::string base = (ScenariosDir() / "minimal.json").string();
  const auto recipe = folder.Write("recipe.json", R"({
    "version": 1, "num_scenarios": 2, "num_frames": 1, "stride": 3,
    "bases": [{"file": ")" + base + R"(", "weight": 2,
               "start_s_m": {"type": "uniform", "min": 210, "max": 220}}],
    "set": {"/lidar/scan/pattern/angular_resolution_deg": 2.0,
            "/vehicle/motion": {"profile": [{"time_s": 0, "speed_mps": 8}]}},
    "groups": [
      {"name": "weather", "random_weather": ["sunny", "foggy"]},
      {"name": "season", "options": [{"name": "bare", "set": {"/world/vegetation/grass": false}}]}
    ],
    "draws": {"/world/vegetation/trees_per_hectare": {"type": "choice", "values": [0, 4]}},
    "objects": [{"name": "man", "count": {"type": "integer", "min": 0, "max": 1},
                 "object": {"type": "box", "size_m": [0.5, 0.5, 1]},
                 "ahead_m": {"type": "uniform", "min": 20, "max": 30}}],
    "split": {"by": "scenario", "train": 0.5, "val": 0.5, "test": 0}
  })");
  const fs::path set = recipe.parent_path() / "set";
  const Ended made =
      RunCommand(RAILCAST_GENERATE " dataset " + recipe.string() + " --out " + set.string());
  ASSERT_EQ(made.status, 0) << made.said;
  const Ended run = Analyze("card " + set.string() + " --format json");
  ASSERT_EQ(run.status, 0) << run.said;
  std::string rows;
  const PlainJson card = PlainJson::parse(run.said);
  for (const PlainJson& section : card["sections"]) {
    for (const PlainJson& table : section["tables"]) {
      if (table["key"] != "recipe") continue;
      for (const PlainJson& row : table["rows"]) {
        rows += row["key"].get<std::string>() + " = " + row["value"].get<std::string>() + "\n";
      }
    }
  }
  EXPECT_EQ(rows,
            "num_scenarios = 2\nnum_frames = 1\nstride = 3\n"
            "bases: " +
                base +
                ": weight = 2\n"
                "bases: " +
                base +
                ": start_s_m = uniform, min 210, max 220\n"
                "set: /lidar/scan/pattern/angular_resolution_deg = 2.0\n"
                "set: /vehicle/motion = {\"profile\":[{\"time_s\":0,\"speed_mps\":8}]}\n"
                "groups: weather: random_weather = sunny, foggy\n"
                "groups: season: options: bare: set: /world/vegetation/grass = false\n"
                "draws: /world/vegetation/trees_per_hectare = choice, values 0, 4\n"
                "objects: man: count = integer, min 0, max 1\n"
                "objects: man: object = box, size_m 0.5, 0.5, 1\n"
                "objects: man: ahead_m = uniform, min 20, max 30\n"
                "split: by = scenario\nsplit: train = 0.5\nsplit: val = 0.5\nsplit: test = 0\n");
}

// The recording is that of another program: files of points without labels.
TEST(CardCommand, SaysThatObjectsWerePutIntoRecordings) {
  const TemporaryFolder folder;
  const auto scenario = WriteScenario(folder);
  const fs::path project = scenario.parent_path();
  const Ended recorded =
      RunCommand(RAILCAST_GENERATE " sequence " + scenario.string() + " --out " +
                 (project / "run").string() + " --frames 2 --fields x,y,z,intensity");
  ASSERT_EQ(recorded.status, 0) << recorded.said;
  fs::rename(project / "run/frames", project / "recording");
  const std::string scenarios = ScenariosDir().string();
  folder.Write("plan.json", R"({"version": 1, "fidelity": "surface",
    "lidar": {"scan": {"rate_hz": 10, "pattern": {"type": "raster", "horizontal_fov_deg": 20,
              "vertical_fov_deg": 40, "angular_resolution_deg": 0.5}}},
    "world": {"recording": {"poses": "standing"}},
    "materials": ")" + scenarios +
                                R"(/materials/railway.json",
    "labels": ")" + scenarios + R"(/labels.json"})");
  const auto recipe = folder.Write("recipe.json", R"({"version": 1, "num_scenarios": 1,
    "num_frames": 2, "bases": [{"file": "plan.json", "recordings": ["recording"]}]})");
  const fs::path set = project / "set";
  const Ended made =
      RunCommand(RAILCAST_GENERATE " dataset " + recipe.string() + " --out " + set.string());
  ASSERT_EQ(made.status, 0) << made.said;
  const Ended run = Analyze("card " + set.string() + " --out " + (project / "card").string());
  ASSERT_EQ(run.status, 0) << run.said;
  const std::string card = ReadFileWhole(project / "card/README.md");
  EXPECT_THAT(card, HasSubstr("\nObjects were simulated by railcast and put into recordings. "));
  EXPECT_THAT(card, HasSubstr("| railcast-generate dataset RECIPE --out DIR, with the recipe"));
}

TEST(CardCommand, RefusesARecipeThatHasChanged) {
  const TemporaryFolder folder;
  const fs::path set = MakeSmallDataset(folder, "");
  WriteFileWhole(set / "recipe.json", "{}");
  const Ended run = Analyze("card " + set.string() + " --format text");
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.said,
              MatchesRegex((set / "recipe.json").string() + ": [^\n]*manifest.json[^\n]*\n"));
}

}  // namespace
}  // namespace railcast
