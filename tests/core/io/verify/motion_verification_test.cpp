#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/io/verify/verification.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/damaged_run.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_motion.h"

namespace railcast {
namespace {

/// A run of six frames with motion sensors.
class VerifyMotion : public testing::Test {
 protected:
  void SetUp() override { (void)MakeMotionRun(RunWithMotion(directory_.path())); }
  [[nodiscard]] std::vector<std::string> Faults() const {
    std::vector<std::string> faults = VerifySequence(directory_.path(), [](double) {}).faults;
    for (std::string& fault : faults) fault.erase(0, directory_.path().string().size() + 1);
    return faults;
  }
  void Replace(const std::string& file, const std::string& from, const std::string& to) const {
    const auto path = directory_.path() / file;
    WriteFileWhole(path, Replaced(ReadFileWhole(path), from, to));
  }
  TemporaryDirectory directory_;
};

TEST_F(VerifyMotion, FindsNothingInWhatWasJustWritten) {
  EXPECT_THAT(Faults(), testing::IsEmpty());
}

TEST_F(VerifyMotion, FindsAChangedSampleAndItsFrame) {
  Replace("motion/imu.csv", "\n5001,", "\n5002,");
  const std::vector<std::string> faults = Faults();
  ASSERT_EQ(faults.size(), 2U) << testing::PrintToString(faults);
  EXPECT_TRUE(faults[0].starts_with("motion/imu.csv: must have the hash ")) << faults[0];
  EXPECT_TRUE(faults[1].starts_with(
      "frames.jsonl:3: records_xxh3: must be that of the frame's lines in poses.csv:4, "
      "objects.jsonl:3, imu.csv:8, odometer.csv:6, "))
      << faults[1];
}

TEST_F(VerifyMotion, FindsAMissingFile) {
  std::filesystem::remove(directory_.path() / "motion/gnss.csv");
  EXPECT_THAT(Faults(), testing::ElementsAre("motion/gnss.csv: no such file or directory"));
}

// An unfinished run has no manifest, so that only the lines themselves tell.
TEST_F(VerifyMotion, FindsMissingSamplesInAnUnfinishedRun) {
  std::filesystem::remove(directory_.path() / "manifest.json");
  const std::string text = ReadFileWhole(directory_.path() / "motion/odometer.csv");
  WriteFileWhole(directory_.path() / "motion/odometer.csv", text.substr(0, text.find("8000,")));
  EXPECT_THAT(Faults(), testing::ElementsAre("manifest.json: missing: the run is unfinished",
                                             "motion/odometer.csv:12: missing"));
}

TEST_F(VerifyMotion, RefusesNamesThatLeadElsewhere) {
  Replace("run.json", "\"odometer\"", "\"../poses\"");
  EXPECT_EQ(MessageOf([&] { (void)Faults(); }), directory_.path().string() +
                                                    "/run.json: /motion_sensors: must be names of "
                                                    "files (got [\"imu\",\"gnss\",\"../poses\"])");
}

}  // namespace
}  // namespace railcast
