
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/io/cloud/kitti.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/made_sequence.h"
#include "tests/core/io/temporary_directory.h"
#include "viewer/frames/frames.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;
using testing::IsSupersetOf;

/// Makes a KITTI directory as railcast-generate writes it, with a wagon 50 m ahead.
MadeSequence MakeKitti(const fs::path& directory) {
  return MakeSequence(directory, {.format = "kitti"});
}

/// Returns the names of the labels in the first frame.
std::set<std::string> NamesIn(RecordedFrames& frames) {
  std::set<std::string> names;
  const auto shown = frames.Get(0);
  for (const std::uint32_t slot : shown->slots) {
    const Label* const label = frames.info().labels.Find(shown->frame().label[slot]);
    names.insert(label == nullptr ? "?" : label->name);
  }
  return names;
}

/// Returns the names of the labels that frame 0 hit, as far as SemanticKITTI's numbers can tell
/// them apart.
std::set<std::string> ExpectedNames(const MadeSequence& made) {
  const LabelTable own(made.scenario.labels);
  const LabelTable kitti = SemanticKittiLabels(own);
  std::set<std::string> names;
  const Frame& frame = made.frames.at(0);
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (!HasPoint(frame.outcome[i])) continue;
    names.insert(kitti.Find(std::uint32_t{own.Find(frame.label[i])->semantic_kitti})->name);
  }
  return names;
}

TEST(LabelsOfKitti, AreNamedFromEachFolderOfOurOutput) {
  const TemporaryDirectory directory;
  const fs::path run = directory.path() / "kitti";
  const MadeSequence made = MakeKitti(run);
  const std::set<std::string> expected = ExpectedNames(made);
  ASSERT_THAT(expected, IsSupersetOf({"wagon", "rail"}));
  const fs::path velodyne = run / "sequences" / "00" / "velodyne";
  for (const fs::path& source :
       {run, run / "", run / "sequences" / "00", velodyne, velodyne / "000000.bin"}) {
    RecordedFrames frames(source);
    EXPECT_EQ(NamesIn(frames), expected) << source;
  }
}

TEST(LabelsOfKitti, HaveTheColoursOfOurs) {
  const TemporaryDirectory directory;
  const MadeSequence made = MakeKitti(directory.path() / "kitti");
  const LabelTable labels = RecordedFrames(directory.path() / "kitti").info().labels;
  const LabelTable own(made.scenario.labels);
  EXPECT_EQ(labels.Find(16U)->rgb, own.Find("wagon")->rgb);
  EXPECT_EQ(labels.Find(70U)->name, "grass/tree/bush");
  EXPECT_EQ(labels.Find(70U)->rgb, own.Find("grass")->rgb);
}

// Removes all but KITTI's own files, as in a recording of another program.
void LeaveKittisFilesAlone(const fs::path& run) {
  for (const char* ours :
       {"run.json", "frames.jsonl", "labels.json", "semantic-kitti-railcast.yaml"}) {
    fs::remove(run / ours);
  }
}

TEST(LabelsOfKitti, StayNumbersWithoutALabelTable) {
  const TemporaryDirectory directory;
  const fs::path run = directory.path() / "kitti";
  (void)MakeKitti(run);
  LeaveKittisFilesAlone(run);
  EXPECT_THAT(RecordedFrames(run).info().labels.labels(), IsEmpty());
}

TEST(LabelsOfKitti, AreThoseOfTheConfigurationWithoutALabelTable) {
  const TemporaryDirectory directory;
  const fs::path run = directory.path() / "kitti";
  const MadeSequence made = MakeKitti(run);
  for (const char* ours : {"run.json", "frames.jsonl", "labels.json"}) fs::remove(run / ours);
  RecordedFrames frames(run);
  EXPECT_EQ(NamesIn(frames), ExpectedNames(made));
}

TEST(LabelsOfKitti, AreThoseOfAScenarioThatIsGiven) {
  const TemporaryDirectory directory;
  const fs::path run = directory.path() / "kitti";
  const MadeSequence made = MakeKitti(run);
  LeaveKittisFilesAlone(run);
  RecordedFrames frames(run);
  frames.UseScenario(made.scenario);
  EXPECT_EQ(NamesIn(frames), ExpectedNames(made));
}

TEST(LabelsOfKitti, AreNotSoughtAboveTheSequences) {
  const TemporaryDirectory directory;
  const fs::path run = directory.path() / "kitti";
  (void)MakeKitti(run);
  for (const char* table : {"labels.json", "semantic-kitti-railcast.yaml"}) {
    fs::rename(run / table, directory.path() / table);
  }
  const fs::path file = run / "sequences" / "00" / "velodyne" / "000000.bin";
  EXPECT_THAT(RecordedFrames(file).info().labels.labels(), IsEmpty());
}

TEST(LabelsOf, SayThatATableIsDamaged) {
  const TemporaryDirectory directory;
  WriteFileWhole(directory.path() / "labels.json", "[");
  RecordingInfo info;
  info.source = directory.path() / "a.pcd";
  const std::string message = MessageOf([&] { (void)LabelsOf(info); });
  EXPECT_THAT(message, testing::StartsWith((directory.path() / "labels.json").string() + ":"));
  EXPECT_THAT(message, testing::Not(testing::HasSubstr("\n")));
}

}  // namespace
}  // namespace railcast
