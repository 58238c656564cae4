#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"

namespace railcast {
namespace {

using PlainJson = nlohmann::json;

/// 2,001 frames of a few beams, on the way to a box: more than reports keep of what they list, and
/// more than any other test has.
class LongRecording : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    PlainJson sensor = PlainJson::parse(ReadFileWhole(ScenariosDir() / "sensors" / "vlp16.json"));
    sensor.erase("version");
    sensor["scan"]["pattern"]["azimuth_window_deg"] = {359, 1};
    sensor["mount"] = {{"position_m", {2.2, 0, 2.5}}};
    const std::string scenarios = ScenariosDir().string();
    const PlainJson scenario = {
        {"version", 1},
        {"fidelity", "geometry"},
        {"lidar", sensor},
        {"world",
         {{"alignment",
           {{"course",
             {{"type", "elements"}, {"elements", {{{"type", "straight"}, {"length_m", 500}}}}}}}},
          {"vegetation", {{"trees_per_hectare", 0}, {"grass", false}}},
          {"objects",
           {{{"name", "box"}, {"type", "box"}, {"s_m", 350}, {"h_m", 0}, {"size_m", {2, 2, 3}}}}}}},
        {"vehicle",
         {{"start_s_m", 100}, {"motion", {{"profile", {{{"time_s", 0}, {"speed_mps", 1}}}}}}}},
        {"materials", scenarios + "/materials/railway.json"},
        {"labels", scenarios + "/labels.json"}};
    scenario_ = folder_->Write("scenario.json", scenario.dump());
    here_ = scenario_.parent_path();
  }
  static void TearDownTestSuite() { delete folder_; }

  /// The recording in a format, made when it is first asked for.
  static std::string Made(const std::string& format) {
    const std::filesystem::path run = here_ / format;
    if (exists(run)) return run.string();
    const Ended made = RunCommand(RAILCAST_GENERATE " sequence " + scenario_.string() + " --out " +
                                  run.string() + " --frames 2001 --format " + format);
    EXPECT_EQ(made.status, 0) << made.said;
    return run.string();
  }

  static void ExpectDone(const std::string& command, const std::string& num_frames = "2001") {
    const Ended run = Analyze(command);
    EXPECT_EQ(run.status, 0) << command << ": " << run.said;
    EXPECT_THAT(run.said, testing::HasSubstr(num_frames)) << command;
  }

  inline static TemporaryFolder* folder_ = nullptr;
  inline static std::filesystem::path scenario_, here_;
};

TEST_F(LongRecording, IsReadByEveryCommand) {
  const std::string run = Made("pcd"), bag = Made("mcap");
  for (const char* const command : {"stats", "detect", "evaluate", "fit"}) {
    ExpectDone(std::string(command) + " " + run + " --format text");
  }
  ExpectDone("compare " + run + " " + bag + " --format text");
  ExpectDone("verify " + run);
  ExpectDone("verify " + bag);
}

TEST_F(LongRecording, IsReadInEveryForm) {
  const std::string pcd = Made("pcd"), kitti = Made("kitti");
  const std::filesystem::path capture = here_ / "capture.pcap";
  const Ended sent = RunCommand(RAILCAST_GENERATE " stream " + scenario_.string() +
                                " --protocol vlp16 --duration 200.2 --pcap " + capture.string());
  ASSERT_EQ(sent.status, 0) << sent.said;
  for (const std::string& source :
       {pcd + "/frames", Made("ply") + "/frames", kitti, kitti + "/sequences/00/velodyne",
        Made("mcap") + "/frames.mcap", Made("rosbag2") + "/rosbag2"}) {
    ExpectDone("stats " + source + " --format text");
  }
  // Of 2,001 turns the last would not fill a packet, which is not sent.
  ExpectDone("stats " + capture.string() + " --format text", "2002");
}

}  // namespace
}  // namespace railcast
