#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"
#include "tests/core/io/damage.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

using testing::HasSubstr;

using PlainJson = nlohmann::json;

TEST(RailcastAnalyze, KnowsItsVersionAndItsUse) {
  EXPECT_THAT(Analyze("--version").said, testing::StartsWith("railcast " RAILCAST_VERSION));
  EXPECT_THAT(Analyze("frontier --help").said, HasSubstr("--rows"));
  EXPECT_EQ(Analyze("").status, 2);
  EXPECT_EQ(Analyze("frontier").status, 2);
  EXPECT_EQ(Analyze("frontier a.json --out b --frames 0").status, 2);
}

TEST(RailcastAnalyze, TakesDecimalDigitsAloneForNumbers) {
  const auto fault_of = [](const std::string& arguments) {
    const Ended run = Analyze(arguments);
    EXPECT_EQ(run.status, 2) << arguments;
    return run.said.substr(0, run.said.find('\n'));
  };
  EXPECT_EQ(fault_of("frontier a.json --out b --frames 0x10"),
            "--frames: must be a whole number from 1 to 1000 (got 0x10)");
  EXPECT_EQ(fault_of("compare --ablate a.json --out b --seed -1"),
            "--seed: must be a whole number from 0 to 18446744073709551615 (got -1)");
  EXPECT_EQ(fault_of("receive --frames 1.5"),
            "--frames: must be a whole number from 1 to 18446744073709551615 (got 1.5)");
  EXPECT_EQ(fault_of("detect a --out b --points 1e3"),
            "--points: must be a whole number from 1 to 1000000 (got 1e3)");
  for (const std::string command : {"stats a", "fit a", "compare a b", "frontier a"}) {
    EXPECT_EQ(fault_of(command + " --out b --threads +1"),
              "--threads: must be a whole number from 0 to 1024 (got +1)");
  }
}

TEST(RailcastAnalyze, NamesAMisspeltCommandAndAnOptionWithoutAName) {
  EXPECT_THAT(Analyze("stat a").said,
              HasSubstr("unknown command, the nearest is \"stats\" (got stat)\n"));
  EXPECT_EQ(Analyze("stat a").status, 2);
  EXPECT_THAT(Analyze("stats a --out ''").said, HasSubstr("--out: must not be empty\n"));
  EXPECT_EQ(Analyze("stats a --out ''").status, 2);
  for (const std::string command : {"stats", "inspect", "compare a", "frontier", "study", "sight",
                                    "detect", "evaluate", "fit", "preset"}) {
    EXPECT_THAT(Analyze(command + " '' --out b"), ExitsWith(2, HasSubstr(": must not be empty\n")));
  }
}

TEST(RailcastAnalyze, NamesAnUnknownRowAndAMissingScenario) {
  EXPECT_EQ(Analyze("frontier a.json --out /tmp/none --rows best").status, 1);
  EXPECT_THAT(Analyze("frontier /no/such.json --out /tmp/none"),
              ExitsWith(1, HasSubstr("/no/such.json")));
}

// Whether the scenario is there is looked at later.
TEST(RailcastAnalyze, LooksAtTheFolderOfAReportBeforeAnythingElse) {
  const TemporaryFolder folder;
  const std::string file = folder.Write("file", "").string();
  for (const std::string command :
       {"frontier none.json", "compare --ablate none.json", "stats none", "inspect none",
        "detect none", "compare none none"}) {
    EXPECT_THAT(Analyze(command + " --out " + file), ExitsWith(1, file + ": not a directory\n"))
        << command;
  }
}

TEST(RailcastAnalyze, ChartsAScenario) {
  const TemporaryFolder folder;
  const auto scenario = WriteScenario(folder, "", "1.0");
  const auto out = scenario.parent_path() / "out";
  ASSERT_THAT(Analyze("frontier " + scenario.string() + " --out " + out.string() +
                      " --frames 1 --rows footprint,brute_force_4"),
              ExitsWith(0, HasSubstr("fidelity auto uses ")));
  const PlainJson json = PlainJson::parse(ReadFileWhole(out / "frontier.json"));
  ASSERT_EQ(json["rows"].size(), 3U);
  // Brute force with 4 rays misses more wires than the closed forms do.
  EXPECT_GT(json["rows"][2]["errors"]["thin_recall"]["num"], 0);
  EXPECT_GT(json["rows"][1]["errors"]["thin_recall"]["share"],
            json["rows"][2]["errors"]["thin_recall"]["share"]);
  ASSERT_EQ(json["sections"][0]["charts"].size(), 4U);
  // Only rows that were run stand in the legend.
  const PlainJson& series = json["sections"][0]["charts"][0]["series"];
  ASSERT_EQ(series.size(), 2U);
  EXPECT_EQ(series[0]["title"], "railcast");
  EXPECT_EQ(series[1]["title"], "brute force, rays a beam");
  for (const char* name : {"frontier.csv", "frontier.png", "frontier.svg", "frontier.gnuplot",
                           "report.html", "csv/found.csv", "charts/range_median_mm.svg",
                           "csv/by_range.csv", "charts/missed_percent_by_range.svg"}) {
    EXPECT_TRUE(std::filesystem::exists(out / name)) << name;
  }
}

