#include "generator/extras/insert/run/insert_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/extras/insert/insertion_verification.h"
#include "core/io/field_layout.h"
#include "core/io/write_file.h"
#include "generator/extras/insert/clouds/sidecars.h"
#include "generator/extras/insert/packets/insertion.h"
#include "railcast/io/recording.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/made_sequence.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/run/made_insertion.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

InsertResult InsertInto(const InsertChoices& choices, std::uint32_t most = 100) {
  const InsertPlan plan = ReadInsertPlan(choices.plan, choices.recording);
  std::uint32_t num_begun = 0;
  return RunInsert(choices, plan,
                   {[](std::uint32_t, std::uint32_t) {}, [&] { return num_begun++ >= most; }});
}

class InsertIntoFormat : public testing::TestWithParam<const char*> {
 protected:
  TemporaryDirectory folder_;
};

TEST_P(InsertIntoFormat, NothingLeavesEveryFileOfASequenceAsItWas) {
  const fs::path run = folder_.path() / "run";
  (void)MakeSequence(run, RunWith(GetParam(), ""));
  (void)InsertInto({.recording = run,
                    .plan = WriteRunPlan(folder_.path(), ""),
                    .directory = folder_.path() / "out"});
  EXPECT_EQ(FilesOf(folder_.path() / "out" / "recording"), FilesOf(run));
}

TEST_P(InsertIntoFormat, NothingLeavesEveryFileOfADirectoryOfCloudsAsItWas) {
  const fs::path run = folder_.path() / "run";
  const fs::path clouds = folder_.path() / "clouds";
  (void)MakeSequence(run, RunWith(GetParam(), ""));
  const bool is_kitti = std::string(GetParam()) == "kitti";
  fs::create_directories(clouds);
  const std::string part = is_kitti ? "sequences" : "frames";
  fs::copy(run / part, clouds / part, fs::copy_options::recursive);
  WriteFileWhole(clouds / "notes.txt", "of the first run\n");
  (void)InsertInto(
      {.recording = clouds,
       .plan = WriteRunPlan(folder_.path(), "", is_kitti ? "{}" : R"({"poses": "standing"})"),
       .directory = folder_.path() / "out",
       .may_use_points_alone = true});
  EXPECT_EQ(FilesOf(folder_.path() / "out" / "recording"), FilesOf(clouds));
}

// The noise of both runs differs, so that ranges may, too: by 6 sigma of 0.02 m and more.
constexpr float kNoise_m = 0.3F;

