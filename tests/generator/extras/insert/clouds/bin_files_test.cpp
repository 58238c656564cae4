#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/io/verify/verification.h"
#include "core/io/write_file.h"
#include "generator/extras/insert/run/insert_run.h"
#include "railcast/io/recording.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/run/made_insertion.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

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
