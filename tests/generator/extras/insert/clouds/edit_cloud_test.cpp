#include "generator/extras/insert/clouds/edit_cloud.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/extras/insert/insertion_verification.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/recording/cloud_frame.h"
#include "core/io/write_file.h"
#include "generator/extras/insert/clouds/source_files.h"
#include "generator/extras/insert/run/insert_run.h"
#include "railcast/io/recording.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/run/made_insertion.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Two rows of three firings at 10 to 15 m, of which the last has returned nothing.
Frame SixFirings() {
  Frame frame;
  frame.Resize(2, 3, 1);
  for (std::uint32_t i = 0; i < 6; ++i) {
    frame.x[i] = i == 5 ? kNaN : 10.0F + static_cast<float>(i);
    frame.y[i] = frame.z[i] = i == 5 ? kNaN : 1.0F;
    frame.intensity[i] = i == 5 ? kNaN : 0.25F;
    frame.range_m[i] = frame.x[i];
    frame.ring[i] = static_cast<std::uint16_t>(i / 3);
    frame.column[i] = i % 3;
    frame.return_count[i] = i == 5 ? 0 : 1;
    frame.label[i] = i == 5 ? 0 : 4;
    frame.outcome[i] = i == 5 ? Outcome::kNoSurface : Outcome::kReturned;
  }
  return frame;
}

/// A recorded frame of that cloud in which one return was lost, one added and one weakened.
struct EditedFrame {
  explicit EditedFrame(const std::vector<FrameFile>& files) {
    std::optional<std::string> labels;
    if (files.size() > 1) labels = files[1].bytes;
    const Cloud cloud = FindReader(files[0].name)->parse("cloud", files[0].bytes, labels).cloud;
    firings.recorded.frame = SixFirings();
    firings.entry_of_slot.assign(6, kNoEntry);
    const std::size_t num = cloud.num_points();
    for (std::uint32_t i = 0; i < num; ++i) firings.entry_of_slot[i] = i;
    firings.recorded.fields = {"x", "y", "z", "intensity", "ring", "column"};
    inserted.recorded = firings.recorded;
    Frame& frame = inserted.recorded.frame;
    frame.x[1] = frame.y[1] = frame.z[1] = frame.intensity[1] = kNaN;
    frame.outcome[1] = Outcome::kBelowThreshold;
    frame.intensity[3] = 0.125F;
    frame.x[5] = 7.0F;
    frame.y[5] = frame.z[5] = 2.0F;
    frame.intensity[5] = 0.5F;
    frame.outcome[5] = Outcome::kReturned;
    frame.label[5] = 4;
    frame.instance[5] = 9;
    inserted.edits = {
        {.slot = 1, .from_slot = {}, .had_point = true, .hidden_by = 9},
        {.slot = 3, .from_slot = 3, .is_weaker = true, .had_point = true, .has_point = true},
        {.slot = 5, .from_slot = {}, .has_point = true, .is_added = true}};
  }
  RecordedFirings firings;
  InsertedFrame inserted;
};

std::vector<FrameFile> FilesIn(const std::string& format, const std::string& fields) {
  std::vector<FrameFile> files;
  LabelTable labels(
      std::vector<Label>{{0, "unlabeled", {}, {}, {}, 0, 0}, {4, "ground", {}, {}, {}, 49, 40}});
  EncodeFrameFiles(SixFirings(),
                   {&ParseFrameFormat(format), FieldSelection(fields), std::move(labels)}, 0,
                   files);
  return files;
}

std::vector<float> ColumnOf(const std::vector<FrameFile>& files, const std::string& name) {
  const Cloud cloud = FindReader(files[0].name)->parse("cloud", files[0].bytes, {}).cloud;
  std::vector<float> values;
  VisitField(cloud, *cloud.Find(name),
             [&](std::size_t, auto value) { values.push_back(static_cast<float>(value)); });
  return values;
}

class EditedCloudOf : public testing::TestWithParam<const char*> {};

