#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "core/io/image/png.h"
#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"
#include "tests/analysis/made_dataset.h"
#include "tests/core/extras/packets/pcap/made_capture.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/io/damage.h"
#include "tests/support/exits_with.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using PlainJson = nlohmann::json;

const std::string kCaptures = RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/";

std::filesystem::path MakeSequence(const TemporaryFolder& folder, const std::string& options) {
  static const TemporaryFolder kept;
  static const auto scenario = WriteScenario(kept, R"("weather": {"rain_rate_mmph": 40},)");
  const auto out = folder.Write("scenario.json", TextOf(scenario)).parent_path() / "sequence";
  GenerateOnce("sequence " + scenario.string() + " --frames 11 " + options, out);
  return out;
}

const PlainJson& JsonTableOf(const PlainJson& stats, const std::string& key) {
  for (const PlainJson& section : stats.at("sections")) {
    for (const PlainJson& table : section.at("tables")) {
      if (table.at("key") == key) return table;
    }
  }
  throw std::out_of_range(key);
}

/// The figures alone: the charts of a report take longer to be drawn than all else.
/// @param options Also the sources.
PlainJson StatsOf(const std::string& options) {
  const Ended run = Analyze("stats " + options + " --format json 2>/dev/null");
  EXPECT_EQ(run.status, 0) << options;
  return PlainJson::parse(run.said);
}

TEST(StatsCommand, CountsTheOutcomesThatTheSequenceCounted) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "");
  const auto out = sequence.parent_path() / "out";
  ASSERT_THAT(Analyze("stats " + sequence.string() + " --out " + out.string()), ExitsWith(0));
  std::map<std::string, std::uint64_t> expected;
  std::ifstream lines(sequence / "frames.jsonl");
  for (std::string line; std::getline(lines, line);) {
    const PlainJson record = PlainJson::parse(line);
    for (const auto& [outcome, num] : record["outcomes"].items()) {
      if (num > 0) expected[outcome] += num.get<std::uint64_t>();
    }
  }
  ASSERT_GT(expected["rain_absorbed"], 100U);
  const PlainJson stats = PlainJson::parse(ReadFileWhole(out / "stats.json"));
  std::map<std::string, std::uint64_t> found;
  for (const PlainJson& row : JsonTableOf(stats, "outcomes")["rows"]) {
    std::string outcome = row["outcome"];
    std::replace(outcome.begin(), outcome.end(), ' ', '_');
    found[outcome] = row["firings"];
  }
  EXPECT_EQ(found, expected);
  EXPECT_TRUE(std::filesystem::exists(out / "report.html"));
  EXPECT_TRUE(std::filesystem::exists(out / "csv" / "dropout_by_range.csv"));
  EXPECT_TRUE(std::filesystem::exists(out / "charts" / "dropout_by_range.svg"));
}

/// Counts the pixels of a part of a picture.
template <typename IsIt>
std::size_t NumPixels(const DecodedImage<std::uint8_t>& picture,
                      std::size_t first_row,
                      std::size_t num_rows,
                      const IsIt& is_it) {
  std::size_t num = 0;
  for (std::size_t row = first_row; row < first_row + num_rows; ++row) {
    for (std::size_t column = 0; column < picture.size.width_px; ++column) {
      const std::size_t i = 3 * (row * picture.size.width_px + column);
      num +=
          is_it(std::array<int, 3>{picture.values[i], picture.values[i + 1], picture.values[i + 2]})
              ? 1
              : 0;
    }
  }
  return num;
}

