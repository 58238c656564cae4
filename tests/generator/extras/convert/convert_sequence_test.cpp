#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <thread>
#include <tuple>

#include "core/extras/recipe/dataset_verification.h"
#include "core/io/record/record_text.h"
#include "core/io/run/frame_record.h"
#include "core/io/verify/verification.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/convert/converted.h"
#include "tests/generator/extras/dataset/dataset_project.h"
#include "tests/generator/extras/insert/run/made_insertion.h"
#include "tests/generator/run_command.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// From a format to another.
class ConvertedSequence : public testing::TestWithParam<std::tuple<const char*, const char*>> {
 protected:
  [[nodiscard]] fs::path Path(const std::string& name) const { return folder_.path() / name; }

  const TemporaryDirectory folder_;
};

TEST_P(ConvertedSequence, IsTheOneThatItsRunWouldHaveWritten) {
  const auto [from, to] = GetParam();
  (void)MakeSequence(Path("from"), RunWith(from, kBox));
  (void)MakeSequence(Path("to"), RunWith(to, kBox));
  if (std::string(to) == "kitti") {  // RunWith() puts those of KITTI onto their beams.
    fs::remove_all(Path("to"));
    MadeSequenceSpec made = RunWith(from, kBox);
    made.format = to;
    (void)MakeSequence(Path("to"), made);
  }
  EXPECT_TRUE(
      ConvertAll({.recording = Path("from"), .directory = Path("out"), .format = to}).is_complete);
  EXPECT_EQ(FilesOf(Path("out")), FilesOf(Path("to")));
  EXPECT_THAT(VerifySequence(Path("out"), [](double) {}).faults, testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Formats,
                         ConvertedSequence,
                         testing::Values(std::tuple{"pcd", "pcd-compressed"},
                                         std::tuple{"pcd-compressed", "pcd-ascii"},
                                         std::tuple{"pcd-ascii", "pcd"},
                                         std::tuple{"pcd", "ply"},
                                         std::tuple{"ply", "ply-cloudcompare"},
                                         std::tuple{"ply-cloudcompare", "ply"},
                                         std::tuple{"pcd", "kitti"},
                                         std::tuple{"ply", "kitti"}));

TEST(ConvertSequence, TellsWhatTheFormatHasNoPlaceFor) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  MadeSequenceSpec made{.fields = "x,y,z,intensity,ring,label"};
  const MadeSequence truth = MakeSequence(run, made);
  std::uint64_t num_points = 0;
  std::uint64_t num_absent = 0;
  for (const Frame& frame : truth.frames) {
    for (const Outcome outcome : frame.outcome) ++(HasPoint(outcome) ? num_points : num_absent);
  }
  const auto lost_in = [&](const std::string& format) {
    return ConvertAll({.recording = run, .directory = folder.path() / format, .format = format})
        .lost;
  };
  EXPECT_EQ(lost_in("pcd-ascii"), Losses());
  EXPECT_EQ(lost_in("ply"), (Losses{{"firings without a point", num_absent}}));
  EXPECT_EQ(lost_in("kitti"),
            (Losses{{"firings without a point", num_absent}, {"values of ring", num_points}}));
}

TEST(ConvertSequence, TakesMoreThreadsThanThereAreCores) {
  const TemporaryDirectory folder;
  (void)MakeSequence(folder.path() / "run", {});
  EXPECT_THAT(Generate("convert " + (folder.path() / "run").string() + " " +
                       (folder.path() / "out").string() + " --frames 0 --threads " +
                       std::to_string(std::thread::hardware_concurrency() + 6)),
              ExitsWith(0, testing::AllOf(testing::HasSubstr("1 frame in format pcd\n"),
                                          testing::Not(testing::HasSubstr("TBB")))));
}

TEST(ConvertSequence, DoesNotSayWhyFiringsHaveNoPointWhereTheRecordingDoesNot) {
  const TemporaryDirectory folder;
  const auto path = [&](const std::string& name) { return folder.path() / name; };
  MadeSequenceSpec made{.format = "ply"};
  (void)MakeSequence(path("ply"), made);
  const ConvertResult result =
      ConvertAll({.recording = path("ply"), .directory = path("pcd"), .format = "pcd"});
  EXPECT_THAT(result.lost,
              testing::ElementsAre(testing::Key("values of outcome, not known without a point")));
  std::vector<RecordedFrame> expected = ReadAll(path("ply"));
  for (RecordedFrame& recorded : expected) recorded.fields.erase("outcome");
  ExpectSameFrames(ReadAll(path("pcd")), expected);
}

TEST(ConvertSequence, GivesTheSameBytesHoweverItIsMade) {
  const TemporaryDirectory folder;
  const auto path = [&](const std::string& name) { return folder.path() / name; };
  MadeSequenceSpec made{.num_frames = 5};
  (void)MakeSequence(path("run"), made);
  for (const int num_threads : {1, 4}) {
    EXPECT_TRUE(ConvertAll({.recording = path("run"),
                            .directory = path(std::to_string(num_threads)),
                            .format = "ply",
                            .num_threads = num_threads})
                    .is_complete);
  }
  const ConvertChoices stopped = {
      .recording = path("run"), .directory = path("stopped"), .format = "ply"};
  EXPECT_FALSE(ConvertAll(stopped, 2).is_complete);
  EXPECT_EQ(ConvertAll(stopped).num_resumed, 2U);
  EXPECT_EQ(FilesOf(path("4")), FilesOf(path("1")));
  EXPECT_EQ(FilesOf(path("stopped")), FilesOf(path("1")));
}