TEST_P(InsertIntoFormat, AnObjectGivesWhatASimulationWithItGives) {
  const fs::path run = folder_.path() / "run";
  (void)MakeSequence(run, RunWith(GetParam(), ""));
  const MadeSequence truth = MakeSequence(folder_.path() / "truth", RunWith(GetParam(), kBox));
  const fs::path out = folder_.path() / "out";
  (void)InsertInto(
      {.recording = run, .plan = WriteRunPlan(folder_.path(), kBox), .directory = out});
  EXPECT_TRUE(VerifySequence(out / "recording", [](double) {}).faults.empty());
  EXPECT_THAT(VerifyInsertion(out, [](double) {}).faults, testing::IsEmpty());
  const auto recording = OpenRecording(out / "recording");
  for (const Frame& expected : truth.frames) {
    const RecordedFrame got = (*recording->Next())();
    std::size_t num_expected = 0;
    for (std::size_t i = 0; i < expected.num_slots(); ++i) {
      num_expected += expected.instance[i] != 0 && HasPoint(expected.outcome[i]);
    }
    std::size_t num_got = 0;
    for (std::size_t i = 0; i < got.frame.num_slots(); ++i) {
      num_got += got.frame.instance[i] != 0 && !std::isnan(got.frame.x[i]);
    }
    ASSERT_GT(num_expected, 50U);
    EXPECT_NEAR(static_cast<double>(num_got), static_cast<double>(num_expected),
                0.02 * static_cast<double>(num_expected));
    if (!got.is_grid || got.frame.num_slots() != expected.num_slots()) continue;
    std::size_t num_other = 0;
    for (std::size_t i = 0; i < expected.num_slots(); ++i) {
      const bool has_point = HasPoint(expected.outcome[i]);
      const bool is_same =
          std::isnan(got.frame.x[i])
              ? !has_point
              : has_point && std::abs(got.frame.range_m[i] - expected.range_m[i]) < kNoise_m;
      num_other += !is_same;
    }
    EXPECT_LT(num_other, num_expected / 20);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Formats,
    InsertIntoFormat,
    testing::Values("pcd", "pcd-compressed", "pcd-ascii", "ply", "ply-cloudcompare", "kitti"),
    [](const auto& format) {
      std::string name = format.param;
      std::erase(name, '-');
      return name;
    });

TEST(InsertRun, GoesOnWhereItWasStoppedAndWithAnyNumberOfThreadsGivesTheSameBytes) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  (void)MakeSequence(run, RunWith("pcd", ""));
  const fs::path plan = WriteRunPlan(folder.path(), kBox);
  (void)InsertInto({.recording = run, .plan = plan, .directory = folder.path() / "whole"});
  const InsertChoices choices = {
      .recording = run, .plan = plan, .directory = folder.path() / "parts", .num_threads = 1};
  const InsertResult stopped = InsertInto(choices, 0);
  EXPECT_FALSE(stopped.is_complete);
  const InsertResult whole = InsertInto(choices);
  EXPECT_TRUE(whole.is_complete);
  EXPECT_EQ(FilesOf(folder.path() / "parts"), FilesOf(folder.path() / "whole"));
  EXPECT_TRUE(InsertInto(choices).was_complete);
}

TEST(InsertRun, PutsIntoAReplayedRecordingWhatItPutsIntoFiles) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  MadeSequenceSpec made = RunWith("pcd", "");
  made.start_frame = 10;  // Frames count by their place, not by their number.
  (void)MakeSequence(run, made);
  const fs::path plan = WriteRunPlan(folder.path(), kBox);
  (void)InsertInto({.recording = run, .plan = plan, .directory = folder.path() / "out"});
  const auto written = OpenRecording(folder.path() / "out" / "recording");
  const auto sent = WithInsertion(OpenRecording(run), plan, run);
  for (int frame = 0; frame < 2; ++frame) {
    const RecordedFrame expected = (*written->Next())();
    const RecordedFrame got = (*sent->Next())();
    EXPECT_EQ(got.frame.instance, expected.frame.instance);
    EXPECT_GT(std::ranges::count_if(got.frame.instance, [](auto i) { return i != 0; }), 20);
  }
}

TEST(InsertRun, SaysWhatIsWrongWithItsFoldersAndFrames) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  (void)MakeSequence(run, RunWith("pcd", ""));
  const fs::path plan = WriteRunPlan(folder.path(), "");
  const InsertChoices choices = {
      .recording = run, .plan = plan, .directory = folder.path() / "out"};
  InsertChoices late = choices;
  late.last_frame = 2;
  EXPECT_EQ(MessageOf([&] { (void)InsertInto(late); }),
            "--frames: must be of the recording's 2 frames (got 0..2)");
  InsertChoices inside = choices;
  inside.directory = run / "out";
  EXPECT_EQ(MessageOf([&] { (void)InsertInto(inside); }),
            "--out: must not be in the recording's directory (got " + (run / "out").string() + ")");
  (void)InsertInto(choices);
  InsertChoices other = choices;
  other.format = "ply";
  EXPECT_EQ(MessageOf([&] { (void)InsertInto(other); }),
            choices.directory.string() +
                ": holds another run: its --format is same (got ply); choose another --out");
}

