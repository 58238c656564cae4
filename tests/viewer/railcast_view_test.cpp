#include <gtest/gtest.h>
#include <sys/wait.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkSmartPointer.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/io/net/udp_sender.h"
#include "tests/core/io/stream/listening_program.h"
#include "tests/core/io/stream/stream_example.h"
#include "viewer/coloring.h"

namespace railcast {
namespace {

struct Result {
  int exit_code{};
  std::string output;
};

Result Execute(const std::string& command) {
  Result result;
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 256> text{};
  while (std::fgets(text.data(), text.size(), pipe) != nullptr) result.output += text.data();
  result.exit_code = WEXITSTATUS(pclose(pipe));
  return result;
}

/// A folder for one test, removed afterwards.
class RailcastView : public testing::Test {
 protected:
  RailcastView() { std::filesystem::create_directories(folder_); }
  ~RailcastView() override { std::filesystem::remove_all(folder_); }

  std::string PathOf(const std::string& name) const { return folder_ / name; }

  void Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }

  /// Two upright squares of 2 x 2 m at `x_m`: label 1 straight ahead, label 2 5 m to the left; and
  /// a point 80 m nearer.
  void WriteSquares(const std::string& name, int x_m = 40) const {
    std::string points = std::to_string(x_m - 80) + " 0 0 0\n";
    int num_points = 1;
    for (int iy = -20; iy <= 20; ++iy) {
      for (int iz = -20; iz <= 20; ++iz) {
        for (int label = 1; label <= 2; ++label) {
          points += std::to_string(x_m) + ' ' + std::to_string(0.05 * iy + 5.0 * (label - 1)) +
                    ' ' + std::to_string(0.05 * iz) + ' ' + std::to_string(label) + '\n';
          ++num_points;
        }
      }
    }
    points += "nan nan nan 0\n";
    ++num_points;
    const std::string count = std::to_string(num_points);
    Write(name,
          "VERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH " +
              count + "\nHEIGHT 1\nPOINTS " + count + "\nDATA ascii\n" + points);
  }

  void WriteLabels(const std::string& name) const {
    Write(name, R"({"version": 1, "labels": [
      {"id": 1, "name": "red", "rgb": [255, 0, 0], "whu_railway3d": "Others", "osdar23": "",
       "semantic_kitti": 0, "semantic_kitti_nearest": 0},
      {"id": 2, "name": "green", "rgb": [0, 255, 0], "whu_railway3d": "Others", "osdar23": "",
       "semantic_kitti": 0, "semantic_kitti_nearest": 0}]})");
  }

 private:
  const std::filesystem::path folder_ =
      testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name();
};

// A server that resets when its last client leaves signals xvfb-run once more, and on a busy
// machine xvfb-run takes that signal for a failed clean-up: hence -noreset.
constexpr char kOnADisplay[] = "xvfb-run -a -s '-noreset -screen 0 1280x1024x24' " RAILCAST_VIEW;

/// The tests that draw need a display; Xvfb is one without a screen.
class Screenshot : public RailcastView {
 protected:
  void SetUp() override {
    if (std::system("command -v xvfb-run >/dev/null") != 0) GTEST_SKIP() << "xvfb-run is missing";
  }

  /// Draws 640 x 480 from the driver's place.
  void Draw(const std::string& arguments) {
    const Result result = Execute(std::string(kOnADisplay) +
                                  " --size 640x480 --camera driver"
                                  " --screenshot " +
                                  PathOf("out.png") + ' ' + arguments);
    ASSERT_EQ(result.exit_code, 0) << result.output;
    vtkNew<vtkPNGReader> reader;
    reader->SetFileName(PathOf("out.png").c_str());
    reader->Update();
    image_ = reader->GetOutput();
    ASSERT_EQ(image_->GetDimensions()[0], 640);
    ASSERT_EQ(image_->GetDimensions()[1], 480);
  }