// The straight line's clouds are ground, ballast, rails and sleepers in the colours of their
// labels; the camera's images are mostly sky.
TEST(StatsCommand, ShowsFramesOfEverySensorAndCamera) {
  const TemporaryFolder folder;
  const auto scenario = WriteScenario(
      folder, R"("camera": {"width_px": 64, "height_px": 48, "horizontal_fov_deg": 60},)");
  DoubleSensor(scenario);
  const auto run = scenario.parent_path() / "run";
  const auto out = scenario.parent_path() / "out";
  ASSERT_THAT(RunCommand(RAILCAST_GENERATE " sequence " + scenario.string() + " --out " +
                         run.string() + " --frames 2"),
              ExitsWith(0));
  ASSERT_THAT(Analyze("stats " + run.string() + " --out " + out.string()), ExitsWith(0));
  const std::string png = ReadFileWhole(out / "charts" / "sheet.png");
  const auto sheet = DecodePngRgb(png);
  EXPECT_EQ(sheet.size.width_px, 2U * 480U);
  ASSERT_EQ(sheet.size.height_px, 3U * 320U);
  const PlainJson labels = PlainJson::parse(ReadFileWhole(ScenariosDir() / "labels.json"));
  std::array<int, 3> ballast{};
  for (const PlainJson& label : labels["labels"]) {
    if (label["name"] == "ballast") ballast = label["rgb"].get<std::array<int, 3>>();
  }
  const auto is_ballast = [&](const auto& rgb) { return rgb == ballast; };
  // Images have 4:3, a third of each or more is sky.
  const auto is_sky = [](const auto& rgb) { return rgb[0] + rgb[1] + rgb[2] > 400; };
  // The camera's row is below that of the sensor with which its images are written.
  EXPECT_GT(NumPixels(sheet, 0, 320, is_ballast), 100U);
  EXPECT_EQ(NumPixels(sheet, 320, 320, is_ballast), 0U);
  EXPECT_GT(NumPixels(sheet, 320, 320, is_sky), 2U * 290U * 80U);
  EXPECT_GT(NumPixels(sheet, 640, 320, is_ballast), 100U);
  EXPECT_THAT(ReadFileWhole(out / "report.html"),
              HasSubstr("width=\"960\" height=\"960\" src=\"data:image/png;base64,iVBOR"));
}

// A scan four times as wide as it is high leaves no empty room above it.
TEST(StatsCommand, ShowsWideScansInLowRows) {
  const TemporaryFolder folder;
  const auto scenario = WriteScenario(folder);
  PlainJson wide = PlainJson::parse(ReadFileWhole(scenario));
  wide["lidar"]["scan"]["pattern"]["horizontal_fov_deg"] = 60;
  wide["lidar"]["scan"]["pattern"]["vertical_fov_deg"] = 15;
  wide["lidar"]["mount"]["pitch_deg"] = 10;
  WriteFileWhole(scenario, wide.dump());
  const auto run = scenario.parent_path() / "run";
  const auto out = scenario.parent_path() / "out";
  ASSERT_THAT(RunCommand(RAILCAST_GENERATE " sequence " + scenario.string() + " --out " +
                         run.string() + " --frames 1"),
              ExitsWith(0));
  ASSERT_EQ(Analyze("stats " + run.string() + " --out " + out.string()).status, 0);
  const auto sheet = DecodePngRgb(ReadFileWhole(out / "charts" / "sheet.png"));
  EXPECT_EQ(sheet.size.width_px, 480U);
  // A title of 30 pixels and a quarter of the width; perspective bends the rim of the scan.
  EXPECT_GT(sheet.size.height_px, 30U + 110U);
  EXPECT_LT(sheet.size.height_px, 30U + 180U);
}

TEST(StatsCommand, FailsWhereItsTextIsLost) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "");
  EXPECT_THAT(Analyze("stats " + sequence.string() + " --format text > /dev/full"),
              ExitsWith(1, "stdout: not all of it could be written\n"));
}

TEST(StatsCommand, GivesTheSameFiguresAtAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "");
  const auto json_of = [&](const std::string& threads) {
    PlainJson stats = StatsOf(sequence.string() + " --threads " + threads);
    stats.erase("command");  // The command line contains the number of threads.
    return stats.dump();
  };
  EXPECT_EQ(json_of("1"), json_of("2"));
}

TEST(StatsCommand, EstimatesWhatFilesWithoutOutcomesDoNotSay) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "--format ply --fields x,y,z,ring,column");
  ASSERT_THAT(Analyze("stats " + sequence.string() + " --format text"),
              ExitsWith(0, testing::AllOf(testing::Not(HasSubstr("Dropout, exact")),
                                          HasSubstr("Dropout, estimated"), HasSubstr("upright"))));
}

TEST(StatsCommand, ReadsOneFileOfASequence) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "");
  ASSERT_THAT(Analyze("stats " + (sequence / "frames" / "000003.pcd").string() + " --format text"),
              ExitsWith(0, HasSubstr("not enough (n = 1)")));
}

TEST(StatsCommand, RefusesWhatItCannotReadInOneLine) {
  const TemporaryFolder folder;
  EXPECT_THAT(Analyze("stats /no/such/place --format text"),
              ExitsWith(1, "/no/such/place: no such file or directory\n"));
  const auto broken = folder.Write("broken.pcd", "VERSION 0.7\nFIELDS x y z\n");
  const Ended damaged = Analyze("stats " + broken.string() + " --format text");
  EXPECT_EQ(damaged.status, 1);
  EXPECT_EQ(std::count(damaged.said.begin(), damaged.said.end(), '\n'), 1) << damaged.said;
  EXPECT_THAT(damaged.said, testing::StartsWith(broken.string() + ": "));
}

