#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>

#include "tests/viewer/program/eye.h"
#include "tests/viewer/program/recorded_run.h"
#include "tests/viewer/program/window_program.h"

namespace railcast {
namespace {

class Window : public WindowTest {
 protected:
  struct Camera {
    Vector3 eye_m;
    Vector3 target_m;
  };
  [[nodiscard]] Camera CameraNow() {
    const std::string line = PrintedCamera();
    Camera camera;
    Vector3& e = camera.eye_m;
    Vector3& t = camera.target_m;
    EXPECT_EQ(std::sscanf(line.c_str(), "--eye %lf,%lf,%lf --target %lf,%lf,%lf", &e[0], &e[1],
                          &e[2], &t[0], &t[1], &t[2]),
              6)
        << line;
    return camera;
  }
  /// Returns a screenshot of what the window should show, drawn at the first call: all later ones
  /// have its bytes (video_test.cpp).
  [[nodiscard]] const Picture& Expected(const std::string& options) {
    static std::map<std::string, Picture> drawn;
    if (!drawn.contains(options)) drawn.emplace(options, Draw(options + " " + path_));
    return drawn.at(options);
  }

  const RecordedRun& run_ = RecordedRun::Yard();
  const std::string path_ = run_.path().string();
};

TEST_F(Window, StepsThroughFrames) {
  Open({path_});
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("")));
  Press("Right");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--frame 1")));
  Press("Right Right");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--frame 3")));
  Press("Left");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--frame 2")));
  Press("End");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--frame 5")));
  Press("Right");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--frame 5")));
  Press("Home");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("")));
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

TEST_F(Window, PlaysToTheEndAndAnew) {
  Open({path_, "--frame", "2"});
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--frame 2")));
  Press("End");
  const Picture at_end = Shown();
  Press("Home");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("")));
  Press("space");
  // Compares the words, too, because they say that it has paused.
  EXPECT_TRUE(window().WaitUntil([&] { return Shown() == at_end; }));
  // From the end, playing starts again at the first frame, now at the lowest speed: 1.6 s per
  // frame.
  Press("comma comma comma comma space");
  const Picture between[] = {Expected("--frame 1"), Expected("--frame 2"), Expected("--frame 3")};
  EXPECT_TRUE(window().WaitUntil([&] {
    const Picture shown = Shown();
    return std::ranges::any_of(
        between, [&](const Picture& picture) { return ArePointsAlike(shown, picture); });
  }));
  Press("space");
  const Picture paused = Shown();
  EXPECT_TRUE(Shown() == paused);
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

TEST_F(Window, ShowsWhatIsAskedForByKeys) {
  Open({path_});
  Press("o");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--show boxes")));
  Press("o t g");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--show track,gauge")));
  Press("t g s x r");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--show surfaces,axes,rings")));
  Press("s x r n u");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--show empty-beams,frustum")));
  Press("n u b");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--background black")));
  Press("b b bracketright bracketright");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--point-size 4")));
  Press("bracketleft bracketleft End a a");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--frame 5 --accumulate 4")));
  Press("A Home A 1");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--camera driver")));
  Press("2");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--camera top")));
  Press("3");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--camera side")));
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

TEST_F(Window, ColoursByTheNextField) {
  Open({path_});
  Press("c");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--color-by instance")));
  Press("c c");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--color-by range")));
  Press("m");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--color-by range --color-map cividis")));
  // The scale is that of the first frame until it is fitted.
  Press("End");
  const Picture kept = Shown();
  Press("f");
  const Picture fitted = Shown();
  EXPECT_FALSE(ArePointsAlike(kept, fitted));
  EXPECT_TRUE(ArePointsAlike(fitted, Expected("--frame 5 --color-by range --color-map cividis")));
  Press("C C C C");
  EXPECT_FALSE(ArePointsAlike(Shown(), fitted));
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

TEST_F(Window, ListsItsKeys) {
  Open({path_});
  const Picture before = Shown();
  Press("question");
  const Picture listed = Shown();
  // The plate is in the middle, and its words are brighter than all else.
  const Picture middle = listed.Part({200, 100}, 240, 280);
  EXPECT_GT(Differences(before.Part({200, 100}, 240, 280), middle).size(), 5000U);
  Press("question");
  EXPECT_TRUE(Shown() == before);
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

TEST_F(Window, TurnsAndZoomsAboutWhatItLooksAt) {
  Open({path_});
  const Camera before = CameraNow();
  EXPECT_TRUE(before.eye_m.isApprox(Vector3(-20, 0, 12), 1e-6));
  EXPECT_TRUE(before.target_m.isApprox(Vector3(35, 0, -2), 1e-6));
  // Dragging over the window's width is a full turn.
  Drag({300, 250}, {364, 250}, [&] {
    // While the mouse rests, nothing turns.
    const Picture first = Shown();
    EXPECT_TRUE(Shown() == first);
  });
  const Camera turned = CameraNow();
  EXPECT_TRUE(turned.target_m.isApprox(before.target_m, 1e-6));
  const Vector3 way_before_m = before.eye_m - before.target_m;
  const Vector3 expected_m =
      Eigen::AngleAxisd(-2.0 * std::numbers::pi * 64.0 / 640.0, Vector3::UnitZ()) * way_before_m;
  // The key k prints millimetres.
  EXPECT_TRUE((turned.eye_m - turned.target_m).isApprox(expected_m, 1e-4))
      << turned.eye_m.transpose();
  char options[160];
  std::snprintf(options, sizeof options, "--eye %.3f,%.3f,%.3f --target %.3f,%.3f,%.3f",
                turned.eye_m.x(), turned.eye_m.y(), turned.eye_m.z(), turned.target_m.x(),
                turned.target_m.y(), turned.target_m.z());
  const auto num_different = Differences(AboveFoot(Shown()), AboveFoot(Expected(options))).size();
  EXPECT_LT(num_different, 200U);  // The camera was rounded to millimetres.
  Click({320, 240}, 4);
  const Camera nearer = CameraNow();
  EXPECT_LT((nearer.eye_m - nearer.target_m).norm(), 0.95 * way_before_m.norm());
  Click({320, 240}, 5);
  const Camera back = CameraNow();
  EXPECT_NEAR((back.eye_m - back.target_m).norm(), way_before_m.norm(), 0.01);
  // The camera turns up to straight above the target and no farther. Two drags are enough, but on a
  // busy machine the window may see only the end of one.
  Drag({300, 400}, {300, 5});
  for (int i = 0; i < 4; ++i) Drag({300, 5}, {300, 400});
  const Camera above = CameraNow();
  EXPECT_NEAR(std::abs(above.eye_m.z() - above.target_m.z()), way_before_m.norm(), 0.01);
  Press("4");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("")));
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

TEST_F(Window, SaysWhatIsKnownOfThePointThatIsClicked) {
  Open({path_});
  const Picture before = Shown();
  const auto wagon = PointsOf(run_.ColorOf("wagon"), before);
  ASSERT_FALSE(wagon.empty());
  const Pixel place = wagon[wagon.size() / 2];
  Click(place);
  PointAt({600, 60});
  // The facts are those of --pick, in the upper right corner.
  const std::string pick = "--pick " + std::to_string(place.x) + "," + std::to_string(place.y);
  EXPECT_TRUE(ArePointsAlike(Shown(), Draw(pick + " " + path_)));
  EXPECT_NE(said().find("wagon (12)"), std::string::npos) << said();
  Press("l");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected(pick + " --select wagon")));
  Press("l e");
  const Picture traced = Expected(pick + " --trace");
  EXPECT_TRUE(WaitToShow(traced));
  Press("Escape");
  EXPECT_TRUE(Shown() == before);
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

TEST_F(Window, MeasuresFromClickToShiftClick) {
  Open({path_});
  const Picture before = Shown();
  const Pixel from = PointsOf(run_.ColorOf("person"), before).front();
  const Pixel to = PointsOf(run_.ColorOf("pole"), before).front();
  Click(from);
  PointAt(to);
  EXPECT_EQ(Xdotool("keydown shift click 1 keyup shift").status, 0);
  PointAt({600, 450});
  const auto option = [](const Pixel& place) {
    return "--pick " + std::to_string(place.x) + "," + std::to_string(place.y) + " ";
  };
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected(option(from) + option(to))));
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

