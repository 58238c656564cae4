#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/io/write_file.h"
#include "tests/core/io/stream/listening_program.h"
#include "tests/viewer/program/endless_sender.h"
#include "tests/viewer/program/recorded_run.h"
#include "tests/viewer/program/squares.h"
#include "tests/viewer/program/window_program.h"

namespace railcast {
namespace {

using LiveScreenshot = Squares;

TEST_F(LiveScreenshot, ShowsTheFirstWholeFrame) {
  const Endpoint at = OwnEndpoint();
  Datagrams half = Scan(SquaresFrame(0));
  half.items.resize(half.items.size() / 2);
  const EndlessSender sender(at, {half, Scan(SquaresFrame(1)), Scan(SquaresFrame(2))});
  DrawSquares("--color-by height udp://" + EndpointText(at));
  // The same expectations as in ShowsHeightOnTheScale.
  for (const double z_m : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
    EXPECT_NEAR(PlaceOnScale(At(0.0, PixelsAbove(z_m))), 0.5 + 0.5 * z_m, 2.0 / 36.0) << z_m;
    EXPECT_NEAR(PlaceOnScale(At(-5.0 * MetreInPixels(), PixelsAbove(z_m))), 0.5 + 0.5 * z_m,
                2.0 / 36.0)
        << z_m;
  }
}

TEST_F(LiveScreenshot, WaitsNoLongerThanItIsTold) {
  const std::string source = "udp://" + EndpointText(OwnEndpoint());
  const Ended ended = View("--wait 0.2 --screenshot " + PathOf("out.png") + " " + source);
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.said, "listening at " + EndpointText(OwnEndpoint()) + "\nerror: " + source +
                            ": no whole frame came within 0.2 s\n");
  EXPECT_FALSE(std::filesystem::exists(PathOf("out.png")));
}

TEST_F(LiveScreenshot, MayBeAVideo) {
  const std::string at = EndpointText(OwnEndpoint());
  Write("scenario.json", YardScenario());
  RunningProgram stream({RAILCAST_GENERATE, "stream", PathOf("scenario.json"), "--to", at},
                        PathOf("stream.txt"));
  const Ended ended = View("--size 320x240 --frames 3 --video " + PathOf("video") + " udp://" + at);
  EXPECT_EQ(ended.status, 0) << ended.said << stream.Said();
  std::set<std::string> contents;
  for (const std::string name : {"000000.png", "000001.png", "000002.png"}) {
    EXPECT_EQ(ReadPicture(PathOf("video/" + name)).width, 320);
    contents.insert(ReadFileWhole(PathOf("video/" + name)));
  }
  EXPECT_EQ(contents.size(), 3U);
  EXPECT_FALSE(std::filesystem::exists(PathOf("video/000003.png")));
}

/// A window that shows a live stream.
class LiveWindow : public WindowTest {
 protected:
  void Listen(std::vector<std::string> options = {}) {
    options.push_back("udp://" + EndpointText(at_));
    // Keys pressed before the first frame have no effect that a test could wait for.
    OpenDeaf(options);
  }
  /// Waits until a picture has points; the key p does nothing before the first frame.
  [[nodiscard]] bool WaitForPoints() {
    Press("p");
    return window().WaitUntil([&] {
      Press("p");
      return std::filesystem::exists(PathOf("desk/railcast-view-2.png"));
    });
  }
  /// Returns a picture that was saved after all earlier keys had their effect.
  [[nodiscard]] Picture Saved() {
    int number = 1;
    while (std::filesystem::exists(NameOf(number))) ++number;
    Press("p");
    // Pictures requested by WaitForPoints() may still be pending.
    EXPECT_TRUE(window().WaitUntil([&] { return std::filesystem::exists(NameOf(number)); }))
        << window().Said();
    return ReadPicture(NameOf(number));
  }
  static std::size_t CountPoints(const Picture& picture) {
    constexpr Rgb kDark = {26, 26, 28};
    std::size_t count = 0;
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        count += IsClearOfWords({x, y}, picture) && picture.At(x, y) != kDark ? 1U : 0U;
      }
    }
    return count;
  }

  const Endpoint at_ = OwnEndpoint();

 private:
  [[nodiscard]] std::string NameOf(int number) const {
    return PathOf("desk/railcast-view-" + std::to_string(number) + ".png");
  }
};

Frame Square(std::uint32_t index) {
  Frame frame;
  frame.index = index;
  frame.Resize(41, 41, 1);
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    const std::size_t row = i / 41;
    const std::size_t column = i % 41;
    frame.x[i] = 40.0F;
    frame.y[i] = 0.05F * static_cast<float>(column) - 1.0F;
    frame.z[i] = 0.05F * static_cast<float>(row) - 1.0F;
    frame.intensity[i] = 0.01F * static_cast<float>(column);
  }
  return frame;
}

TEST_F(LiveWindow, OpensAtOnceAndIsLeftBeforeAFrameCame) {
  Listen();
  EXPECT_EQ(window().Said(), "listening at " + EndpointText(at_) + "\n");
  Press("p c o space Right End bracketleft question question k e l Escape");
  EXPECT_TRUE(window().WaitUntil([&] {
    Press("q");
    return !window().IsAlive();
  }));
  EXPECT_EQ(window().ExitStatus(), 0) << window().Said();
  EXPECT_FALSE(std::filesystem::exists(PathOf("desk/railcast-view-1.png")));
}