  /// The colour at a number of pixels to the right of and above the picture's centre.
  Rgb At(double right_px, double above_px) const {
    const int x = static_cast<int>(std::lround(320 + right_px));
    const int y = static_cast<int>(std::lround(240 + above_px));
    const auto* const pixel = static_cast<const unsigned char*>(image_->GetScalarPointer(x, y, 0));
    return {pixel[0], pixel[1], pixel[2]};
  }

  // The camera is at (-1, 0, 0.3) and looks at (60, 0, -1.5) with 36 deg from bottom to top.
  static constexpr double kTilt = 1.8 / 61.0;
  static double PixelsPerTangent() { return 240.0 / std::tan(18.0 * std::numbers::pi / 180.0); }
  // Of the plane at x = 40 m: how far above the centre its axis is at a height, and one metre.
  double PixelsAbove(double z_m) const {
    const double angle_rad = std::atan((z_m - 0.3) / 41.0) + std::atan(kTilt);
    return PixelsPerTangent() * std::tan(angle_rad);
  }
  static double MetreInPixels() { return PixelsPerTangent() / 41.0; }

 private:
  vtkSmartPointer<vtkImageData> image_;
};

/// Where on the scale a colour is.
double PlaceOnScale(const Rgb& rgb) {
  const auto distance = [&](int step) {
    const Rgb other = ScaleColor(step / 1000.0);
    return std::abs(rgb[0] - other[0]) + std::abs(rgb[1] - other[1]) + std::abs(rgb[2] - other[2]);
  };
  int nearest = 0;
  for (int step = 1; step <= 1000; ++step) {
    if (distance(step) < distance(nearest)) nearest = step;
  }
  EXPECT_LE(distance(nearest), 3);
  return nearest / 1000.0;
}

constexpr Rgb kRed = {255, 0, 0};
constexpr Rgb kGreen = {0, 255, 0};
constexpr Rgb kBackground = {26, 26, 28};

TEST_F(Screenshot, ShowsBlocksInTheirLabelsColoursWhereTheyAre) {
  WriteSquares("cloud.pcd");
  WriteLabels("labels.json");
  Draw(PathOf("cloud.pcd"));
  for (const double dz : {-0.9, 0.0, 0.9}) {
    for (const double dy : {-0.9, 0.0, 0.9}) {
      EXPECT_EQ(At(dy * MetreInPixels(), PixelsAbove(dz)), kRed) << dy << ' ' << dz;
      EXPECT_EQ(At((dy - 5.0) * MetreInPixels(), PixelsAbove(dz)), kGreen) << dy << ' ' << dz;
    }
  }
  for (const double outside : {-1.3, 1.3}) {
    EXPECT_EQ(At(0.0, PixelsAbove(outside)), kBackground);
    EXPECT_EQ(At(outside * MetreInPixels(), PixelsAbove(0.0)), kBackground);
    EXPECT_EQ(At((outside - 5.0) * MetreInPixels(), PixelsAbove(0.0)), kBackground);
  }
  EXPECT_EQ(At(5.0 * MetreInPixels(), PixelsAbove(0.0)), kBackground);
}

TEST_F(Screenshot, ShowsHeightOnTheScale) {
  WriteSquares("cloud.pcd");
  Draw("--color-by height " + PathOf("cloud.pcd"));
  // The block is 36 px high. A point covers 1 px to all sides of its own pixel, which is up to half
  // a pixel off, and so is ours: 2 px of 36.
  for (const double z_m : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
    EXPECT_NEAR(PlaceOnScale(At(0.0, PixelsAbove(z_m))), 0.5 + 0.5 * z_m, 2.0 / 36.0) << z_m;
  }
}

TEST_F(Screenshot, ShowsTheChosenFrameOfASequenceWithItsLabels) {
  Write("run/frames/000000.pcd", "not read");
  WriteSquares("run/frames/000007.pcd");
  WriteLabels("run/labels.json");
  Draw("--frame 7 " + PathOf("run"));
  EXPECT_EQ(At(0.0, PixelsAbove(0.0)), kRed);
}

