#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/extras/survey/survey_file.h"
#include "core/io/content_hash.h"
#include "core/io/run/run_folder.h"
#include "core/io/verify/verification.h"
#include "core/io/write_file.h"
#include "core/scenario/json_text.h"
#include "generator/extras/survey/survey_beams.h"
#include "railcast/scenario.h"
#include "tests/core/io/cloud/made_las.h"
#include "tests/core/io/recording/made_sequence.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

/// A square of ground as a cloud in the axes of a national grid.
std::string GroundCloud() {
  constexpr int kEdge = 30;
  std::string ply = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(kEdge * kEdge) +
                    "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  for (int i = 0; i < kEdge * kEdge; ++i) {
    ply += std::to_string(3'400'000.0 + 0.1 * (i % kEdge)) + " " +
           std::to_string(5'800'000.0 + 0.1 * (i / kEdge)) + " 412.5\n";
  }
  return ply;
}

TEST(SurveyCommand, TakesACloudInTheWorldsAxes) {
  const TemporaryDirectory directory;
  WriteFileWhole(directory.path() / "ground.ply", GroundCloud());
  EXPECT_THAT(Generate("survey " + (directory.path() / "ground.ply").string() +
                       " --world-axes --out " + (directory.path() / "out").string()),
              ExitsWith(0));
  const SurveyFile file(directory.path() / "out" / "scene.survey");
  EXPECT_EQ(file.num_surfels(), 900U);
  const auto cell = SurveyCellAt({3'400'001.0, 5'800'001.0});
  for (const SurveyTile& tile : file.tiles()) {
    if (tile.cell != cell) continue;
    EXPECT_NEAR(GroundHeight_m(tile, {3'400'001.0, 5'800'001.0}).value(), 412.5, 1e-3);
  }
  EXPECT_FALSE(exists(directory.path() / "out" / "world.json"));
}

TEST(SurveyCommand, WaitsForNoOtherRunInItsFolder) {
  const TemporaryDirectory directory;
  WriteFileWhole(directory.path() / "ground.ply", GroundCloud());
  const std::string out = (directory.path() / "out").string();
  const std::string command =
      "survey " + (directory.path() / "ground.ply").string() + " --world-axes --out " + out;
  {
    const FolderLock lock(out);
    EXPECT_THAT(Generate(command), ExitsWith(1, out + ": another run is writing here\n"));
    EXPECT_TRUE(is_empty(directory.path() / "out"));
  }
  EXPECT_THAT(Generate(command), ExitsWith(0));
}

// A class of LAS becomes the label that scenarios have for the same thing.
TEST(SurveyCommand, TakesPointsAndClassesOfLas) {
  const TemporaryDirectory directory;
  const MadeLas made{.minor_version = 4, .format = 6};
  std::string las = made.Bytes(900);
  for (std::size_t i = 0; i < 900; ++i) {
    char* const point = &las[made.points_begin() + 30 * i];
    const std::array<std::int32_t, 3> position_mm = {static_cast<std::int32_t>(100 * (i % 30)),
                                                     static_cast<std::int32_t>(100 * (i / 30)), 0};
    std::memcpy(point, position_mm.data(), sizeof position_mm);
    point[16] = 11;
  }
  WriteFileWhole(directory.path() / "road.las", las);
  EXPECT_THAT(Generate("survey " + (directory.path() / "road.las").string() +
                       " --world-axes --out " + (directory.path() / "out").string()),
              ExitsWith(0));
  const SurveyFile file(directory.path() / "out" / "scene.survey");
  EXPECT_EQ(file.num_surfels(), 900U);
  EXPECT_EQ(file.labels().back(), "road");
}