TEST(RailcastAnalyze, LeavesTheNumbersWhereGnuplotIsMissing) {
  const TemporaryFolder folder;
  const auto scenario = WriteScenario(folder, "", "2.0");
  const auto out = scenario.parent_path() / "out";
  EXPECT_THAT(RunCommand("PATH=/nowhere " RAILCAST_ANALYZE " frontier " + scenario.string() +
                         " --out " + out.string() + " --frames 1 --rows geometry"),
              ExitsWith(1, testing::EndsWith("gnuplot: not found; install gnuplot-nox (the numbers "
                                             "are written)\n")));
  EXPECT_TRUE(std::filesystem::exists(out / "frontier.json"));
  EXPECT_FALSE(std::filesystem::exists(out / "frontier.png"));
}

// Of PCL's libraries, those that read files, draw or register depend on VTK, which is most of what
// a user would install, or take longer to load than a short report takes to be made.
TEST(RailcastAnalyze, LoadsOfPclOnlyWhatNeedsNoFurtherPackages) {
  const Ended run = RunCommand("ldd " RAILCAST_ANALYZE);
  EXPECT_EQ(run.status, 0);
  EXPECT_NE(run.said.find("libembree"), std::string::npos) << run.said;
  EXPECT_NE(run.said.find("libpcl_common"), std::string::npos) << run.said;
  for (const std::string library :
       {"libpcl_io", "libpcl_filters", "libpcl_features", "libpcl_segmentation",
        "libpcl_registration", "libpcl_visualization", "libvtk", "libgdal"}) {
    EXPECT_EQ(run.said.find(library), std::string::npos) << run.said;
  }
}

/// Two points without rings.
std::string WriteCloud(const TemporaryFolder& folder) {
  return folder
      .Write("cloud.pcd",
             "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\n"
             "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n1 2 3\n4 5 6\n")
      .string();
}

TEST(InspectCommand, EndsWithStatusOneWhereTheRecordingIsNotFitForTheJob) {
  const TemporaryFolder folder;
  const std::string cloud = WriteCloud(folder);
  EXPECT_THAT(Analyze("inspect " + cloud + " --format text --for view"), ExitsWith(0));
  EXPECT_THAT(
      Analyze("inspect " + cloud + " --format text --for weather"),
      ExitsWith(1, HasSubstr("cloud.pcd: is not fit for weather: its firings are not known")));
  EXPECT_THAT(Analyze("inspect " + cloud + " --format text --for dinner"), ExitsWith(2));
}

TEST(InspectCommand, WritesAPageAndJson) {
  const TemporaryFolder folder;
  const std::string cloud = WriteCloud(folder);
  const std::filesystem::path out = std::filesystem::path(cloud).parent_path() / "out";
  ASSERT_THAT(Analyze("inspect " + cloud + " --out " + out.string()), ExitsWith(0));
  EXPECT_TRUE(exists(out / "report.html"));
  const nlohmann::json report = nlohmann::json::parse(ReadFileWhole(out / "inspect.json"));
  EXPECT_EQ(report.at("sections").at(0).at("key"), "jobs");
  EXPECT_TRUE(report.at("remarks").is_array());
}

TEST(InspectCommand, DoesNotWriteTheSensorOverTheRecording) {
  const TemporaryFolder folder;
  const std::string cloud = WriteCloud(folder);
  const std::string text = ReadFileWhole(cloud);
  EXPECT_THAT(Analyze("inspect " + cloud + " --format text --sensor-file " + cloud),
              ExitsWith(1, "--sensor-file: must not be SOURCE or in it (got " + cloud + ")\n"));
  EXPECT_EQ(ReadFileWhole(cloud), text);
}

TEST(StatsCommand, SaysThatAPipeIsNoRecording) {
  const TemporaryFolder folder;
  EXPECT_THAT(RunCommand("cat " + WriteCloud(folder) +
                         " | " RAILCAST_ANALYZE " stats /dev/stdin --format text"),
              ExitsWith(1, testing::StartsWith("/dev/stdin: must be a directory or a .pcd")));
}

TEST(StatsCommand, SaysThatThereIsNoFolderToDrawIn) {
  const TemporaryFolder folder;
  const std::string cloud = WriteCloud(folder);
  EXPECT_THAT(RunCommand("TMPDIR=/nonexistent " RAILCAST_ANALYZE " stats " + cloud + " --out " +
                         cloud + ".out"),
              ExitsWith(1, testing::EndsWith("TMPDIR: must be a folder, in which charts are "
                                             "drawn\n")));
}