TEST(StatsCommand, AsksWhereTheReportGoes) {
  EXPECT_EQ(Analyze("stats somewhere").status, 2);
  EXPECT_EQ(Analyze("stats").status, 2);
}

TEST(StatsCommand, RefusesToSumUpLabelsOfTwoMeanings) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "");
  const auto other = sequence.parent_path() / "other";
  const auto labels = ScenariosDir() / "labels.json";
  folder.Write("labels.json", Replaced(ReadFileWhole(labels), "\"animal\"", "\"beast\""));
  const auto scenario =
      folder.Write("other.json", Replaced(ReadFileWhole(sequence.parent_path() / "scenario.json"),
                                          labels.string(), "labels.json"));
  ASSERT_EQ(RunCommand(RAILCAST_GENERATE " sequence " + scenario.string() + " --frames 1 --out " +
                       other.string())
                .status,
            0);
  EXPECT_THAT(Analyze("stats " + sequence.string() + " " + other.string() + " --format text"),
              ExitsWith(1, other.string() + ": must have the same labels and materials as " +
                               sequence.string() + "\n"));
}

TEST(StatsCommand, KeepsOutOfTheSequence) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "");
  for (const auto& out : {sequence, sequence / "stats"}) {
    EXPECT_THAT(
        Analyze("stats " + sequence.string() + " --out " + out.string()),
        ExitsWith(1, "--out: must be outside " + canonical(sequence).string() +
                         ", which holds nothing but what belongs to its frames.jsonl (got " +
                         out.string() + ")\n"));
  }
  EXPECT_THAT(Analyze("verify " + sequence.string()), ExitsWith(0));
}

// One sensor of 20 Hz without rings and one of 10 Hz with 16.
TEST(StatsCommand, SumsUpDifferentSensorsWithoutTheirRingsOrTakesOne) {
  const TemporaryFolder folder;
  const auto run = folder.Write("x", "").parent_path() / "run";
  const std::string scenario = (ScenariosDir() / "two_sensors.json").string();
  ASSERT_EQ(
      RunCommand(RAILCAST_GENERATE " sequence " + scenario + " --frames 4 --out " + run.string())
          .status,
      0);
  const PlainJson front = StatsOf((run / "front").string());
  const PlainJson roof = StatsOf((run / "roof").string());
  const PlainJson both = StatsOf(run.string());
  const auto fact = [](const PlainJson& stats, const std::string& name) {
    return std::stoul(stats.at("facts").at(name).get<std::string>());
  };
  EXPECT_EQ(fact(both, "Points"), fact(front, "Points") + fact(roof, "Points"));
  EXPECT_EQ(fact(both, "Frames"), 6U);
  EXPECT_EQ(both.at("facts").at("Sensors"),
            "front, roof, taken together; --sensor takes one of them");
  const PlainJson chosen = StatsOf(run.string() + " --sensor roof");
  EXPECT_EQ(chosen.at("sections"), roof.at("sections"));
  EXPECT_EQ(Analyze("stats " + run.string() + " --sensor back --format text").said,
            "--sensor: must be a sensor of " + run.string() + ", of front, roof (got back)\n");
  EXPECT_EQ(chosen.at("facts").at("Sensors"), "roof, chosen by --sensor");
  for (const char* table : {"rings", "dropout_by_ring", "holes_by_ring"}) {
    EXPECT_NO_THROW(static_cast<void>(JsonTableOf(roof, table))) << table;
    EXPECT_THROW(static_cast<void>(JsonTableOf(both, table)), std::out_of_range) << table;
  }
}

PlainJson WholeStatsOf(const std::filesystem::path& source) {
  const std::filesystem::path out = source.parent_path() / "out";
  EXPECT_THAT(Analyze("stats " + source.string() + " --out " + out.string()), ExitsWith(0));
  return PlainJson::parse(ReadFileWhole(out / "stats.json"));
}