// The first file's intensities alone would fit a byte.
TEST(SurveyCommand, TakesOneScaleOfIntensitiesForAllFiles) {
  const TemporaryDirectory directory;
  create_directory(directory.path() / "site");
  const auto write = [&](const std::string& name, std::uint16_t intensity, std::int32_t east_mm) {
    const MadeLas made;
    std::string las = made.Bytes(900);
    for (std::size_t i = 0; i < 900; ++i) {
      const auto step = static_cast<std::int32_t>(i);
      const std::size_t point = made.points_begin() + 20 * i;
      PutNumber(las, point, east_mm + 100 * (step % 30));
      PutNumber(las, point + 4, 100 * (step / 30));
      PutNumber(las, point + 12, intensity);
    }
    WriteFileWhole(directory.path() / "site" / name, las);
  };
  write("0.las", 200, 0);
  write("1.las", 32'768, 50'000);
  EXPECT_THAT(Generate("survey " + (directory.path() / "site").string() + " --world-axes --out " +
                       (directory.path() / "out").string()),
              ExitsWith(0, testing::HasSubstr(
                               "white surfaces are taken to have an intensity of 65535, by the "
                               "highest one of all files; --white says it\n")));
  SurveySource source{.recordings = {directory.path() / "site"}, .is_in_world = true};
  source.guessed_white = GuessWhite(source).value();
  SurveyLabels labels;
  std::vector<float> reflectances;
  VisitFrames(source, labels, [&](const SurveyFrame& frame) {
    reflectances.push_back(frame.beams.front().reflectance);
  });
  EXPECT_THAT(reflectances, testing::ElementsAre(testing::FloatEq(200.0F / 65535.0F),
                                                 testing::FloatEq(32768.0F / 65535.0F)));
}

/// Makes one frame of a scenario of the folder as the sequence `name`.
Ended MakeSurveyed(const std::filesystem::path& folder,
                   const std::string& scenario,
                   const std::string& name) {
  const std::string scenarios = RAILCAST_SOURCE_DIR "/scenarios/";
  WriteFileWhole(folder / "site.json",
                 R"({"version": 1, "lidar": {"file": ")" + scenarios +
                     R"(sensors/vlp16.json"}, "world": "out/world.json", "vehicle": )" +
                     R"({"start_s_m": 60}, "materials": ")" + scenarios +
                     R"(materials/railway.json", "labels": ")" + scenarios + R"(labels.json"})");
  return Generate("sequence " + (folder / scenario).string() + " --frames 1 --out " +
                  (folder / name).string() + " 2>&1");
}

/// Level squares about a sensor: half an edge, and the distance below the sensor.
struct LevelSquare {
  double half_m, below_m;
  double ahead_m = 0.0;    ///< Of the middle.
  double slope = 0.0;      ///< Upward ahead.
  double nearest_m = 0.0;  ///< Nearer places are hidden.
};

/// Surveys one cloud of a sensor that stood.
Ended SurveyStanding(const std::filesystem::path& folder,
                     const std::vector<LevelSquare>& squares,
                     const std::string& options = "") {
  std::string points;
  std::size_t num = 0;
  for (const LevelSquare& square : squares) {
    constexpr double kStep_m = 0.2;
    const int most = static_cast<int>(square.half_m / kStep_m);
    for (int i = -most; i <= most; ++i) {
      for (int k = -most; k <= most; ++k) {
        const double x_m = square.ahead_m + kStep_m * i;
        const double y_m = kStep_m * k;
        if (std::hypot(x_m, y_m) < square.nearest_m) continue;
        points += NumberText(x_m) + " " + NumberText(y_m) + " " +
                  NumberText(square.slope * x_m - square.below_m) + "\n";
        ++num;
      }
    }
  }
  WriteFileWhole(folder / "cloud.ply", "ply\nformat ascii 1.0\nelement vertex " +
                                           std::to_string(num) +
                                           "\nproperty float x\nproperty float y\n"
                                           "property float z\nend_header\n" +
                                           points);
  return Generate("survey " + (folder / "cloud.ply").string() + " --standing" + options +
                  " --out " + (folder / "out").string() + " 2>&1");
}

TEST(SurveyCommand, WritesAWorldOfASensorThatStood) {
  const TemporaryDirectory directory;
  EXPECT_THAT(
      SurveyStanding(directory.path(), {{.half_m = 8.0, .below_m = 2.0}}),
      ExitsWith(0, testing::HasSubstr("top of rail is taken to be 2 m below the sensor\n"
                                      "the line begins 60 m before the first frame's place")));
  const Json world = Json::parse(ReadFileWhole(directory.path() / "out" / "world.json"));
  EXPECT_EQ(world.at("survey"), "scene.survey");
  EXPECT_NEAR(world.at("alignment").at("origin_m").at(2).get<double>(), -2.0, 1e-3);
  EXPECT_THAT(MakeSurveyed(directory.path(), "site.json", "made"), ExitsWith(0));
}