TEST(InspectCommand, TellsTheSensorOfACloudThatAnotherDecoderMade) {
  const std::string cloud = RAILCAST_SHARED_DATA_DIR "/lidar_hesai_more/40p_decoded.pcd";
  if (!std::filesystem::exists(cloud)) GTEST_SKIP() << cloud << " is not there";
  ASSERT_THAT(Analyze("inspect " + cloud + " --format text"), ExitsWith(0, HasSubstr("Pandar40P")));
}

TEST(VerifyCommand, SaysALineForEveryFaultAndEndsWithOne) {
  for (const std::string format : {"pcd", "kitti"}) {
    const TemporaryDirectory directory;
    const std::string scenario = MakeProject(directory.path() / "project").string();
    const auto out = directory.path() / "out";
    ASSERT_EQ(RunCommand(RAILCAST_GENERATE " sequence " + scenario + " --frames 2 --out " +
                         out.string() + " --format " + format)
                  .status,
              0);
    EXPECT_THAT(Analyze("verify " + out.string()),
                ExitsWith(0, testing::StartsWith(out.string() + ": whole; read 2 frames in ")));
    const auto file =
        out / (format == "kitti" ? "sequences/00/velodyne/000001.bin" : "frames/000001.pcd");
    const std::string bytes = ReadFileWhole(file);
    WriteFileWhole(file, Flipped(bytes, bytes.size() - 5));
    WriteFileWhole(out / "letter.txt", "dear");
    EXPECT_THAT(
        Analyze("verify " + out.string()),
        ExitsWith(1, testing::MatchesRegex(file.string() +
                                           ": must have the hash [0-9a-f]+, as frames.jsonl "
                                           "says \\(got [0-9a-f]+\\)\n" +
                                           out.string() +
                                           "/letter.txt: is named neither in manifest.json nor in "
                                           "frames.jsonl\n" +
                                           out.string() +
                                           ": 2 faults; read 2 frames in [0-9]+ files, "
                                           "[0-9.]+ MB\n")));
    // The message that every reader of sequences gives.
    EXPECT_THAT(Analyze("stats " + out.string() + " --format text"),
                ExitsWith(1, testing::StartsWith(file.string() + ": must have the hash ")));
  }
}

TEST(VerifyCommand, KnowsTheImagesOfACamera) {
  for (const std::string format : {"pcd", "kitti"}) {
    const TemporaryDirectory directory;
    (void)MakeProject(directory.path() / "project");
    const auto scenario = directory.path() / "project/camera.json";
    WriteFileWhole(scenario, R"({
      "version": 1,
      "file": "scenario.json",
      "camera": {"name": "front", "width_px": 40, "height_px": 30, "horizontal_fov_deg": 60,
                 "rate_hz": 5}
    })");
    const auto out = directory.path() / "out";
    ASSERT_THAT(RunCommand(RAILCAST_GENERATE " sequence " + scenario.string() +
                           " --frames 3 --out " + out.string() + " --format " + format),
                ExitsWith(0));
    EXPECT_THAT(Analyze("verify " + out.string()), ExitsWith(0));
    // Every second frame has an image, whatever number its files have.
    EXPECT_TRUE(std::filesystem::exists(out / "camera/front/depth/000002.npy"));
    EXPECT_FALSE(std::filesystem::exists(out / "camera/front/depth/000001.npy"));
    // Reports on clouds are not concerned.
    EXPECT_EQ(Analyze("stats " + out.string() + " --format text").status, 0);
    const auto image = out / "camera/front/label/000002.png";
    std::filesystem::remove(image);
    EXPECT_THAT(Analyze("verify " + out.string()),
                ExitsWith(1, testing::StartsWith(image.string() + ": no such file")));
  }
}

// Whatever is in the folder, and also where the link leads to what was there.
TEST(VerifyCommand, RefusesLinks) {
  const TemporaryDirectory directory;
  const auto out = directory.path() / "out";
  std::filesystem::create_directories(out / "worst/000003");
  WriteFileWhole(out / "study.json", "{}");
  std::filesystem::create_symlink("../../study.json", out / "worst/000003/a.json");
  EXPECT_THAT(Analyze("verify " + out.string()),
              ExitsWith(1, out.string() + "/worst/000003/a.json: must not be a symbolic link\n"));
}

TEST(VerifyCommand, WantsADirectoryOfASequence) {
  EXPECT_EQ(Analyze("verify").status, 2);
  const TemporaryDirectory directory;
  const std::string folder = directory.path().string();
  EXPECT_THAT(Analyze("verify " + folder),
              ExitsWith(1, folder + ": must be a folder that railcast wrote (got another)\n"));
  WriteFileWhole(directory.path() / "a.pcd", "");
  EXPECT_THAT(Analyze("verify " + folder + "/a.pcd"),
              ExitsWith(1, folder + "/a.pcd: must be a folder that railcast wrote (got a file)\n"));
  EXPECT_THAT(Analyze("verify " + folder + "/b"),
              ExitsWith(1, folder + "/b/run.json: no such file or directory\n"));
}

}  // namespace
}  // namespace railcast
