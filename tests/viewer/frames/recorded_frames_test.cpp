#include "viewer/frames/recorded_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "core/io/pcap/pcap_writer.h"
#include "core/io/pcd_encoder.h"
#include "core/io/velodyne/velodyne_packet.h"
#include "core/scenario/scenario.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/core/io/velodyne/made_scan.h"
#include "tests/support/sensor_file.h"
#include "tests/viewer/made_run.h"
#include "viewer/color/field_values.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::IsEmpty;

void WritePcd(const fs::path& file, const Frame& frame) {
  std::string bytes;
  EncodePcd(frame, FieldSelection("x,y,z,intensity,label"), PcdEncoding::kBinary, bytes);
  WriteFileWhole(file, bytes);
}

/// A cloud of so many points, all at one place.
void WriteHugePcd(const fs::path& file, std::uint32_t num_points) {
  Frame frame;
  frame.Resize(1, num_points, 1);
  frame.x.assign(num_points, 1.0F);
  frame.y.assign(num_points, 2.0F);
  frame.z.assign(num_points, 3.0F);
  std::string bytes;
  EncodePcd(frame, FieldSelection("x,y,z"), PcdEncoding::kBinary, bytes);
  WriteFileWhole(file, bytes);
}

void WriteCapture(const fs::path& file, std::uint32_t num_frames) {
  const MadeScan scan(ReadSensor("vlp16"));
  const auto encoder = MakeVelodyneEncoder("vlp16", scan.spec(), "strongest");
  PcapWriter writer(file, kVelodyneDataPort, kVelodynePositionPort);
  Datagrams datagrams;
  for (std::uint32_t i = 0; i < num_frames; ++i) {
    datagrams.Clear();
    encoder->Encode(scan.MakeFrame(i), datagrams);
    writer.Write(datagrams, datagrams.items);
  }
  writer.Finish();
}

void ExpectSame(const ShownFrame& a, const ShownFrame& b) {
  EXPECT_EQ(a.recorded->name, b.recorded->name);
  EXPECT_EQ(a.recorded->fields, b.recorded->fields);
  EXPECT_EQ(a.recorded->has_pose, b.recorded->has_pose);
  EXPECT_EQ(a.frame().index, b.frame().index);
  EXPECT_EQ(a.frame().stamp_ns, b.frame().stamp_ns);
  EXPECT_TRUE(a.frame().world_from_sensor.matrix() == b.frame().world_from_sensor.matrix());
  EXPECT_THAT(a.positions_m, ElementsAreArray(b.positions_m));
  EXPECT_EQ(a.slots, b.slots);
  EXPECT_EQ(a.frame().label, b.frame().label);
}

/// Whether frames asked for in that order are those that are read one after another.
void ExpectAnyOrder(const fs::path& source, const std::vector<std::size_t>& places) {
  const std::vector<RecordedFrame> expected = ReadAll(source);
  RecordedFrames frames(source);
  for (const std::size_t place : places) {
    const auto shown = frames.Get(place);
    ASSERT_TRUE(shown) << place;
    ExpectSame(*shown, MakeShownFrame(expected.at(place)));
  }
  EXPECT_EQ(frames.Get(expected.size()), nullptr);
  EXPECT_EQ(frames.num_known(), expected.size());
}

TEST(RecordedFrames, OfASequenceAreTheSameInAnyOrder) {
  const TemporaryDirectory directory;
  MakeRun(directory.path() / "run");
  ExpectAnyOrder(directory.path() / "run", {5, 0, 3, 3, 1, 5, 2, 4, 0});
}

TEST(RecordedFrames, OfADirectoryOfCloudsAreTheSameInAnyOrder) {
  const TemporaryDirectory directory;
  for (std::uint32_t i = 8; i < 13; ++i) {
    WritePcd(directory.path() / (std::to_string(i) + ".pcd"), ExampleFrame(i));
  }
  ExpectAnyOrder(directory.path(), {4, 0, 2, 2, 1, 3, 0});
}

TEST(RecordedFrames, OfACaptureAreTheSameInAnyOrder) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "a.pcap";
  WriteCapture(file, 5);
  ExpectAnyOrder(file, {3, 0, 4, 1, 1, 2});
}

