#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/io/write_file.h"
#include "generator/live/live_streams.h"
#include "railcast/scenario.h"
#include "tests/core/io/stream/listening_program.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/live/live_process.h"

namespace railcast {
namespace {

// The coarse scan with a camera whose images go to these receivers, one with every second frame.
std::string WithCamera(const std::filesystem::path& folder, const std::string& receivers) {
  (void)CoarseScenario(folder);
  const auto file = folder / "camera.json";
  WriteFileWhole(file, R"({
    "version": 1,
    "file": "coarse.json",
    "camera": {"name": "front", "width_px": 160, "height_px": 120, "horizontal_fov_deg": 60,
               "rate_hz": 10, "udp": [)" +
                           receivers + "]}}");
  return file.string();
}

// Compares each JPEG with the PNG of its frame: the mean difference of the bytes, by Open3D.
std::string MeanDifferences(const std::filesystem::path& jpegs, const std::filesystem::path& pngs) {
  const std::string script =
      "import numpy as np, open3d as o3d\n"
      "read = lambda f: np.asarray(o3d.io.read_image(f)).astype(float)\n"
      "for n in (0, 2, 4):\n"
      "    d = read('" +
      jpegs.string() + "/%06d.jpg' % n) - read('" + pngs.string() +
      "/%06d.png' % n)\n"
      "    assert d.shape == (120, 160, 3)\n"
      "    print('alike' if abs(d).mean() < 4 else abs(d).mean())\n";
  const auto file = jpegs / "compare.py";
  WriteFileWhole(file, script);
  return RunCommand("/usr/bin/python3 " + file.string()).said;
}

TEST(StreamImages, SendsTheImagesThatSequenceWritesWithTheStampsOfTheFrames) {
  const TemporaryDirectory folder;
  const auto jpegs = folder.path() / "jpegs";
  ListeningProgram receiver("/usr/bin/python3 " RAILCAST_SOURCE_DIR
                            "/examples/receive_images.py 127.0.0.1:0 --images 3 --out " +
                            jpegs.string());
  const std::string scenario = WithCamera(folder.path(), "\"" + EndpointText(receiver.at()) + "\"");
  StreamReceiver frames(kAnyLoopbackPort);
  Stream stream(scenario + " --duration 0.3 --to " + EndpointText(frames.at()));
  for (std::uint32_t index = 0; index < 6; ++index) {
    const auto frame = frames.Next(kPatience_ms);
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->header.frame, index);
    EXPECT_EQ(frame->header.stamp_ns, 50'000'000 * std::int64_t{index});
  }
  // At 20 frames a second, frames 0, 2 and 4 have images.
  for (const std::string expected :
       {"frame 0: 160 x 120 pixels at 0.000 s, ", "frame 2: 160 x 120 pixels at 0.100 s, ",
        "frame 4: 160 x 120 pixels at 0.200 s, "}) {
    EXPECT_THAT(receiver.Line(), testing::StartsWith(expected));
  }
  const Ended ended = stream.Wait();
  EXPECT_EQ(ended.status, 0) << ended.said;
  EXPECT_THAT(ended.said, testing::HasSubstr("front: images to " + EndpointText(receiver.at())));
  EXPECT_THAT(ended.said, testing::HasSubstr("front: 3 frames, "));
  if (RunCommand("/usr/bin/python3 -c 'import open3d'").status != 0) {
    GTEST_SKIP() << "python3-open3d is not installed";
  }
  const auto out = folder.path() / "out";
  ASSERT_EQ(Generate("sequence " + scenario + " --frames 5 --out " + out.string()).status, 0);
  EXPECT_EQ(MeanDifferences(jpegs, out / "camera/front/color"), "alike\nalike\nalike\n");
}

// A camera's period may be seconds, and its images show the same instants as the frames.
TEST(StreamImages, LeaveAsSoonAsTheFramesOfTheirStamps) {
  const TemporaryDirectory folder;
  const ScenarioSpec scenario = ReadScenario(WithCamera(folder.path(), "\"127.0.0.1:9\""));
  SensorStreamSpec scan;
  scan.name = scenario.lidar.name;
  scan.to = {ParseEndpoint("127.0.0.1:9", 0)};
  LiveStreams streams(scenario, {scan}, 1, 0, "");
  const std::vector<LiveSensor> sensors = streams.Sensors();
  ASSERT_EQ(sensors.size(), 2U);
  EXPECT_EQ(sensors[1].period_ns, 2 * sensors[0].period_ns);
  EXPECT_EQ(sensors[1].latency_ns, sensors[0].latency_ns);
}

TEST(StreamImages, HaveReceiversOfTheirOwn) {
  const TemporaryDirectory folder;
  const std::string scenario = WithCamera(folder.path(), R"("127.0.0.1:27999")");
  const Ended ended = Generate("stream " + scenario + " --to 127.0.0.1:27999");
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.said,
            "/camera/udp: must be other receivers than those of the sensors (got "
            "127.0.0.1:27999)\n");
}

TEST(StreamImages, AreNotSentWherePositionPacketsGo) {
  const TemporaryDirectory folder;
  const std::string scenario = WithCamera(folder.path(), R"("localhost:8308")");
  const Ended ended = Generate("stream " + scenario + " --protocol vlp16 --to 127.0.0.1:27999");
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.said,
            "receivers of front: must not be where coarse sends position packets (got "
            "127.0.0.1:8308)\n");
}

}  // namespace
}  // namespace railcast
