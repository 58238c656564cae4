#include "viewer/frames/frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "railcast/io/cloud_files.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/stream/live_stream.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/viewer/frames/made_capture.h"
#include "tests/viewer/made_run.h"
#include "viewer/frames/shown_frame.h"

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

/// Expects that frames asked for in this order equal those read one after another.
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
  constexpr std::uint32_t kFrames = 70;  // Only the readers of 24 turns are kept.
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "a.pcap";
  WriteCapture(file, kFrames);
  const std::vector<RecordedFrame> expected = ReadAll(file);
  ASSERT_EQ(expected.size(), kFrames);
  RecordedFrames frames(file);
  ASSERT_TRUE(frames.Get(2));
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

TEST(RecordedFrames, OfACaptureAreAllKnownBeforeTheyAreReadTo) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "a.pcap";
  WriteCapture(file, 40);
  RecordedFrames frames(file);
  ASSERT_TRUE(frames.Get(0));
  EXPECT_TRUE(Eventually([&] { return frames.num_known() == 40; })) << frames.num_known();
  EXPECT_EQ(frames.first_known(), 0U);
  EXPECT_EQ(frames.Get(40), nullptr);
  EXPECT_EQ(frames.num_known(), 40U);
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
  const std::vector<std::string> numbers = {"3", "4", "8", "11", "12", "13", "40", "41", "700"};
  std::string lines = "file,run,frame,stamp_ns,x,y,z,qx,qy,qz,qw,points,lost\n";
  for (const std::string& number : numbers) {
    WritePcd(directory.path() / (number + ".pcd"), ExampleFrame(0));
    lines.append(number).append(".pcd,0,").append(number).append(",0,0,0,0,0,0,0,1,9,0\n");
  }
  WriteFileWhole(directory.path() / "frames.csv", lines);
  for (std::size_t place = 0; place < numbers.size(); ++place) {
    const auto number = static_cast<std::uint32_t>(std::stoul(numbers[place]));
    EXPECT_EQ(RecordedFrames(directory.path()).PlaceOf(number), place);
  }
  RecordedFrames frames(directory.path());
  for (const char* number : {"5", "10", "39", "42", "699", "701"}) {
    EXPECT_EQ(
        MessageOf([&] { (void)frames.PlaceOf(static_cast<std::uint32_t>(std::stoul(number))); }),
        directory.path().string() + ": has no frame " + number + " (it has 3 to 700)");
  }
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

TEST(FrameCounter, CountsTheTurnsOfACapture) {
  const TemporaryDirectory directory;
  WriteCapture(directory.path() / "a.pcap", 12);
  const FrameCounter counter(directory.path() / "a.pcap");
  EXPECT_TRUE(Eventually([&] { return counter.num_counted() == 12; })) << counter.num_counted();
}

TEST(FrameCounter, EndsAtAnyTime) {
  const TemporaryDirectory directory;
  WriteCapture(directory.path() / "a.pcap", 12);
  for (int i = 0; i < 20; ++i) {
    const FrameCounter counter(directory.path() / "a.pcap");
    EXPECT_LE(counter.num_counted(), 12U);
  }
}

TEST(FrameCounter, CountsAsFarAsACaptureIsSound) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "a.pcap";
  WriteCapture(file, 12);
  fs::resize_file(file, fs::file_size(file) / 2);
  const FrameCounter counter(file);
  // The file holds half of twelve turns, the last of them cut short.
  EXPECT_TRUE(Eventually([&] { return counter.num_counted() >= 5; })) << counter.num_counted();
}

TEST(FrameCounter, CountsNothingOfWhatCannotBeRead) {
  const FrameCounter counter("/nowhere/a.pcap");
  EXPECT_EQ(counter.num_counted(), 0U);
}

}  // namespace
}  // namespace railcast