TEST(StatsCommand, SumsUpADataSetAndShowsItsReportFirst) {
  const TemporaryFolder folder;
  const auto set = MakeSmallDataset(folder, "");
  const PlainJson stats = WholeStatsOf(set);
  EXPECT_EQ(stats["title"], "Statistics of set");
  EXPECT_EQ(stats["facts"]["Frames"], "6");
  EXPECT_EQ(stats["facts"]["Source"], set.string() + " (data set)");
  const PlainJson manifest = PlainJson::parse(ReadFileWhole(set / "manifest.json"));
  EXPECT_EQ(stats["facts"]["Data hash"], manifest["data_xxh3"]);
  EXPECT_EQ(stats["sections"][0]["key"], "sheet");
  EXPECT_EQ(stats["sections"][1]["key"], "dataset");
  EXPECT_EQ(stats["sections"][2]["key"], "classes");
  // The clouds hold what the generator counted.
  std::map<std::string, std::uint64_t> counted, found;
  for (const PlainJson& row : JsonTableOf(stats, "points_by_label")["rows"]) {
    found[row["label"]] = row["points"];
  }
  for (const PlainJson& row : JsonTableOf(stats, "dataset_classes")["rows"]) {
    counted[row["label"]] = row["points"];
  }
  EXPECT_EQ(found, counted);
  EXPECT_GT(found.size(), 1U);
}

TEST(StatsCommand, RefusesAnUnfinishedDataSetInOneLine) {
  const TemporaryFolder folder;
  const auto set = MakeSmallDataset(folder, "");
  std::filesystem::remove(set / "manifest.json");
  EXPECT_THAT(
      Analyze("stats " + set.string() + " --format text"),
      ExitsWith(1, set.string() +
                       ": must be a finished data set (got no manifest.json); the command that "
                       "began it, railcast-generate dataset, continues it\n"));
}

TEST(StatsCommand, SumsUpAShardWithoutASectionOfItsOwn) {
  const TemporaryFolder folder;
  const auto set = MakeSmallDataset(folder, "--shard 1/2");
  const PlainJson stats = WholeStatsOf(set);
  EXPECT_EQ(stats["facts"]["Frames"], "4");
  EXPECT_EQ(stats["facts"]["Source"], set.string() + " (shard 1/2 of a data set)");
  EXPECT_EQ(stats["sections"][0]["key"], "sheet");
  EXPECT_EQ(stats["sections"][1]["key"], "classes");
}

// Two runs joined as SemanticKITTI has its sequences.
TEST(StatsCommand, SumsUpAllKittiSequencesByTheNamesBesideThem) {
  const TemporaryFolder folder;
  const auto run = MakeSequence(folder, "--format kitti");
  const PlainJson one = StatsOf(run.string());
  const auto other = run.parent_path() / "other";
  std::filesystem::copy(run, other, std::filesystem::copy_options::recursive);
  const auto joined = run.parent_path() / "joined";
  ASSERT_THAT(
      RunCommand("/usr/bin/python3 " RAILCAST_SOURCE_DIR "/scripts/join_semantic_kitti.py " +
                 joined.string() + " --train " + run.string() + " --test " + other.string()),
      ExitsWith(0));
  const PlainJson both = StatsOf(joined.string());
  EXPECT_EQ(both["facts"]["Source"], joined.string() + " (KITTI data set of 2 sequences)");
  EXPECT_EQ(both["facts"]["Frames"], "22");
  const PlainJson& rows = JsonTableOf(one, "points_by_label")["rows"];
  const PlainJson& sums = JsonTableOf(both, "points_by_label")["rows"];
  ASSERT_EQ(rows.size(), sums.size());
  std::set<std::string> names;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    names.insert(sums[i]["label"].get<std::string>());
    EXPECT_EQ(sums[i]["points"], 2 * rows[i]["points"].get<std::uint64_t>());
    EXPECT_EQ(sums[i]["points_percent"], rows[i]["points_percent"]);
  }
  EXPECT_TRUE(names.contains("rail"));
  std::filesystem::remove(joined / "semantic-kitti-railcast.yaml");
  const PlainJson numbers = StatsOf(joined.string());
  EXPECT_EQ(JsonTableOf(numbers, "points_by_label")["rows"].size(), rows.size());
  for (const PlainJson& row : JsonTableOf(numbers, "points_by_label")["rows"]) {
    EXPECT_FALSE(names.contains(row["label"].get<std::string>()));
  }
}

