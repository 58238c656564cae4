#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "core/io/image/jpeg.h"
#include "tests/core/io/stream/image_example.h"
#include "tests/core/io/stream/listening_program.h"
#include "tests/viewer/program/endless_sender.h"
#include "tests/viewer/program/recorded_run.h"
#include "tests/viewer/program/squares.h"
#include "tests/viewer/program/window_program.h"
#include "viewer/frames/camera_picture.h"

namespace railcast {
namespace {

constexpr int kMargin = 8;
constexpr std::uint16_t kImagePort = 27'500;

// An image in the upper right corner of 640 x 480 pixels takes two fifths of one side.
Picture InsetOf(const CameraPicture& image) {
  const double factor = 0.4 * std::min(640.0 / image.width_px, 480.0 / image.height_px);
  const int width = static_cast<int>(factor * image.width_px);
  const int height = static_cast<int>(factor * image.height_px);
  return {width, height, ScaledPixels(image, {width, height})};
}

Picture CornerOf(const Picture& picture, const Picture& inset) {
  return picture.Part({640 - kMargin - inset.width, kMargin}, inset.width, inset.height);
}

/// The corner of a window that shows the image of a frame.
Picture NoiseInset(std::uint32_t frame) {
  const std::string jpeg = EncodeJpeg({80, 60}, NoiseImage(frame).rgb, 90);
  return InsetOf(MakeColorPicture(DecodeJpegRgb(jpeg, {80, 60})));
}

Datagrams NoiseDatagrams(std::uint32_t frame) {
  Datagrams datagrams;
  EncodeImage(frame, 0, datagrams);
  return datagrams;
}

Frame FrameAt(std::uint32_t index) {
  Frame frame = StreamFrame(index);
  frame.stamp_ns = NoiseImage(index).stamp_ns;
  return frame;
}

class LiveImage : public WindowTest {
 protected:
  /// The number of the frame that --screenshot -v said it shows.
  [[nodiscard]] std::uint32_t FrameSaid() const {
    const std::size_t at = said().find("   frame ");
    EXPECT_NE(at, std::string::npos) << said();
    return static_cast<std::uint32_t>(std::atoi(said().c_str() + at + 9));
  }

  const Endpoint at_ = OwnEndpoint();
  const Endpoint images_at_{at_.address, kImagePort};
  const std::string source_ =
      "udp://" + EndpointText(at_) + " --image-port " + std::to_string(kImagePort);
};

TEST_F(LiveImage, IsThatOfTheFrameShown) {
  const EndlessSender lidar(at_, {Scan(FrameAt(1)), Scan(FrameAt(2)), Scan(FrameAt(3))});
  const EndlessSender camera(images_at_, {NoiseDatagrams(1), NoiseDatagrams(2), NoiseDatagrams(3)});
  const Picture shown = Draw("-v " + source_);
  EXPECT_THAT(said(),
              testing::StartsWith("listening at " + EndpointText(at_) +
                                  "\nlistening for images at " + EndpointText(images_at_) + "\n"));
  const Picture expected = NoiseInset(FrameSaid());
  EXPECT_TRUE(CornerOf(shown, expected) == expected) << said();
}

TEST_F(LiveImage, IsWaitedForNoLongerThanTold) {
  const EndlessSender lidar(at_, {Scan(FrameAt(1))});
  const Ended ended = View("--wait 0.5 --screenshot " + PathOf("out.png") + " " + source_);
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.said, testing::EndsWith("\nerror: udp://" + EndpointText(at_) +
                                            ": no whole frame with an image came within 0.5 s\n"));
  // Nor is it waited for if it is not wanted.
  (void)Draw("--image off " + source_);
}

TEST_F(LiveImage, IsSwitchedByAKey) {
  const EndlessSender lidar(at_, {Scan(FrameAt(1))});
  const EndlessSender camera(images_at_, {NoiseDatagrams(1)});
  Open({"udp://" + EndpointText(at_), "--image-port", std::to_string(kImagePort)});
  const Picture expected = NoiseInset(1);
  ASSERT_TRUE(window().WaitUntil([&] { return CornerOf(Shown(), expected) == expected; }));
  // Labels and depths are not sent; the key's fourth place is no image at all.
  for (int press = 0; press < 3; ++press) {
    Press("i");
    EXPECT_FALSE(CornerOf(Shown(), expected) == expected) << press;
  }
  Press("i");
  EXPECT_TRUE(CornerOf(Shown(), expected) == expected);
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0) << window().Said();
}

// The generator sends two frames and their images to a viewer that listens already.
TEST_F(LiveImage, IsWhatTheGeneratorWritesForThatFrame) {
  std::string scenario = YardScenario();
  scenario.insert(scenario.find("\"lidar\":"),
                  R"("camera": {"width_px": 160, "height_px": 120, "horizontal_fov_deg": 60,
                     "udp": [")" +
                      EndpointText(images_at_) + "\"]},\n    ");
  Write("scenario.json", scenario);
  const RecordedRun recorded(scenario, 2);
  RunningProgram view({RAILCAST_VIEW, "--size", "640x480", "-v", "--screenshot", PathOf("live.png"),
                       "udp://" + EndpointText(at_), "--image-port", std::to_string(kImagePort)},
                      PathOf("view.txt"));
  ASSERT_TRUE(view.WaitUntil(
      [&] { return view.Said().find("listening for images at ") != std::string::npos; }));
  const Ended ended =
      Generate("stream " + PathOf("scenario.json") + " --duration 0.2 --to " + EndpointText(at_));
  EXPECT_EQ(ended.status, 0) << ended.said;
  EXPECT_EQ(view.ExitStatus(), 0) << view.Said();
  const bool is_first = view.Said().find("   frame 0   ") != std::string::npos;
  const auto image = RecordedPictures(recorded.path()).At(is_first ? 0 : 1, PictureKind::kColor);
  ASSERT_TRUE(image);
  const Picture expected = InsetOf(*image);
  const Picture corner = CornerOf(ReadPicture(PathOf("live.png")), expected);
  double sum = 0.0;
  for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      sum += std::abs(expected.pixels[i][channel] - corner.pixels[i][channel]);
    }
  }
  // As StreamImages allows it for JPEG of this quality.
  EXPECT_LT(sum / (3.0 * static_cast<double>(expected.pixels.size())), 4.0) << view.Said();
}

TEST_F(LiveImage, HasOptionsThatFit) {
  const std::string help = "\nRun with --help for more information.\n";
  const std::string live = "udp://" + EndpointText(at_);
  EXPECT_EQ(View("--image label " + source_).said,
            "--image: must be color or off for a live source (got label)" + help);
  EXPECT_EQ(View("--image depth " + live).said,
            "--image: must be color or off for a live source (got depth)" + help);
  EXPECT_EQ(View("--image color " + live).said,
            "--image: needs --image-port for a live source" + help);
  EXPECT_EQ(View("--image-port 27500 some.pcd").said, "--image-port: is for a live source" + help);
}

}  // namespace
}  // namespace railcast
