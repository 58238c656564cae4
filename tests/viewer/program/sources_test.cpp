#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/viewer/program/drawn_points.h"
#include "tests/viewer/program/eye.h"
#include "tests/viewer/program/recorded_run.h"
#include "tests/viewer/program/view_program.h"

namespace railcast {
namespace {

class Sources : public Drawn {
 protected:
  /// Draws a frame from the driver's place and expects each of its points in the picture. Colouring
  /// by a quantity makes every point bright.
  void ExpectPoints(const std::string& source, std::size_t index, std::size_t num_points) {
    SCOPED_TRACE(source);
    const auto recording = OpenRecording(source);
    auto reader = recording->Next();
    for (std::size_t i = 0; i < index; ++i) reader = recording->Next();
    ASSERT_TRUE(reader.has_value());
    const ShownFrame shown = MakeShownFrame((*reader)());
    const std::uint32_t frame = shown.frame().index;
    const Picture picture = Draw("--eye -1,0,0.3 --target 60,0,-1.5 --color-by height --frame " +
                                 std::to_string(frame) + " " + source);
    std::size_t num_drawn = 0;
    const auto seen = SeenPoints(shown, DriverEye(kWidth, kHeight), picture);
    for (const SeenPoint& point : seen) {
      num_drawn += picture.At(point.pixel().x, point.pixel().y) != kDark ? 1U : 0U;
    }
    EXPECT_GT(seen.size(), num_points);
    EXPECT_EQ(num_drawn, seen.size());
    // Nothing else is drawn: each point is a square of 4 px.
    std::size_t num_pixels = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const bool is_point = IsClearOfWords({x, y}, picture) && y > kHeight / 5;
        num_pixels += is_point && picture.At(x, y) != kDark ? 1U : 0U;
      }
    }
    EXPECT_LE(num_pixels, 4 * seen.size() + 200);
  }

  /// Makes two frames of the yard.
  [[nodiscard]] std::string Generated(const std::string& name, const std::string& options) const {
    Write("scenario.json", YardScenario());
    const Ended ended = Generate("sequence " + PathOf("scenario.json") + " --frames 2 --out " +
                                 PathOf(name) + " " + options);
    EXPECT_EQ(ended.status, 0) << ended.said;
    return PathOf(name);
  }
};

TEST_F(Sources, MayBeSequencesTheirFilesAndTheirFolders) {
  const std::string run = RecordedRun::Yard().path().string();
  ExpectPoints(run, 1, 5000);
  ExpectPoints(run + "/frames", 1, 5000);
  ExpectPoints(run + "/frames/000001.pcd", 0, 5000);
}

TEST_F(Sources, MayBePlyFiles) {
  const std::string run = Generated("ply", "--format ply");
  ExpectPoints(run, 1, 5000);
  ExpectPoints(run + "/frames", 1, 5000);
  ExpectPoints(run + "/frames/000001.ply", 0, 5000);
  // The format does not change the picture, except for the path in the status.
  const Picture ply = Draw("--frame 1 " + run);
  const Picture pcd = Draw("--frame 1 " + RecordedRun::Yard().path().string());
  EXPECT_TRUE(ply.Part({0, 0}, kWidth, 400) == pcd.Part({0, 0}, kWidth, 400));
}

TEST_F(Sources, MayBeKittisFiles) {
  const std::string run = Generated("kitti", "--format kitti");
  ExpectPoints(run, 1, 5000);
  ExpectPoints(run + "/sequences/00/velodyne", 1, 5000);
  ExpectPoints(run + "/sequences/00/velodyne/000001.bin", 0, 5000);
}

TEST_F(Sources, MayBeCapturesOfTheGenerators) {
  std::string scenario = YardScenario();
  const std::string raster = "sensors/vir2rail.json";
  scenario.replace(scenario.find(raster), raster.size(), "sensors/vlp16.json");
  Write("vlp16.json", scenario);
  const Ended ended = Generate("stream " + PathOf("vlp16.json") +
                               " --duration 0.5 --protocol vlp16 --pcap " + PathOf("vlp16.pcap"));
  ASSERT_EQ(ended.status, 0) << ended.said;
  ExpectPoints(PathOf("vlp16.pcap"), 2, 500);
}

TEST_F(Sources, MayBeCapturesOfRealSensors) {
  const std::filesystem::path folder = RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  for (const std::string name : {"vlp16_dual", "vlp32c_single", "pandar64", "vls128_single"}) {
    ExpectPoints((folder / (name + ".pcap")).string(), 1, 300);
  }
}

TEST_F(Sources, MayHoldNoPoints) {
  Write("none.bin", "");
  const Picture picture = Draw(PathOf("none.bin"));
  EXPECT_EQ(PointsOf(kDark, picture).size(), PointsOf(picture.At(400, 300), picture).size());
}

TEST_F(Sources, MayHaveTheNamesOfAScenario) {
  // A cloud alone has neither names nor colours for its labels.
  std::filesystem::copy_file(RecordedRun::Yard().path() / "frames/000000.pcd", PathOf("alone.pcd"));
  const Rgb wagon = RecordedRun::Yard().ColorOf("wagon");
  const std::string scenario = RecordedRun::Yard().scenario_file().string();
  const auto num_named =
      PointsOf(wagon, Draw("--camera chase --scenario " + scenario + " " + PathOf("alone.pcd")))
          .size();
  EXPECT_EQ(num_named,
            PointsOf(wagon, Draw("--camera chase " + RecordedRun::Yard().path().string() +
                                 "/frames/000000.pcd"))
                .size());
  EXPECT_GT(num_named, 300U);
  (void)Draw("--scenario " + scenario + " --sensor Vir2Rail --select wagon -v " +
             PathOf("alone.pcd"));
  EXPECT_NE(said().find("selected wagon: "), std::string::npos) << said();
}

}  // namespace
}  // namespace railcast
