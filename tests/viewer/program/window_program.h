#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tests/viewer/program/drawn_points.h"
#include "tests/viewer/program/running_program.h"
#include "tests/viewer/program/view_program.h"

namespace railcast {

/// A window of 640 x 480 driven as by a user: keys and the mouse come from the X server (xdotool),
/// and pictures from the key p, which takes effect after the keys before it.
class WindowTest : public Drawn {
 protected:
  void SetUp() override {
    Drawn::SetUp();
    if (std::system("command -v xdotool > /dev/null") != 0) GTEST_SKIP() << "xdotool is missing";
  }
  void TearDown() override { window_.reset(); }

  /// Opens the window and waits until it responds to keys, which is later than its appearance: it
  /// then prints its camera.
  void Open(const std::vector<std::string>& arguments) {
    OpenDeaf(arguments);
    ASSERT_TRUE(window_->WaitUntil([&] {
      Press("k");
      return window_->Said().find("--eye") != std::string::npos;
    })) << window_->Said();
    // Waits until all those keys have had their effect.
    (void)Shown();
  }
  /// Opens the window and waits until it appears.
  void OpenDeaf(const std::vector<std::string>& arguments) {
    std::vector<std::string> command = {RAILCAST_VIEW, "--size", "640x480"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    std::filesystem::create_directories(PathOf("desk"));
    window_ = std::make_unique<RunningProgram>(command, PathOf("said.txt"), PathOf("desk"));
    const bool is_open = window_->WaitUntil([&] {
      id_ = Xdotool("search --onlyvisible --name '^railcast-view$'").said;
      return !id_.empty() && id_.back() == '\n';
    });
    ASSERT_TRUE(is_open) << window_->Said();
    id_ = id_.substr(0, id_.find('\n'));
    // Without a window manager, keys go to the window under the pointer. The pointer stays away
    // from all widgets that light up under it.
    PointAt({600, 60});
    num_pictures_ = 0;
  }

  static Ended Xdotool(const std::string& arguments) {
    return RunCommand("xdotool " + arguments + " 2>/dev/null");
  }
  void PointAt(const Pixel& place) {
    EXPECT_EQ(Xdotool("mousemove --window " + id_ + " " + std::to_string(place.x) + " " +
                      std::to_string(place.y))
                  .status,
              0);
  }
  /// Presses keys by their X names, one after another: "Right Right c".
  void Press(const std::string& keys) { EXPECT_EQ(Xdotool("key --delay 5 " + keys).status, 0); }
  void Click(const Pixel& place, int button = 1) {
    PointAt(place);
    EXPECT_EQ(Xdotool("click " + std::to_string(button)).status, 0);
  }
  /// Drags in steps, as a hand does; holds the button at the end while `while_held` runs.
  template <typename WhileHeld>
  void Drag(const Pixel& from, const Pixel& to, WhileHeld&& while_held) {
    PointAt(from);
    EXPECT_EQ(Xdotool("mousedown 1").status, 0);
    constexpr int kNumSteps = 4;
    for (int step = 1; step <= kNumSteps; ++step) {
      PointAt({from.x + (to.x - from.x) * step / kNumSteps,
               from.y + (to.y - from.y) * step / kNumSteps});
    }
    while_held();
    EXPECT_EQ(Xdotool("mouseup 1").status, 0);
  }
  void Drag(const Pixel& from, const Pixel& to) {
    Drag(from, to, [] {});
  }

  /// Returns the contents of the window after all earlier input has had its effect.
  [[nodiscard]] Picture Shown() {
    const std::string file =
        PathOf("desk/railcast-view-" + std::to_string(++num_pictures_) + ".png");
    Press("p");
    EXPECT_TRUE(window_->WaitUntil([&] { return std::filesystem::exists(file); }))
        << window_->Said();
    return ReadPicture(file);
  }
  /// Waits until the window shows a picture, compared without the words, which say whether it
  /// plays.
  [[nodiscard]] bool WaitToShow(const Picture& picture) {
    return window_->WaitUntil([&] { return ArePointsAlike(Shown(), picture); });
  }
  /// Returns what the key k prints.
  [[nodiscard]] std::string PrintedCamera() {
    const std::size_t before = window_->Said().size();
    Press("k");
    std::string line;
    EXPECT_TRUE(window_->WaitUntil([&] {
      // The message about the last picture may still be under way.
      const std::string said = window_->Said().substr(before);
      const std::size_t at = said.find("--eye");
      if (at == std::string::npos || said.back() != '\n') return false;
      line = said.substr(at);
      return true;
    }));
    return line;
  }

  /// Returns the part above the status and the slider.
  static Picture AboveFoot(const Picture& picture) {
    return picture.width == 0 ? picture : picture.Part({0, 0}, picture.width, 395);
  }
  static bool ArePointsAlike(const Picture& a, const Picture& b) {
    return AboveFoot(a) == AboveFoot(b);
  }

  [[nodiscard]] RunningProgram& window() { return *window_; }

 private:
  std::unique_ptr<RunningProgram> window_;
  std::string id_;
  int num_pictures_ = 0;
};

}  // namespace railcast