TEST(SurveyCommand, RefusesAStandingSensorThatSawNothingNear) {
  const TemporaryDirectory directory;
  WriteFileWhole(directory.path() / "ground.ply", GroundCloud());
  EXPECT_THAT(Generate("survey " + (directory.path() / "ground.ply").string() +
                       " --standing --out " + (directory.path() / "out").string() + " 2>&1"),
              ExitsWith(1, testing::HasSubstr("the survey: must have surfaces (got ")));
}

// Roofs of any size that carry the sensor, on level and on sloping ground, with the ground below
// the sensor hidden.
TEST(SurveyCommand, TakesTheGroundForTheRailAndNotTheRoofBelowTheSensor) {
  for (const double roof_below_m : {0.115, 0.4, 0.9}) {
    for (const double slope : {0.0, 0.05}) {
      const TemporaryDirectory directory;
      const Ended ended = SurveyStanding(
          directory.path(), {{.half_m = 1.4, .below_m = roof_below_m},
                             {.half_m = 10.0, .below_m = 1.95, .slope = slope, .nearest_m = 4.0}});
      EXPECT_THAT(ended, ExitsWith(0, testing::ContainsRegex(
                                          "top of rail is taken to be 1\\.9[45][0-9]* m below")));
    }
  }
}

TEST(SurveyCommand, AsksForTheHeightWhereTwoLevelAreasCompete) {
  const TemporaryDirectory directory;
  const std::vector<LevelSquare> track_and_platform = {
      {.half_m = 6.0, .below_m = 3.0, .ahead_m = 6.0},
      {.half_m = 5.4, .below_m = 2.04, .ahead_m = -6.6}};
  EXPECT_THAT(SurveyStanding(directory.path(), track_and_platform),
              ExitsWith(1, testing::MatchesRegex(
                               "--sensor-height: must be given, since two level areas could be "
                               "that of the track: one 3 m below the sensor \\([0-9.]+ m2 of it "
                               "seen\\) and one 2.04 m below the sensor \\([0-9.]+ m2 of it "
                               "seen\\) \\(got none\\)\n")));
  EXPECT_FALSE(exists(directory.path() / "out" / "scene.survey"));
  EXPECT_THAT(SurveyStanding(directory.path(), track_and_platform, " --sensor-height 3"),
              ExitsWith(0, testing::HasSubstr("top of rail is taken to be 3 m below the sensor")));
}

TEST(SurveyCommand, SaysThatPosesAreMissing) {
  const TemporaryDirectory directory;
  WriteFileWhole(directory.path() / "ground.ply", GroundCloud());
  EXPECT_THAT(
      Generate("survey " + (directory.path() / "ground.ply").string() + " --out " +
               (directory.path() / "out").string() + " 2>&1"),
      ExitsWith(
          1,
          testing::HasSubstr(
              "has no pose; must be given with --poses, with --standing if the "
              "sensor did not move, or with --world-axes if the points are in the world's axes")));
}

constexpr const char* kTwoPoses = "1 0 0 100 0 1 0 20 0 0 1 7\n1 0 0 104 0 1 0 20 0 0 1 7\n";

/// Two clouds of the same square of ground 2 m below the sensor, from so far ahead of it on, and a
/// file of poses.
std::string WriteGroundSeenTwice(const std::filesystem::path& folder,
                                 const std::string& poses,
                                 double ahead_m = -1.0) {
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 400\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n";
  for (int i = 0; i < 400; ++i) {
    ply += NumberText(ahead_m + 0.1 * (i % 20)) + " " + NumberText(0.1 * (i / 20)) + " -2\n";
  }
  create_directory(folder / "clouds");
  WriteFileWhole(folder / "clouds" / "0.ply", ply);
  WriteFileWhole(folder / "clouds" / "1.ply", ply);
  WriteFileWhole(folder / "poses.txt", poses);
  return "survey " + (folder / "clouds").string() + " --poses " + (folder / "poses.txt").string() +
         " --out " + (folder / "out").string() + " 2>&1";
}