TEST(InsertRun, IsVerifiedWithAllItsFiles) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  (void)MakeSequence(run, RunWith("pcd", ""));
  const fs::path clouds = folder.path() / "clouds";
  fs::copy(run / "frames", clouds);
  WriteFileWhole(clouds / "notes.txt", "of the first run\n");
  const fs::path out = folder.path() / "out";
  (void)InsertInto({.recording = clouds,
                    .plan = WriteRunPlan(folder.path(), "", R"({"poses": "standing"})"),
                    .directory = out});
  const auto faults = [&] { return VerifyInsertion(out, [](double) {}).faults; };
  EXPECT_THAT(faults(), testing::IsEmpty());
  EXPECT_EQ(VerifyInsertion(out, [](double) {}).num_frames, 2U);
  WriteFileWhole(out / "letter.txt", "dear");
  EXPECT_THAT(faults(), testing::ElementsAre((out / "letter.txt").string() +
                                             ": is named neither in manifest.json nor in "
                                             "insert.jsonl"));
  fs::remove(out / "letter.txt");
  WriteFileWhole(out / "recording/notes.txt", "of the second run\n");
  fs::remove(out / "points/000001.npy");
  EXPECT_THAT(
      faults(),
      testing::ElementsAre(
          testing::StartsWith((out / "recording/notes.txt").string() + ": must have the hash "),
          testing::StartsWith((out / "points/000001.npy").string() + ": no such file")));
  fs::remove(out / "manifest.json");
  EXPECT_THAT(faults(), testing::Contains((out / "manifest.json").string() +
                                          ": missing: the run is unfinished"));
}

TEST(InsertRun, IsAnotherRunWhereTheRecordingHasChanged) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  (void)MakeSequence(run, RunWith("pcd", ""));
  const fs::path clouds = folder.path() / "clouds";
  fs::copy(run / "frames", clouds);
  const InsertChoices choices = {
      .recording = clouds,
      .plan = WriteRunPlan(folder.path(), "", R"({"poses": "standing"})"),
      .directory = folder.path() / "out"};
  (void)InsertInto(choices);
  EXPECT_TRUE(InsertInto(choices).was_complete);
  WriteFileWhole(clouds / "notes.txt", "of another day\n");
  const std::string message = MessageOf([&] { (void)InsertInto(choices); });
  EXPECT_TRUE(message.starts_with(choices.directory.string() +
                                  ": holds another run: its recording_xxh3 is "))
      << message;
}

TEST(InsertRun, IsNotContinuedWhereACloudWasExchangedMeanwhile) {
  const TemporaryDirectory folder;
  (void)MakeSequence(folder.path() / "run", RunWith("pcd", ""));
  const fs::path clouds = folder.path() / "clouds";
  fs::copy(folder.path() / "run/frames", clouds);
  const InsertChoices choices = {
      .recording = clouds,
      .plan = WriteRunPlan(folder.path(), "", R"({"poses": "standing"})"),
      .directory = folder.path() / "out",
      .num_threads = 1};
  EXPECT_FALSE(InsertInto(choices, 1).is_complete);
  const std::string first = ReadFileWhole(clouds / "000000.pcd");
  const std::string second = ReadFileWhole(clouds / "000001.pcd");
  ASSERT_EQ(first.size(), second.size());
  WriteFileWhole(clouds / "000001.pcd", first);
  EXPECT_THAT(MessageOf([&] { (void)InsertInto(choices); }),
              testing::StartsWith(choices.directory.string() +
                                  ": holds another run: its recording_xxh3 is "));
  WriteFileWhole(clouds / "000001.pcd", second);
  EXPECT_TRUE(InsertInto(choices).is_complete);
}

class InsertionOfKind : public testing::TestWithParam<const char*> {};

// docs/files.md: what was changed is named; without manifest.json it is made anew.
TEST_P(InsertionOfKind, NamesWhatIsDamagedAndMendsItWithoutItsManifest) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  (void)MakeSequence(run, RunWith("pcd", ""));
  const fs::path out = folder.path() / "out";
  const InsertChoices choices = {.recording = run,
                                 .plan = WriteRunPlan(folder.path(), kBox),
                                 .directory = out,
                                 .format = GetParam()};
  (void)InsertInto(choices);
  const auto whole = FilesOf(out);
  for (const char* const name :
       {"insert.jsonl", "points/000001.npy", "plan.resolved.json", "recording/frames/000001.pcd"}) {
    SCOPED_TRACE(name);
    WriteFileWhole(out / name, "{}");
    fs::copy_file(out / name, out / (std::string(name) + ".part"));
    const InsertResult mended = InsertInto(choices);
    EXPECT_THAT(mended.changed, testing::Contains(testing::HasSubstr((out / name).string())));
    EXPECT_TRUE(mended.is_complete);
    EXPECT_TRUE(FilesOf(out) == whole);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, InsertionOfKind, testing::Values("same", "pcd"));