TEST_F(Screenshot, LooksAtACloudInWorldCoordinatesFromItsMiddle) {
  WriteSquares("cloud.pcd", 5000);  // The middle is at (4960, 2.5, 0).
  WriteLabels("labels.json");
  Draw(PathOf("cloud.pcd"));
  EXPECT_EQ(At(2.5 * MetreInPixels(), PixelsAbove(0.0)), kRed);
  EXPECT_EQ(At(-2.5 * MetreInPixels(), PixelsAbove(0.0)), kGreen);
  EXPECT_EQ(At(0.0, PixelsAbove(0.0)), kBackground);
}

/// What WriteSquares writes, as a frame of one row; the last slot has no point.
Frame SquaresFrame(std::uint32_t index) {
  std::vector<std::array<float, 3>> points = {{-40.0F, 0.0F, 0.0F}};
  for (int iy = -20; iy <= 20; ++iy) {
    for (int iz = -20; iz <= 20; ++iz) {
      for (int square = 0; square < 2; ++square) {
        points.push_back({40.0F, 0.05F * static_cast<float>(iy) + 5.0F * static_cast<float>(square),
                          0.05F * static_cast<float>(iz)});
      }
    }
  }
  Frame frame;
  frame.index = index;
  frame.Resize(1, static_cast<std::uint32_t>(points.size() + 1), 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    frame.x[i] = points[i][0];
    frame.y[i] = points[i][1];
    frame.z[i] = points[i][2];
  }
  frame.outcome.back() = Outcome::kNoSurface;
  return frame;
}

/// Sends these datagrams again and again, `pause` apart, until it ends.
class EndlessSender {
 public:
  EndlessSender(const Endpoint& to, std::vector<Datagrams> scans)
      : thread_([this, to, scans = std::move(scans)] {
          UdpSender sender({to}, 0);
          while (goes_on_) {
            for (const Datagrams& scan : scans) {
              sender.Send(scan, scan.items);
              std::this_thread::sleep_for(std::chrono::milliseconds(20));
            }
          }
        }) {}
  ~EndlessSender() {
    goes_on_ = false;
    thread_.join();
  }
  EndlessSender(const EndlessSender&) = delete;
  EndlessSender& operator=(const EndlessSender&) = delete;

 private:
  std::atomic<bool> goes_on_{true};
  std::thread thread_;
};

Datagrams Scan(const Frame& frame, const StreamSpec& spec = {}) {
  Datagrams scan;
  StreamEncoder(StreamPattern(frame.rows, frame.columns), spec).Encode(frame, scan);
  return scan;
}

TEST_F(Screenshot, ShowsTheFirstWholeFrameOfAStream) {
  const Endpoint at = OwnEndpoint();
  Datagrams half = Scan(SquaresFrame(0));
  half.items.resize(half.items.size() / 2);
  const EndlessSender sender(at, {half, Scan(SquaresFrame(1)), Scan(SquaresFrame(2))});
  Draw("--color-by height udp://" + EndpointText(at));
  // As ShowsHeightOnTheScale.
  for (const double z_m : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
    EXPECT_NEAR(PlaceOnScale(At(0.0, PixelsAbove(z_m))), 0.5 + 0.5 * z_m, 2.0 / 36.0) << z_m;
    EXPECT_NEAR(PlaceOnScale(At(-5.0 * MetreInPixels(), PixelsAbove(z_m))), 0.5 + 0.5 * z_m,
                2.0 / 36.0)
        << z_m;
  }
}

