#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"
#include "tests/viewer/program/display.h"
#include "tests/viewer/program/picture.h"

namespace railcast {

/// Runs railcast-view. A signal gives a status of 128 plus its number.
inline Ended View(const std::string& arguments) {
  return RunCommand(RAILCAST_VIEW " " + arguments);
}

/// A test of the program with a folder of its own.
class RailcastView : public testing::Test {
 protected:
  [[nodiscard]] std::string PathOf(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  void Write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories((folder_.path() / name).parent_path());
    std::ofstream(folder_.path() / name, std::ios::binary) << bytes;
  }

 private:
  TemporaryDirectory folder_;
};

/// Base of the tests that draw, which need a display; Xvfb provides one without a screen.
class Drawn : public RailcastView {
 protected:
  void SetUp() override {
    if (!VirtualScreen::IsThere()) GTEST_SKIP() << "Xvfb is missing";
  }

  static constexpr int kWidth = 640;
  static constexpr int kHeight = 480;

  /// Returns the picture written by --screenshot, 640 x 480 unless the arguments say otherwise. If
  /// the program fails, so does the test, and the picture is empty.
  [[nodiscard]] Picture Draw(const std::string& arguments) {
    const bool has_size = arguments.find("--size") != std::string::npos;
    std::filesystem::remove(PathOf("out.png"));
    said_ = View((has_size ? "" : "--size 640x480 ") + ("--screenshot " + PathOf("out.png")) + " " +
                 arguments);
    EXPECT_EQ(said_.status, 0) << arguments << '\n' << said_.said;
    return ReadPicture(PathOf("out.png"));
  }
  /// Output of the last Draw().
  [[nodiscard]] const std::string& said() const { return said_.said; }

 private:
  Ended said_;
};

}  // namespace railcast