TEST(InsertRun, MakesTheSameOfThePlanThatItWrites) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  (void)MakeSequence(run, RunWith("pcd", ""));
  const fs::path first = folder.path() / "first";
  (void)InsertInto(
      {.recording = run, .plan = WriteRunPlan(folder.path(), kBox), .directory = first});
  const fs::path second = folder.path() / "second";
  (void)InsertInto({.recording = run, .plan = first / "plan.resolved.json", .directory = second});
  EXPECT_EQ(FilesOf(second), FilesOf(first));
}

TEST(InsertRun, KeepsAFileOfPosesWithThePlan) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  (void)MakeSequence(run, RunWith("pcd", ""));
  const fs::path clouds = folder.path() / "clouds";
  fs::copy(run / "frames", clouds);
  fs::copy_file(run / "poses.csv", folder.path() / "poses.csv");
  const fs::path with_file = folder.path() / "with_file";
  (void)InsertInto(
      {.recording = clouds,
       .plan = WriteRunPlan(folder.path(), kBox,
                            R"({"poses_file": "poses.csv", )" + std::string(kSameLine).substr(1)),
       .directory = with_file});
  fs::remove(folder.path() / "poses.csv");
  const fs::path again = folder.path() / "again";
  (void)InsertInto(
      {.recording = clouds, .plan = with_file / "plan.resolved.json", .directory = again});
  EXPECT_TRUE(FilesOf(again) == FilesOf(with_file));
  // As many points as in the sequence that has the poses itself.
  const fs::path known = folder.path() / "known";
  (void)InsertInto(
      {.recording = run, .plan = WriteRunPlan(folder.path(), kBox), .directory = known});
  const auto added_in = [](const fs::path& out) {
    const std::string lines = ReadFileWhole(out / "insert.jsonl");
    return nlohmann::json::parse(lines.substr(0, lines.find('\n'))).at("added");
  };
  EXPECT_EQ(added_in(with_file), added_in(known));
}

TEST(InsertRun, WritesThePosesAndTimesOfTheFramesThatAreTakenOfKittis) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  MadeSequenceSpec made = RunWith("kitti", "");
  made.num_frames = 4;
  (void)MakeSequence(run, made);
  const fs::path clouds = folder.path() / "clouds";
  fs::create_directories(clouds);
  fs::copy(run / "sequences", clouds / "sequences", fs::copy_options::recursive);
  const fs::path out = folder.path() / "out";
  const fs::path plan = WriteRunPlan(folder.path(), "", "{}");
  (void)InsertInto({.recording = clouds,
                    .plan = plan,
                    .directory = out,
                    .first_frame = 1,
                    .last_frame = 2,
                    .may_use_points_alone = true});
  const InsertPlan whole = ReadInsertPlan(plan, clouds);
  const InsertPlan part = ReadInsertPlan(plan, out / "recording");
  ASSERT_EQ(part.frame_times_ns.size(), 2U);
  EXPECT_EQ(part.frame_times_ns[1], whole.frame_times_ns[2] - whole.frame_times_ns[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(PlannedPose(part, part.frame_times_ns[i])
                    .isApprox(PlannedPose(whole, whole.frame_times_ns[i + 1]), 1e-6))
        << i;
  }
}