TEST_F(Window, SelectsTheLabelThatIsClickedInTheLegend) {
  Open({path_});
  const Picture before = Shown();
  // The wagon's line is the one whose swatch has its colour.
  const auto swatch = before.PlacesOf(run_.ColorOf("wagon"));
  ASSERT_LT(swatch.front().x, 20);
  const Pixel line{swatch.front().x + 20, swatch.front().y + 3};
  Click(line);
  PointAt({600, 60});
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--select wagon")));
  Click(line);
  PointAt({600, 60});
  EXPECT_TRUE(Shown() == before);
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

TEST_F(Window, GoesToTheFrameThatTheSliderIsDraggedTo) {
  Open({path_});
  const Picture before = Shown();
  // The slider extends from 2 % of the width to 98 %, 1.6 % of the height above the bottom.
  const int y = static_cast<int>(std::lround(0.984 * kHeight));
  Drag({static_cast<int>(0.027 * kWidth), y}, {static_cast<int>(0.99 * kWidth), y});
  EXPECT_TRUE(WaitToShow(Expected("--frame 5")));
  Drag({static_cast<int>(0.973 * kWidth), y}, {static_cast<int>(0.01 * kWidth), y});
  EXPECT_TRUE(WaitToShow(Expected("")));
  EXPECT_TRUE(ArePointsAlike(Shown(), before));
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

TEST_F(Window, StaysOpenBesideAFrameThatCannotBeRead) {
  const std::string damaged = PathOf("damaged");
  std::filesystem::copy(path_, damaged, std::filesystem::copy_options::recursive);
  std::filesystem::resize_file(damaged + "/frames/000001.pcd", 1000);
  Open({damaged});
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("")));
  Press("Right");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("")));
  Press("Right");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected("--frame 2")));
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

TEST_F(Window, LooksFromAboveAsItsPrintedCameraSays) {
  Open({path_});
  Press("2");
  const Picture above = Shown();
  EXPECT_TRUE(ArePointsAlike(above, Expected("--camera top")));
  EXPECT_TRUE(
      ArePointsAlike(above, Expected(PrintedCamera().substr(0, PrintedCamera().find('\n')))));
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

TEST_F(Window, ComparesInThreeWays) {
  Open({path_, "--compare", path_});
  const std::string compare = "--compare " + path_;
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected(compare)));
  Press("v");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected(compare + " --layout distance")));
  Press("v");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected(compare + " --layout changes")));
  Press("v Right");
  EXPECT_TRUE(ArePointsAlike(Shown(), Expected(compare + " --frame 1")));
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

}  // namespace
}  // namespace railcast