TEST(SurveyCommand, TakesPosesOfAFile) {
  const TemporaryDirectory directory;
  const Ended ended = Generate(WriteGroundSeenTwice(directory.path(), kTwoPoses));
  EXPECT_EQ(ended.status, 0) << ended.said;
  EXPECT_TRUE(exists(directory.path() / "out" / "world.json"));
  const SurveyFile file(directory.path() / "out" / "scene.survey");
  EXPECT_EQ(file.num_surfels(), 800U);
  for (const double x_m : {100.0, 104.0}) {
    const Eigen::Vector2d place_m(x_m, 21.0);
    for (const SurveyTile& tile : file.tiles()) {
      if (tile.cell != SurveyCellAt(place_m)) continue;
      EXPECT_NEAR(GroundHeight_m(tile, place_m).value(), 5.0, 1e-3);
    }
  }
  EXPECT_THAT(ended.said, testing::HasSubstr("top of rail is taken to be 2 m below the sensor"));
}

TEST(SurveyCommand, AsksForTheSensorsHeightWhereNoGroundWasSeenBelowTheWay) {
  const TemporaryDirectory directory;
  // Without a place below which there is ground: 1 m ahead is more than a cell of 0.5 m.
  const std::string command = WriteGroundSeenTwice(directory.path(), kTwoPoses, 1.0);
  EXPECT_THAT(
      Generate(command),
      ExitsWith(
          1,
          "--sensor-height: must be given, since no ground was seen below the sensor's way by "
          "which to tell the top of rail (got none)\n"));
  EXPECT_FALSE(exists(directory.path() / "out" / "scene.survey"));
  EXPECT_THAT(
      Generate(command + " --sensor-height 1.5"),
      ExitsWith(0, testing::HasSubstr("top of rail is taken to be 1.5 m below the sensor")));
}

TEST(SurveyCommand, MakesScenesThatSequencesKeep) {
  const TemporaryDirectory directory;
  ASSERT_EQ(Generate(WriteGroundSeenTwice(directory.path(), kTwoPoses)).status, 0);
  const auto make = [&](const std::string& scenario, const std::string& name) {
    EXPECT_THAT(MakeSurveyed(directory.path(), scenario, name), ExitsWith(0));
    return directory.path() / name;
  };
  const auto first = make("site.json", "first");
  std::filesystem::remove_all(directory.path() / "out");
  const auto again = make("first/scenario.resolved.json", "again");
  for (const std::string name : {"frames/000000.pcd", "scenario.resolved.json", "manifest.json"}) {
    EXPECT_EQ(ReadFileWhole(again / name), ReadFileWhole(first / name)) << name;
  }
}

TEST(SurveyCommand, TakesTheRailsOfASequenceFromItsVehicle) {
  const TemporaryDirectory directory;
  (void)MakeSequence(directory.path() / "run", {.object = ""});
  const Ended ended = Generate("survey " + (directory.path() / "run").string() + " --out " +
                               (directory.path() / "out").string());
  EXPECT_EQ(ended.status, 0) << ended.said;
  EXPECT_THAT(ended.said, testing::HasSubstr("the line begins "));
  EXPECT_THAT(ended.said, testing::Not(testing::HasSubstr("top of rail is taken")));
}

TEST(SurveyCommand, KeepsOutOfTheRecording) {
  const TemporaryDirectory directory;
  const auto run = std::filesystem::canonical(directory.path()) / "run";
  (void)MakeSequence(run, {.object = ""});
  WriteFileWhole(run / "frames.jsonl", "");
  EXPECT_THAT(
      Generate("survey " + run.string() + " --out " + (run / "out").string()),
      ExitsWith(1, testing::StartsWith("--out: must be outside " + run.string() + ", which ")));
  EXPECT_FALSE(exists(run / "out"));
}