TEST(ConvertSequence, TakesSomeFramesAndFields) {
  const TemporaryDirectory folder;
  const auto path = [&](const std::string& name) { return folder.path() / name; };
  MadeSequenceSpec made{.num_frames = 4};
  (void)MakeSequence(path("run"), made);
  made.start_frame = 1;
  made.num_frames = 2;
  made.format = "ply";
  made.fields = "x,y,z,label";
  (void)MakeSequence(path("part"), made);
  ConvertChoices choices = {.recording = path("run"),
                            .directory = path("out"),
                            .format = "ply",
                            .fields = "x,y,z,label",
                            .first_frame = 1,
                            .last_frame = 2};
  EXPECT_TRUE(ConvertAll(choices).is_complete);
  EXPECT_EQ(FilesOf(path("out")), FilesOf(path("part")));
  choices.recording = path("part");
  choices.directory = path("again");
  choices.fields = "x,y,z,ring";
  choices.first_frame = 0;
  EXPECT_EQ(MessageOf([&] { (void)ConvertAll(choices); }),
            "--frames: must be of the recording's 2 frames (got 0..2)");
  choices.last_frame = 1;
  EXPECT_EQ(MessageOf([&] { (void)ConvertAll(choices); }),
            "--fields: must be among those of the recording, x, y, z, label (got ring)");
}

TEST(ConvertSequence, RefusesWhatHasNoPointsOrOtherAxes) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  const fs::path out = folder.path() / "out";
  const auto message = [&](const MadeSequenceSpec& made, const std::string& format) {
    fs::remove_all(run);
    (void)MakeSequence(run, made);
    const std::string whole = MessageOf(
        [&] { (void)ConvertAll({.recording = run, .directory = out, .format = format}); });
    return whole.substr(whole.find(": ") + 2);
  };
  MadeSequenceSpec objects{.format = "objects"};
  EXPECT_EQ(message(objects, "pcd"), "must have points (got format objects)");
  EXPECT_EQ(message(objects, "mcap"), "must have points (got a sequence without)");
  MadeSequenceSpec world{.output = R"({"frame": "world"})"};
  EXPECT_EQ(message(world, "ply"),
            "must have its points in the sensor's axes to become a sequence; --format mcap or "
            "rosbag2 takes them");
  EXPECT_FALSE(fs::exists(out));
}

TEST(ConvertSequence, RefusesImagesThatAreNotTheFrames) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  (void)MakeSequence(run, MadeSequenceSpec());
  fs::remove(run / "manifest.json");
  const std::string lines = ReadFileWhole(run / "frames.jsonl");
  const std::size_t end = lines.find('\n');
  FrameRecord record = ReadFrameLine(lines.substr(0, end), "line");
  record.files.push_back({"camera/front/color/000000.png", "2d06800538d394c2", 0});
  WriteFileWhole(run / "frames.jsonl", HashedRecordLine(record) + lines.substr(end + 1));
  EXPECT_THAT(
      MessageOf([&] {
        (void)ConvertAll({.recording = run, .directory = folder.path() / "out", .format = "ply"});
      }),
      testing::EndsWith("frames.jsonl:1: files: must be images of the frame's camera, each "
                        "once (got camera/front/color/000000.png)"));
}

TEST(ConvertDataset, IsTheDataSetThatItsRecipeWouldHaveGiven) {
  const TemporaryDirectory folder;
  const auto path = [&](const std::string& name) { return folder.path() / name; };
  const Recipe recipe = ReadProjectRecipe(path("project"), RecipeOfTwoSensors());
  (void)MakeDataset(recipe, path("pcd"));
  for (const char* format : {"ply", "kitti"}) {
    DatasetChoices choices = OnOneThread(path(format));
    choices.format = format;
    (void)RunDataset(recipe, choices, NoDatasetHooks());
    const ConvertChoices convert = {
        .recording = path("pcd"), .directory = path("out") / format, .format = format};
    EXPECT_FALSE(ConvertAll(convert, 6).is_complete);
    EXPECT_TRUE(ConvertAll(convert).is_complete);
    EXPECT_TRUE(FilesOfDataset(convert.directory) == FilesOfDataset(path(format))) << format;
    EXPECT_THAT(VerifyDataset(convert.directory, [](double) {}).faults, testing::IsEmpty());
  }
  EXPECT_EQ(
      MessageOf([&] {
        (void)ConvertAll({.recording = path("pcd"), .directory = path("bag"), .format = "mcap"});
      }),
      "--format: must have files for each frame, which the index of a data set names; its "
      "sequences become bags one by one (got mcap)");
}

}  // namespace
}  // namespace railcast