TEST(InsertRun, PlacesBoxesInTheWorldWhereARecordingHasNoPoses) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  (void)MakeSequence(run, RunWith("pcd", ""));
  const fs::path clouds = folder.path() / "clouds";
  fs::copy(run / "frames", clouds);
  const fs::path out = folder.path() / "out";
  (void)InsertInto(
      {.recording = clouds,
       .plan = WriteRunPlan(folder.path(),
                            R"({"name": "crate", "type": "box", "size_m": [2, 3, 3], "frame": 0, )"
                            R"("s_m": 40, "d_m": 1, "h_m": 0})",
                            R"({"poses": "standing"})"),
       .directory = out});
  const nlohmann::json objects =
      nlohmann::json::parse(ReadFileWhole(out / "objects.jsonl")
                                .substr(0, ReadFileWhole(out / "objects.jsonl").find('\n')));
  const auto world_m = objects.at("objects").at(0).at("world").at("center_m");
  EXPECT_NEAR(world_m.at(0).get<double>(), 40.0, 0.01);
  EXPECT_NEAR(world_m.at(1).get<double>(), 1.0, 0.01);
  EXPECT_NEAR(world_m.at(2).get<double>(), 1.5, 0.01);
  const std::string entry = ReadFileWhole(out / "insert.jsonl");
  EXPECT_NE(entry.find(R"("is_recorded":false)"), std::string::npos) << entry.substr(0, 800);
  const auto pose = nlohmann::json::parse(entry.substr(0, entry.find('\n'))).at("pose");
  EXPECT_NEAR(pose.at("position_m").at(0).get<double>(), 2.2, 1e-9);
  EXPECT_NEAR(pose.at("position_m").at(2).get<double>(), 2.5, 1e-9);
}

/// A person who walks across the line, 28 m ahead at first.
constexpr const char* kWalker =
    R"({"name": "walker", "type": "person", "s_m": 280, "d_m": -1, "h_m": 0, "motion": )"
    R"({"path": {"points": [{"s_m": 280, "d_m": 3}], "speed_mps": 1.4}}})";

/// How many rows of points/NNNNNN.npy are of added points, by their label.
std::map<std::uint32_t, std::size_t> AddedByLabel(const fs::path& npy) {
  constexpr std::size_t kRowBytes = 10;
  const std::string bytes = ReadFileWhole(npy);
  const auto header = static_cast<std::size_t>(LoadAt<std::uint16_t>(&bytes[8]));
  std::map<std::uint32_t, std::size_t> added;
  for (std::size_t row = header + 10; row < bytes.size(); row += kRowBytes) {
    if (bytes.at(row + 9) == static_cast<char>(PointChange::kAdded)) {
      ++added[LoadAt<std::uint32_t>(&bytes[row])];
    }
  }
  return added;
}

TEST(InsertRun, GivesThingsThatMoveTheirMovingClassBesideKittisClouds) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  (void)MakeSequence(run, RunWith("kitti", ""));
  const fs::path out = folder.path() / "out";
  (void)InsertInto(
      {.recording = run, .plan = WriteRunPlan(folder.path(), kWalker), .directory = out});
  const auto added = AddedByLabel(out / "points/000001.npy");
  constexpr std::uint32_t kMovingPerson = 254;
  ASSERT_EQ(added.size(), 1U);
  EXPECT_EQ(added.begin()->first, kMovingPerson);
  EXPECT_GT(added.begin()->second, 10U);
  const auto recording = OpenRecording(out);
  (void)recording->Next();
  const RecordedFrame second = recording->Next().value()();
  EXPECT_EQ(second.axes, PointAxes::kSensorAtStamp);
  const auto walker = std::ranges::find(second.objects, "walker", &RecordedObject::name);
  ASSERT_NE(walker, second.objects.end());
  EXPECT_EQ(walker->label, "moving person");
}