TEST_P(EditedCloudOf, PcdMarksLostReturnsAndKeepsItsShape) {
  std::vector<FrameFile> files = FilesIn(GetParam(), "x,y,z,intensity,ring,column,outcome");
  const EditedFrame frame(files);
  const auto slots = EditCloud(frame.firings, frame.inserted, {}, files);
  EXPECT_THAT(slots, ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(ColumnOf(files, "x"),
              ElementsAre(10.0F, testing::IsNan(), 12.0F, 13.0F, 14.0F, 7.0F));
  EXPECT_THAT(ColumnOf(files, "intensity"),
              ElementsAre(0.25F, testing::IsNan(), 0.25F, 0.125F, 0.25F, 0.5F));
  EXPECT_THAT(ColumnOf(files, "outcome"), ElementsAre(0, 3, 0, 0, 0, 0));
}

INSTANTIATE_TEST_SUITE_P(Pcd,
                         EditedCloudOf,
                         testing::Values("pcd", "pcd-ascii", "pcd-compressed"),
                         [](const auto& format) {
                           std::string name = format.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(EditedPly, LeavesOutLostReturnsAndAddsOthersInOrder) {
  std::vector<FrameFile> files = FilesIn("ply", "x,y,z,intensity,ring,column,instance");
  const std::string before = files[0].bytes;
  const EditedFrame frame(files);
  const auto slots = EditCloud(frame.firings, frame.inserted, {}, files);
  EXPECT_THAT(slots, ElementsAre(0, 2, 3, 4, 5));
  EXPECT_THAT(ColumnOf(files, "x"), ElementsAre(10.0F, 12.0F, 13.0F, 14.0F, 7.0F));
  EXPECT_THAT(ColumnOf(files, "ring"), ElementsAre(0, 0, 1, 1, 1));
  EXPECT_THAT(ColumnOf(files, "instance"), ElementsAre(0, 0, 0, 0, 9));
  // One point was lost and one came.
  EXPECT_EQ(files[0].bytes.size(), before.size());
}

TEST(EditedPly, AddsReturnsWhereTheOrderOfItsRowsHasThem) {
  std::vector<FrameFile> files = FilesIn("ply", "x,y,z,intensity");
  // Column by column instead of row by row.
  files[0].bytes =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n10 1 1\n13 1 1\n11 1 1\n14 1 1\n12 1 1\n";
  EditedFrame frame(files);
  frame.firings.entry_of_slot = {0, 2, 4, 1, 3, kNoEntry};
  const auto slots = EditCloud(frame.firings, frame.inserted, {}, files);
  EXPECT_THAT(slots, ElementsAre(0, 3, 4, 2, 5));
  EXPECT_THAT(ColumnOf(files, "x"), ElementsAre(10.0F, 13.0F, 14.0F, 12.0F, 7.0F));
}

TEST(EditedPly, SaturatesMeasuredValuesAndRefusesNumbersThatDoNotFit) {
  const auto edit = [](std::uint32_t instance) {
    std::vector<FrameFile> files = FilesIn("ply", "x,y,z,intensity,instance");
    // The same cloud with intensities and instances in a byte each.
    const Cloud cloud = FindReader(files[0].name)->parse("cloud", files[0].bytes, {}).cloud;
    std::string rows;
    for (std::size_t i = 0; i < cloud.num_points(); ++i) {
      rows += NumberText(10 + i) + " 1 1 64 3\n";
    }
    files[0].bytes = "ply\nformat ascii 1.0\nelement vertex " + NumberText(cloud.num_points()) +
                     "\nproperty float x\nproperty float y\nproperty float z\n"
                     "property uchar intensity\nproperty uchar instance\nend_header\n" +
                     rows;
    EditedFrame frame(files);
    frame.inserted.recorded.frame.intensity[5] = 300.0F;
    frame.inserted.recorded.frame.instance[5] = instance;
    (void)EditCloud(frame.firings, frame.inserted, {}, files);
    return files[0].bytes;
  };
  EXPECT_NE(edit(255).find("7 2 2 255 255\n"), std::string::npos) << edit(255);
  EXPECT_EQ(MessageOf([&] { (void)edit(256); }),
            "a field of the recording cannot hold the number 256; choose another --format than "
            "same");
}

TEST(EditedKitti, KeepsPointsAndLabelsTogether) {
  std::vector<FrameFile> files = FilesIn("kitti", "all");
  const EditedFrame frame(files);
  const auto slots = EditCloud(frame.firings, frame.inserted, {}, files);
  EXPECT_THAT(slots, ElementsAre(0, 2, 3, 4, 5));
  EXPECT_THAT(ColumnOf(files, "x"), ElementsAre(10.0F, 12.0F, 13.0F, 14.0F, 7.0F));
  ASSERT_EQ(files[1].bytes.size(), 20U);
  std::uint32_t label = 0;
  std::memcpy(&label, &files[1].bytes[0], sizeof label);
  EXPECT_EQ(label, 49U);
  std::memcpy(&label, &files[1].bytes[16], sizeof label);
  EXPECT_EQ(label, (9U << 16U) + 4U);
}

TEST(SourceFiles, AreNoneOfLasOrText) {
  const TemporaryDirectory folder;
  for (const std::string ending : {".las", ".xyz", ".csv"}) {
    const std::filesystem::path file = folder.path() / ("site" + ending);
    WriteFileWhole(file, "");
    EXPECT_EQ(MessageOf([&] { (void)FindSourceFiles(file); }),
              file.string() + ": must be a .pcd, .ply or .bin file to be inserted into (got " +
                  ending + ", which is read, but not written)");
  }
}

TEST(EditedClouds, StayAsTheyAreWithoutEdits) {
  for (const char* format : {"pcd", "pcd-ascii", "pcd-compressed", "ply", "kitti"}) {
    std::vector<FrameFile> files = FilesIn(format, "x,y,z,intensity,ring");
    EditedFrame frame(files);
    frame.inserted.edits.clear();
    const std::string before = files[0].bytes;
    (void)EditCloud(frame.firings, frame.inserted, {}, files);
    EXPECT_EQ(files[0].bytes, before) << format;
  }
}

void InsertThings(const InsertChoices& choices) {
  const InsertPlan plan = ReadInsertPlan(choices.plan, choices.recording);
  (void)RunInsert(choices, plan, {[](std::uint32_t, std::uint32_t) {}, [] { return false; }});
}

/// Writes the .bin files of a run of KITTI's layout with other numbers a point.
void ChangeClouds(const fs::path& from,
                  const fs::path& to,
                  const std::function<std::vector<float>(const float*)>& change) {
  fs::create_directories(to);
  for (const auto& entry : fs::directory_iterator(from / "sequences/00/velodyne")) {
    const std::string bytes = ReadFileWhole(entry.path());
    std::string changed;
    for (std::size_t place = 0; place < bytes.size(); place += 4 * sizeof(float)) {
      std::array<float, 4> point{};
      std::memcpy(point.data(), bytes.data() + place, sizeof point);
      const std::vector<float> other = change(point.data());
      changed.append(reinterpret_cast<const char*>(other.data()), other.size() * sizeof(float));
    }
    WriteFileWhole(to / entry.path().filename(), changed);
  }
}

TEST(InsertIntoBinFiles, KeepsTheColumnsOfBinFilesThatWereChosen) {
  const TemporaryDirectory folder;
  const fs::path clouds = folder.path() / "clouds";
  (void)MakeSequence(folder.path() / "run", RunWith("kitti", ""));
  ChangeClouds(folder.path() / "run", clouds, [](const float* point) {
    return std::vector<float>{point[0], point[1], point[2], point[3], 0.25F};
  });
  const fs::path out = folder.path() / "out";
  InsertThings({.recording = clouds.string() + ":5",
                .plan = WriteRunPlan(folder.path(),
                                     R"({"name": "crate", "type": "box", "size_m": [2, 3, 3], )"
                                     R"("frame": 0, "x_m": 12, "y_m": 0, "h_m": 0})",
                                     R"({"poses": "standing"})"),
                .directory = out,
                .may_use_points_alone = true});
  EXPECT_THAT(VerifyInsertion(out, [](double) {}).faults, testing::IsEmpty());
  const RecordedFrame got = (*OpenRecording(out)->Next())();
  EXPECT_EQ(fs::file_size(out / "recording/000000.bin"), 20 * got.slot_of_entry.size());
  ASSERT_EQ(got.foreign.size(), 1U);
  EXPECT_EQ(got.foreign[0].name, "number_5");
  const auto& fifth = got.foreign[0].values;
  EXPECT_GT(std::ranges::count(fifth, 0.25F), 100);
  EXPECT_GT(std::ranges::count_if(fifth, [](float number) { return std::isnan(number); }), 20);
}

TEST(InsertIntoBinFiles, RefusesRangesThatTheSensorCannotHave) {
  const TemporaryDirectory folder;
  const fs::path clouds = folder.path() / "clouds";
  (void)MakeSequence(folder.path() / "run", RunWith("kitti", ""));
  ChangeClouds(folder.path() / "run", clouds, [](const float* point) {
    return std::vector<float>{20.0F * point[0], 20.0F * point[1], 20.0F * point[2], point[3]};
  });
  const fs::path out = folder.path() / "out";
  EXPECT_THAT(MessageOf([&] {
                InsertThings({.recording = clouds,
                              .plan = WriteRunPlan(folder.path(), kBox, R"({"poses": "standing"})"),
                              .directory = out,
                              .may_use_points_alone = true});
              }),
              testing::AllOf(testing::HasSubstr(": range_m: at most 1 % of the returns"),
                             testing::EndsWith("another unit?")));
  EXPECT_FALSE(fs::exists(out));
}

}  // namespace
}  // namespace railcast