TEST(SurveyCommand, RecordsWhatTheSurveyIsMadeOf) {
  const TemporaryDirectory directory;
  ASSERT_EQ(Generate(WriteGroundSeenTwice(directory.path(), kTwoPoses)).status, 0);
  const auto record = Json::parse(ReadFileWhole(directory.path() / "out" / "survey.json"));
  const auto& made_of = record.at("made_of").at(0);
  EXPECT_EQ(made_of.at("name"), "clouds");
  EXPECT_EQ(made_of.at("files"), 2);
  const std::string cloud = HashFile(directory.path() / "clouds" / "0.ply").hash;
  EXPECT_EQ(made_of.at("xxh3"), ContentHash("0.ply\n" + cloud + "\n1.ply\n" + cloud + "\n"));
  EXPECT_EQ(record.at("poses").at("name"), "poses.txt");
  EXPECT_EQ(record.at("sensor_height_m"), 2.0);
}

TEST(SurveyCommand, MakesSurveysOfWhichNoChangedByteGoesUnnoticed) {
  const TemporaryDirectory directory;
  ASSERT_EQ(Generate(WriteGroundSeenTwice(directory.path(), kTwoPoses)).status, 0);
  const auto out = directory.path() / "out";
  const Verification whole = VerifySurvey(out);
  EXPECT_THAT(whole.faults, testing::IsEmpty());
  EXPECT_EQ(whole.num_files, 3U);
  std::string scene = ReadFileWhole(out / "scene.survey");
  const std::string hash = ContentHash(scene);
  scene.back() = static_cast<char>(scene.back() ^ 1);
  WriteFileWhole(out / "scene.survey", scene);
  const std::string fault = (out / "scene.survey").string() + ": must have the hash " + hash +
                            ", as survey.json says (got " + ContentHash(scene) + ")";
  EXPECT_THAT(VerifySurvey(out).faults, testing::ElementsAre(fault));
  EXPECT_THAT(MakeSurveyed(directory.path(), "site.json", "made"), ExitsWith(1, fault + "\n"));
  std::filesystem::remove(out / "survey.json");
  EXPECT_THAT(VerifySurvey(out).faults,
              testing::ElementsAre((out / "survey.json").string() +
                                   ": missing: the survey is unfinished, or of an older program"));
}

TEST(SurveyCommand, RefusesPosesThatAreNotThoseOfTheFrames) {
  const std::string pose = "1 0 0 100 0 1 0 20 0 0 1 7\n";
  const auto said = [](const std::string& poses) {
    const TemporaryDirectory directory;
    const Ended ended = Generate(WriteGroundSeenTwice(directory.path(), poses));
    EXPECT_EQ(ended.status, 1);
    EXPECT_FALSE(exists(directory.path() / "out" / "scene.survey"));
    return ended.said;
  };
  EXPECT_THAT(said(pose), testing::HasSubstr("poses.txt: must have a pose for each frame (got 1 "
                                             "poses and more frames)"));
  EXPECT_THAT(
      said(pose + pose + pose),
      testing::HasSubstr("poses.txt: must have a pose for each frame (got 3 poses and 2 frames)"));
  EXPECT_THAT(said(pose + "1 2 3\n"),
              testing::HasSubstr("poses.txt:2: must be the 12 numbers of a pose"));
}

TEST(SurveyCommand, HoldsTimesOfPosesAgainstThoseOfFrames) {
  const auto survey = [](const std::string& first_s, const std::string& second_s) {
    const TemporaryDirectory directory;
    const std::string command = WriteGroundSeenTwice(
        directory.path(), first_s + " 100 20 7 0 0 0 1\n" + second_s + " 104 20 7 0 0 0 1\n");
    const auto clouds = directory.path() / "clouds";
    rename(clouds / "0.ply", clouds / "100.0.ply");
    rename(clouds / "1.ply", clouds / "400.0.ply");
    return Generate(command);
  };
  EXPECT_THAT(survey("100", "400").said, testing::Not(testing::HasSubstr("remark")));
  EXPECT_THAT(survey("5000", "5300"),
              ExitsWith(0, testing::HasSubstr("remark times-relative: 2 frames")));
  EXPECT_THAT(survey("100", "280").said,
              testing::HasSubstr("must be as long after the first as those of the frames (got 180 "
                                 "s for frame 1, which came after 300 s)"));
}

}  // namespace
}  // namespace railcast