TEST_F(Screenshot, KeepsUpWithAStream) {
  const std::string source = "udp://" + EndpointText(OwnEndpoint());
  ListeningProgram view(std::string(kOnADisplay) + " --color-by intensity " + source);
  UdpSender sender({view.at()}, 0);
  const Datagrams first = Scan(SquaresFrame(1));
  sender.Send(first, first.items);
  // The window opens for that one, and lives until a frame comes that it cannot colour.
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  StreamSpec without_intensity;
  without_intensity.fields = FieldSelection("x,y,z");
  const EndlessSender later(view.at(), {Scan(SquaresFrame(2)), Scan(SquaresFrame(3)),
                                        Scan(SquaresFrame(4), without_intensity)});
  EXPECT_EQ(view.Rest(), "error: " + source + ": has no field intensity to color by\n");
  EXPECT_EQ(view.ExitStatus(), 1);
}

TEST_F(Screenshot, SaysWhereItCannotWrite) {
  WriteSquares("cloud.pcd");
  const Result result =
      Execute(kOnADisplay + (" --screenshot /no/such/out.png " + PathOf("cloud.pcd")));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.output, "error: /no/such/out.png: no such file or directory\n");
}

TEST_F(RailcastView, SaysHowToRunWithoutADisplay) {
  WriteSquares("cloud.pcd");
  const Result result = Execute("env -u DISPLAY " RAILCAST_VIEW " " + PathOf("cloud.pcd"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.output,
            "error: no display: on a machine without one, run xvfb-run -a -s -noreset "
            "railcast-view ...\n");
}

TEST_F(RailcastView, NamesFilesThatCannotBeShown) {
  Write("notes.txt", "hello\n");
  Write("garbage.pcd", "this is no cloud\n");
  Write("empty/readme", "");
  Write("run/frames/000000.pcd", "");
  Write("run/frames/000002.pcd", "");
  Write("short/frames/000005.pcd", "");
  const std::pair<std::string, std::string> cases[] = {
      {PathOf("gone.pcd"), PathOf("gone.pcd") + ": no such file or directory"},
      {PathOf("garbage.pcd"),
       PathOf("garbage.pcd") + ": is no PCD file: a header line begins with none of its keys"},
      {PathOf("notes.txt"), PathOf("notes.txt") + ": must be a .pcd or .ply file"},
      {PathOf("empty"), PathOf("empty") + ": is no sequence directory (it has no frames/)"},
      {PathOf("run") + " --frame 3",
       PathOf("run/frames") + ": has no frame 000003 (it has 2 frames, 000000 to 000002)"},
      {PathOf("short") + " --frame 3",
       PathOf("short/frames") + ": has no frame 000003 (it has 000005)"}};
  for (const auto& [arguments, fault] : cases) {
    const Result result = Execute(RAILCAST_VIEW " " + arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments;
    EXPECT_EQ(result.output, "error: " + fault + "\n");
  }
}

TEST_F(RailcastView, NamesFieldsThatAreMissing) {
  WriteSquares("cloud.pcd");
  const Result result = Execute(RAILCAST_VIEW " --color-by intensity " + PathOf("cloud.pcd"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.output,
            "error: " + PathOf("cloud.pcd") + ": has no field intensity to color by\n");
}

TEST_F(RailcastView, EndsWithTwoAfterAWrongCommandLine) {
  WriteSquares("cloud.pcd");
  for (const char* const arguments : {"", "--color-by taste ", "--camera moon ", "--size 10x10 ",
                                      "--size wide ", "--frame 1 ", "--frame -1 "}) {
    const std::string source = *arguments == '\0' ? "" : PathOf("cloud.pcd");
    EXPECT_EQ(Execute(RAILCAST_VIEW " " + (arguments + source)).exit_code, 2) << arguments;
  }
  EXPECT_EQ(Execute(RAILCAST_VIEW " --frame 1 udp://127.0.0.1").exit_code, 2);
  EXPECT_EQ(Execute(RAILCAST_VIEW " --help").exit_code, 0);
  EXPECT_EQ(Execute(RAILCAST_VIEW " --version").exit_code, 0);
}

}  // namespace
}  // namespace railcast