TEST(RecordedFrames, OfALongCaptureAreReadAgainToGoFarBack) {
  constexpr std::uint32_t kFrames = 70;  // 64 turns are kept.
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "a.pcap";
  WriteCapture(file, kFrames);
  const std::vector<RecordedFrame> expected = ReadAll(file);
  ASSERT_EQ(expected.size(), kFrames);
  RecordedFrames frames(file);
  EXPECT_EQ(frames.num_known(), 0U);
  ASSERT_TRUE(frames.Get(2));
  EXPECT_EQ(frames.num_known(), 3U) << "as far as it was read";
  frames.SeekEnd();
  EXPECT_EQ(frames.num_known(), kFrames);
  for (const std::size_t place : {std::size_t{0}, std::size_t{69}, std::size_t{1}}) {
    const auto shown = frames.Get(place);
    ASSERT_TRUE(shown) << place;
    ExpectSame(*shown, MakeShownFrame(expected[place]));
  }
  EXPECT_EQ(frames.Get(kFrames), nullptr);
  EXPECT_EQ(frames.num_known(), kFrames);
}

TEST(RecordedFrames, AreFoundByTheirNumberInASequenceThatBeginsWithSeven) {
  const TemporaryDirectory directory;
  const fs::path run = directory.path() / "run";
  MakeRun(run);
  RecordedFrames frames(run);
  EXPECT_EQ(frames.num_known(), kRunFrames);
  EXPECT_EQ(frames.PlaceOf(12), 5U);
  EXPECT_EQ(frames.PlaceOf(7), 0U);
  EXPECT_EQ(frames.Get(frames.PlaceOf(9))->frame().index, 9U);
  for (const char* number : {"6", "13", "4294967295", "0"}) {
    EXPECT_EQ(
        MessageOf([&] { (void)frames.PlaceOf(static_cast<std::uint32_t>(std::stoul(number))); }),
        run.string() + ": has no frame " + number + " (it has 7 to 12)");
  }
}

TEST(RecordedFrames, AreFoundByTheirNumberInACapture) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "a.pcap";
  WriteCapture(file, 3);
  RecordedFrames frames(file);
  EXPECT_EQ(frames.PlaceOf(1), 1U);
  EXPECT_EQ(MessageOf([&] { (void)frames.PlaceOf(3); }),
            file.string() + ": has no frame 3 (it has 0 to 2)");
}

TEST(RecordedFrames, AreFoundByTheirNumberWhereOthersWereLost) {
  const TemporaryDirectory directory;
  std::string lines = "file,run,frame,stamp_ns,x,y,z,qx,qy,qz,qw,points,lost\n";
  for (const char* number : {"3", "4", "8", "11"}) {
    WritePcd(directory.path() / (std::string(number) + ".pcd"), ExampleFrame(0));
    lines += std::string(number).append(".pcd,0,").append(number).append(",0,0,0,0,0,0,0,1,9,0\n");
  }
  WriteFileWhole(directory.path() / "frames.csv", lines);
  RecordedFrames frames(directory.path());
  EXPECT_EQ(frames.PlaceOf(3), 0U);
  EXPECT_EQ(frames.PlaceOf(4), 1U);
  EXPECT_EQ(frames.PlaceOf(8), 2U);
  EXPECT_EQ(frames.PlaceOf(11), 3U);
  EXPECT_EQ(MessageOf([&] { (void)frames.PlaceOf(5); }),
            directory.path().string() + ": has no frame 5 (it has 3 to 11)");
}

TEST(RecordedFrames, OfASingleFileHaveTheLabelsBesideIt) {
  const TemporaryDirectory directory;
  const fs::path run = directory.path() / "run";
  const MadeSequence made = MakeRun(run);
  const fs::path in_sequence = run / "frames" / "000007.pcd";
  EXPECT_EQ(RecordedFrames(in_sequence).info().labels.labels(), made.scenario.labels);

  const fs::path moved = directory.path() / "a.pcd";
  fs::copy_file(in_sequence, moved);
  EXPECT_THAT(RecordedFrames(moved).info().labels.labels(), IsEmpty());
  fs::copy_file(run / "labels.json", directory.path() / "labels.json");
  EXPECT_EQ(RecordedFrames(moved).info().labels.labels(), made.scenario.labels);
}