TEST_F(LiveWindow, FallsBackWhereALaterFrameLacksTheField) {
  Listen({"--camera", "driver", "--color-by", "intensity"});
  Picture coloured;
  {
    const EndlessSender sender(at_, {Scan(Square(1)), Scan(Square(2))});
    ASSERT_TRUE(WaitForPoints());
    coloured = Saved();
  }
  StreamSpec without_intensity{.fields = FieldSelection("x,y,z")};
  const EndlessSender sender(at_, {Scan(Square(3), without_intensity)});
  // The fallback is height, which rises upwards, whereas intensity rose to the left.
  EXPECT_TRUE(window().WaitUntil([&] {
    const Picture picture = Saved();
    return CountPoints(picture) > 300 &&
           picture.Part({300, 200}, 40, 60) != coloured.Part({300, 200}, 40, 60);
  }));
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0) << window().Said();
}

TEST_F(LiveWindow, OutlivesSendersAndTheirNoise) {
  Listen({"--camera", "driver"});
  {
    const EndlessSender sender(at_, {Scan(Square(7)), Scan(Square(8))});
    ASSERT_TRUE(WaitForPoints());
  }
  // The sender has stopped, and its last frame stays.
  EXPECT_GT(CountPoints(Saved()), 300U);
  // Malformed datagrams: inputs found by fuzzing, cut and flipped datagrams, frames of other
  // shapes, empty ones.
  std::vector<Datagrams> noise;
  for (const auto& entry : std::filesystem::directory_iterator(RAILCAST_FUZZ_CORPORA "/stream")) {
    const std::string bytes = ReadFileWhole(entry.path());
    for (const std::size_t size : {bytes.size(), bytes.size() / 2, std::size_t{1}}) {
      Datagrams one;
      one.bytes.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(
                                                          std::min(size, std::size_t{1400})));
      one.items.push_back({.size = static_cast<std::uint16_t>(one.bytes.size())});
      noise.push_back(std::move(one));
    }
  }
  std::minstd_rand random(1);
  for (int i = 0; i < 40; ++i) {
    Datagrams scan = Scan(Square(9));
    for (int flip = 0; flip < 8; ++flip) scan.bytes[random() % scan.bytes.size()] ^= char(0x55);
    noise.push_back(std::move(scan));
  }
  {
    const EndlessSender sender(at_, noise);
    for (int i = 0; i < 20; ++i) (void)Saved();
  }
  EXPECT_TRUE(window().IsAlive()) << window().Said();
  // A sender that starts again at its first frame is shown again.
  const Picture before = Saved();
  Frame moved = Square(0);
  for (float& y_m : moved.y) y_m -= 5.0F;
  StreamSpec anew{.run = 1};
  const EndlessSender sender(at_, {Scan(moved, anew)});
  EXPECT_TRUE(window().WaitUntil([&] {
    const Picture picture = Saved();
    return picture.Part({400, 150}, 60, 200) != before.Part({400, 150}, 60, 200);
  }));
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0) << window().Said();
}

/// Takes a quarter of a minute, so it is a ctest test of its own.
class Minute : public LiveWindow {};

TEST_F(Minute, ShowsAStreamOfTheGeneratorAllTheTime) {
  std::string scenario = YardScenario();
  const std::string fast = "\"speed_mps\": 20";
  scenario.replace(scenario.find(fast), fast.size(), "\"speed_mps\": 0.5");
  Write("scenario.json", scenario);
  RunningProgram stream(
      {RAILCAST_GENERATE, "stream", PathOf("scenario.json"), "--to", EndpointText(at_)},
      PathOf("stream.txt"));
  Listen({"--scenario", PathOf("scenario.json")});
  ASSERT_TRUE(WaitForPoints()) << stream.Said() << window().Said();
  const auto begin = std::chrono::steady_clock::now();
  const auto live_until = [&](int time_s) {
    while (std::chrono::steady_clock::now() < begin + std::chrono::seconds(time_s)) {
      ASSERT_TRUE(window().IsAlive()) << window().Said();
      ASSERT_TRUE(stream.IsAlive()) << stream.Said();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  };
  live_until(5);
  const Picture early = Saved();
  const long early_kib = window().Memory_KiB();
  live_until(15);
  const Picture late = Saved();
  const long late_kib = window().Memory_KiB();
  EXPECT_GT(early_kib, 10'000);
  EXPECT_LT(late_kib, early_kib + early_kib / 5);
  const Rgb wagon = RecordedRun::Yard().ColorOf("wagon");
  for (const Picture& picture : {early, late}) {
    EXPECT_GT(PointsOf(wagon, picture).size(), 300U);
    EXPECT_GT(CountPoints(picture), 20'000U);
    // The status is bright text in the lower left corner, where no points are.
    const Picture foot = picture.Part({0, 440}, 200, 40);
    EXPECT_GT(std::ranges::count_if(foot.pixels, [](const Rgb& rgb) { return rgb[2] > 150; }), 100);
  }
  EXPECT_GT(Differences(early, late).size(), 1000U);
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0) << window().Said();
}

}  // namespace
}  // namespace railcast