// Of "000003.bin" and "./000003.bin" the folders above are not named.
TEST(StatsCommand, FindsWhatBelongsToAKittiCloudThatIsNamedFromItsOwnFolder) {
  const TemporaryFolder folder;
  const auto clouds = MakeSequence(folder, "--format kitti") / "sequences/00/velodyne";
  const auto rows_of = [&](const std::string& source) {
    const Ended run = RunCommand("cd " + clouds.string() + " && " RAILCAST_ANALYZE " stats " +
                                 source + " --format json");
    EXPECT_EQ(run.status, 0) << run.said;
    return JsonTableOf(PlainJson::parse(run.said), "points_by_label")["rows"];
  };
  const PlainJson expected = rows_of((clouds / "000003.bin").string());
  EXPECT_EQ(rows_of("000003.bin"), expected);
  EXPECT_EQ(rows_of("./000003.bin"), expected);
  EXPECT_EQ(rows_of("."), rows_of(clouds.string()));
}

TEST(StatsCommand, RefusesToCountTwice) {
  const TemporaryFolder folder;
  const auto sequence = MakeSequence(folder, "");
  const std::string again = sequence.string() + "/../sequence";
  EXPECT_THAT(Analyze("stats " + sequence.string() + " " + again + " --format text"),
              ExitsWith(1, again + ": must be named once\n"));
}

TEST(StatsCommand, ListsTheSensorsOfACaptureAndTakesTheOneThatIsChosen) {
  const TemporaryFolder folder;
  const MadeScan scan(ReadSensor("vlp16"));
  const Datagrams datagrams = EncodeAll("vlp16", scan, {scan.MakeFrame(0)});
  std::vector<CapturedFrame> frames;
  for (const auto& packet : DataPackets(datagrams)) {
    const std::string payload(packet.begin(), packet.end());
    for (const char host : {'\1', '\2', '\2'}) {
      frames.push_back({EthernetOf(IpOf(payload, host)), 1000 * frames.size()});
    }
  }
  const auto file = WriteCapture(folder.Write("x", "").parent_path() / "a.pcap", frames);
  const std::string stats = "stats " + file.string() + " --format json";
  EXPECT_THAT(Analyze(stats),
              ExitsWith(1, file.string() + ": holds 2 sensors: VLP-16 at 192.168.1.1, VLP-16 at " +
                               "192.168.1.2; --sensor picks one\n"));
  const Ended one = Analyze(stats + " --sensor 192.168.1.2 2>/dev/null");
  ASSERT_EQ(one.status, 0) << one.said;
  const PlainJson report = PlainJson::parse(one.said);
  const PlainJson& rows = JsonTableOf(report, "capture_sensors")["rows"];
  ASSERT_EQ(rows.size(), 2U);
  const std::size_t num_packets = DataPackets(datagrams).size();
  EXPECT_EQ(rows[0]["address"], "192.168.1.1");
  EXPECT_EQ(rows[0]["packets"], num_packets);
  EXPECT_EQ(rows[0]["doubled"], 0);
  EXPECT_EQ(rows[1]["sensor"], "VLP-16");
  EXPECT_EQ(rows[1]["ports"], "2368");
  EXPECT_EQ(rows[1]["doubled"], num_packets);
  EXPECT_EQ(rows[1]["lost"], 0);
}

class StatsOfCapture : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kCaptures + GetParam() + ".pcap")) {
      GTEST_SKIP() << "no real captures in " << kCaptures;
    }
  }
};

// Limits that hold for any scene of a real sensor: range noise on planes of millimetres to
// centimetres (data sheets: 2 to 3 cm), hardly any holes in surfaces, and not enough turns for a
// mean over frames.
TEST_P(StatsOfCapture, ArePlausible) {
  const PlainJson stats = StatsOf(kCaptures + GetParam() + ".pcap");
  int num_bins = 0;
  for (const PlainJson& row : JsonTableOf(stats, "temporal_noise")["rows"]) {
    const PlainJson& sigma_mm = row["robust_sigma_mm"];
    if (sigma_mm["value"].is_null() || sigma_mm["samples"] < 1000) continue;
    EXPECT_GT(sigma_mm["value"], 2.0);
    EXPECT_LT(sigma_mm["value"], 30.0);
    ++num_bins;
  }
  EXPECT_GT(num_bins, 1);
  const PlainJson& holes = JsonTableOf(stats, "grid")["rows"][1]["share_percent"];
  EXPECT_LT(holes["high"], 5.0);
  EXPECT_GT(holes["samples"], 10000);
  EXPECT_TRUE(JsonTableOf(stats, "frames")["rows"][0]["mean"]["value"].is_null());
}

INSTANTIATE_TEST_SUITE_P(Sensors,
                         StatsOfCapture,
                         testing::Values("vlp16_dual", "vlp32c_single", "pandar64"));

}  // namespace
}  // namespace railcast