TEST(RecordedFrames, OfASequenceHaveItsOwnLabels) {
  const TemporaryDirectory directory;
  const MadeSequence made = MakeRun(directory.path() / "run");
  WriteFileWhole(directory.path() / "labels.json", "of somebody else");
  EXPECT_EQ(RecordedFrames(directory.path() / "run").info().labels.labels(), made.scenario.labels);
}

TEST(RecordedFrames, OfAForeignFileCanBeColouredByItsFields) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "a.pcd";
  WriteFileWhole(file,
                 "VERSION 0.7\nFIELDS x y z curvature height\nSIZE 4 4 4 4 4\nTYPE F F F F F\n"
                 "COUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n"
                 "DATA ascii\n1 2 3 0.5 70\n4 5 6 0.25 80\n");
  const auto shown = RecordedFrames(file).Get(0);
  EXPECT_THAT(ColorableFields(*shown->recorded),
              ElementsAre("range", "height", "x", "y", "curvature", "file_height"));
  EXPECT_THAT(ValuesOf(*shown, "curvature").values, ElementsAre(0.5, 0.25));
  EXPECT_THAT(ValuesOf(*shown, "height").values, ElementsAre(3.0, 6.0));
  EXPECT_THAT(ValuesOf(*shown, "file_height").values, ElementsAre(70.0, 80.0));
}

TEST(RecordedFrames, HaveTheNamesOfAScenarioThatIsGiven) {
  const TemporaryDirectory directory;
  WritePcd(directory.path() / "a.pcd", ExampleFrame(0));
  RecordedFrames frames(directory.path() / "a.pcd");
  const ScenarioSpec scenario =
      ReadScenario(fs::path(RAILCAST_SOURCE_DIR) / "scenarios" / "minimal.json");
  frames.UseScenario(scenario);
  EXPECT_EQ(frames.info().labels.labels(), scenario.labels);
  EXPECT_EQ(frames.info().materials.at(0), "none");
  EXPECT_EQ(frames.info().materials.at(1), scenario.materials.at(0).name);
  EXPECT_TRUE(frames.info().scenario);
}

TEST(RecordedFrames, KeepFourMillionSlotsAndTheLastOneAskedFor) {
  constexpr std::uint32_t kHalf = 1U << 21U;
  const TemporaryDirectory directory;
  WriteHugePcd(directory.path() / "0.pcd", kHalf);
  WriteHugePcd(directory.path() / "1.pcd", kHalf);
  WriteHugePcd(directory.path() / "2.pcd", 1);
  RecordedFrames frames(directory.path());
  const std::weak_ptr<const ShownFrame> first = frames.Get(0);
  const std::weak_ptr<const ShownFrame> second = frames.Get(1);
  ASSERT_FALSE(first.expired()) << "4 194 304 slots";
  EXPECT_EQ(frames.Get(0), first.lock());
  ASSERT_TRUE(frames.Get(2));
  EXPECT_TRUE(second.expired()) << "not asked for since";
  EXPECT_FALSE(first.expired());
}

TEST(RecordedFrames, SayWhichFileIsDamagedAndReadTheOthers) {
  const TemporaryDirectory directory;
  WritePcd(directory.path() / "0.pcd", ExampleFrame(0));
  WriteFileWhole(directory.path() / "1.pcd", "VERSION 0.7\n");
  WritePcd(directory.path() / "2.pcd", ExampleFrame(2));
  RecordedFrames frames(directory.path());
  const std::string message = MessageOf([&] { (void)frames.Get(1); });
  EXPECT_EQ(message.rfind((directory.path() / "1.pcd").string() + ": ", 0), 0U) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_EQ(frames.Get(2)->frame().index, 2U);
  EXPECT_EQ(frames.Get(0)->frame().index, 0U);
}

}  // namespace
}  // namespace railcast
