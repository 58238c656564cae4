#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"
#include "tests/support/effort.h"

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
    const Ended made = RunCommand(MakingOf(run, format, 2001));
    EXPECT_EQ(made.status, 0) << made.said;
    return run.string();
  }
  /// The command that makes a recording, or finds that it is complete.
  static std::string MakingOf(const std::filesystem::path& run,
                              const std::string& format,
                              std::uint32_t num_frames,
                              const std::filesystem::path& scenario = scenario_) {
    return RAILCAST_GENERATE " sequence " + scenario.string() + " --out " + run.string() +
           " --frames " + std::to_string(num_frames) + " --format " + format;
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

// A line of frames.jsonl has more than 800 bytes, so that of 10,000 frames more than 8 MB would be
// kept if their lines were; an eighth of that allows for what the system gives in advance.
// RAILCAST_LONG_RUN is the number of frames of a longer run, with a cloud of each.
TEST_F(LongRecording, TakesNoMoreMemoryForMoreFrames) {
  constexpr std::uint32_t kFewFrames = 2000;
  constexpr double kLeastOfAFrame_kb = 0.1;
  const char* const wanted = std::getenv("RAILCAST_LONG_RUN");
  const std::uint32_t num_frames =
      wanted == nullptr ? 6 * kFewFrames : static_cast<std::uint32_t>(std::stoul(wanted));
  const std::string format = wanted == nullptr ? "objects" : "pcd";
  const std::filesystem::path few = here_ / "few", many = here_ / "many";
  PlainJson standing = PlainJson::parse(ReadFileWhole(scenario_));
  standing["vehicle"].erase("motion");
  const std::filesystem::path scenario = folder_->Write("standing.json", standing.dump());
  const std::string making_few = MakingOf(few, format, kFewFrames, scenario);
  const std::string making_many = MakingOf(many, format, num_frames, scenario);
  ASSERT_EQ(RunCommand(making_few).status, 0);
  ASSERT_EQ(RunCommand(making_many).status, 0);
  const std::string verifying = RAILCAST_ANALYZE " verify ";
  for (const auto& [of_few, of_many] :
       {std::pair(making_few, making_many),
        std::pair(verifying + few.string(), verifying + many.string())}) {
    const Effort least = EffortOf(of_few), most = EffortOf(of_many);
    EXPECT_LT(most.memory_kb - least.memory_kb, kLeastOfAFrame_kb * (num_frames - kFewFrames))
        << of_many;
    if (wanted == nullptr) continue;
    std::cout << of_many << ": " << most.memory_kb << " kB for " << least.memory_kb << ", "
              << most.cpu_s << " s for " << least.cpu_s << "\n";
  }
}

}  // namespace
}  // namespace railcast
