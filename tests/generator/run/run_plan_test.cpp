#include "generator/run/run_plan.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"
#include "tests/generator/run_command.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// A scenario with a sensor `front` of 20 Hz and a sensor `roof` of 10 Hz.
const std::string kTwoSensors = std::string(RAILCAST_SOURCE_DIR) + "/scenarios/two_sensors.json";

class SequencesOfSensors : public testing::Test {
 protected:
  Ended Make(const std::string& out, const std::string& options) const {
    return Generate("sequence " + kTwoSensors + " --fields x,y,z --out " + Out(out).string() + " " +
                    options);
  }
  [[nodiscard]] fs::path Out(const std::string& out) const { return folder_.path() / out; }

  const TemporaryDirectory folder_;
};

TEST_F(SequencesOfSensors, AreThoseOfEachSensorAlone) {
  const Ended all = Make("all", "--frames 4 --start-frame 2");
  ASSERT_EQ(all.status, 0) << all.said;
  ASSERT_EQ(Make("front", "--frames 4 --start-frame 2 --sensor front").status, 0);
  // 0.1 to 0.3 s.
  ASSERT_EQ(Make("roof", "--frames 2 --start-frame 1 --sensor roof").status, 0);
  EXPECT_EQ(Contents(Out("all/front")), Contents(Out("front")));
  EXPECT_EQ(Contents(Out("all/roof")), Contents(Out("roof")));
  EXPECT_EQ(SensorFoldersIn(Out("all")),
            (std::vector<fs::path>{Out("all/front"), Out("all/roof")}));
}

TEST_F(SequencesOfSensors, TakeEveryNthFrameOfEach) {
  ASSERT_EQ(Make("all", "--frames 3 --stride 4").status, 0);
  // Frames 0, 4 and 8 of front last until 0.45 s; those of roof before it are 0 and 4.
  ASSERT_EQ(Make("roof", "--frames 2 --stride 4 --sensor roof").status, 0);
  EXPECT_EQ(Contents(Out("all/roof")), Contents(Out("roof")));
}

TEST_F(SequencesOfSensors, LieInADirectoryOfTheirOwn) {
  fs::create_directories(Out("all/photos"));
  EXPECT_EQ(Make("all", "--frames 1").said,
            Out("all").string() +
                ": must hold nothing but the folders of the scenario's sensors and sensors.json "
                "(got \"photos\")\n");
  EXPECT_FALSE(fs::exists(Out("all/front")));
}

TEST_F(SequencesOfSensors, NeedAFrameOfEach) {
  EXPECT_EQ(
      Make("all", "--frames 1 --start-frame 1").said,
      "--frames: must last until a frame of sensor \"roof\" begins, 0.1 s (got 1 of the first "
      "sensor, to 0.1 s)\n");
  EXPECT_FALSE(fs::exists(Out("all")));
}

TEST_F(SequencesOfSensors, SayWhereEachSensorIs) {
  ASSERT_EQ(Make("all", "--frames 1").status, 0);
  const std::string text = ReadFileWhole(Out("all") / kSensorsFile);
  EXPECT_NE(text.find("\"folder\": \"roof\""), std::string::npos);
  EXPECT_NE(text.find("\"rate_hz\": 20.0"), std::string::npos);
}

TEST_F(SequencesOfSensors, NameADamagedListOfSensors) {
  fs::create_directories(Out("all"));
  std::ofstream(Out("all") / kSensorsFile) << "{\"version\": 1}";
  EXPECT_EQ(MessageOf([&] { (void)SensorFoldersIn(Out("all")); }),
            (Out("all") / kSensorsFile).string() + ": /sensors: missing");
}

}  // namespace
}  // namespace railcast