TEST(InsertRun, RefusesKittisCloudsWithNoiseAcrossTheBeams) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  MadeSequenceSpec made{.format = "kitti"};
  (void)MakeSequence(run, made);
  InsertChoices choices = {.recording = run,
                           .plan = WriteRunPlan(folder.path(), kBox),
                           .directory = folder.path() / "out"};
  EXPECT_EQ(MessageOf([&] { (void)InsertInto(choices); }),
            (run / "sequences/00/velodyne/000000.bin").string() +
                ": its firings cannot be found: its points do not lie on the beams of the sensor; "
                "which beam a point is of is lost where its noise is across the beam, as that of "
                "fidelity plausibility is without lidar.plausibility.noise_shape beam");
  choices.directory = folder.path() / "alone";
  choices.may_use_points_alone = true;
  (void)InsertInto(choices);
  EXPECT_NE(ReadFileWhole(choices.directory / "insert.jsonl").find(R"("are_points_alone":true)"),
            std::string::npos);
}

TEST(InsertRun, GivesAddedReturnsTheVelocitiesThatASimulationWithThemGives) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  MadeSequenceSpec made = RunWith("pcd", "");
  made.has_velocity = true;
  (void)MakeSequence(run, made);
  made.object = kWalker;
  const MadeSequence truth = MakeSequence(folder.path() / "truth", made);
  const fs::path out = folder.path() / "out";
  (void)InsertInto({.recording = run,
                    .plan = WriteRunPlan(folder.path(), kWalker, kSameLine,
                                         R"(, "velocity": {"sigma_mps": 0.03, "max_mps": 50})"),
                    .directory = out});
  const auto recording = OpenRecording(out / "recording");
  for (const Frame& expected : truth.frames) {
    const Frame got = (*recording->Next())().frame;
    ASSERT_EQ(got.num_slots(), expected.num_slots());
    std::size_t num = 0;
    for (std::size_t i = 0; i < expected.num_slots(); ++i) {
      // The recording has an object already.
      const bool is_walker = got.instance[i] == 2 && expected.instance[i] == 1;
      if (!is_walker || std::isnan(got.x[i]) || !HasPoint(expected.outcome[i])) continue;
      ++num;
      // The pose between two recorded ones, and where on the limbs each beam ends.
      constexpr float kApart_mps = 0.02F;
      EXPECT_NEAR(got.true_radial_velocity_mps[i], expected.true_radial_velocity_mps[i],
                  kApart_mps);
      EXPECT_NEAR(got.radial_velocity_mps[i], expected.radial_velocity_mps[i], kApart_mps);
      EXPECT_LT(got.true_radial_velocity_mps[i], -15.0F);
    }
    EXPECT_GT(num, 10U);
  }
}

TEST(InsertRun, NamesThePartOfTheDataSetThatASequenceIsOf) {
  const TemporaryDirectory folder;
  const fs::path set = folder.path() / "set";
  (void)MakeSequence(set / "sequences/000/000001", RunWith("pcd", ""));
  WriteFileWhole(set / "dataset.json", "{}\n");
  fs::create_directories(set / "split");
  WriteFileWhole(set / "split/train.txt", "sequences/000/000000\n");
  WriteFileWhole(set / "split/val.txt", "sequences/000/000001\n");
  const fs::path out = folder.path() / "out";
  (void)InsertInto({.recording = set / "sequences/000/000001",
                    .plan = WriteRunPlan(folder.path(), ""),
                    .directory = out});
  EXPECT_NE(ReadFileWhole(out / "insert.jsonl").find(R"("split":"val")"), std::string::npos);
}

TEST(InsertRun, SaysThatAVehicleIsNotBesideThePlansLine) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  (void)MakeSequence(run, RunWith("pcd", ""));
  const fs::path plan = WriteRunPlan(
      folder.path(), "",
      R"({"alignment": {"course": {"type": "elements", "elements": )"
      R"([{"type": "straight", "length_m": 100}, {"type": "straight", "length_m": 50}]}}})");
  const std::string message = MessageOf([&] {
    (void)InsertInto({.recording = run, .plan = plan, .directory = folder.path() / "out"});
  });
  EXPECT_TRUE(message.starts_with(run.string() + ": frame 0: the vehicle must be beside the plan's "
                                                 "alignment, from 0 to 150 m, in whose world the "
                                                 "poses are (got 2"))
      << message;
}

}  // namespace
}  // namespace railcast
