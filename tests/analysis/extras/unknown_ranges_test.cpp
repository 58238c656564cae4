// Reports of clouds of which it is not known where their sensor was.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "tests/analysis/analyze_program.h"
#include "tests/core/extras/ros/recording/made_bag.h"

namespace railcast {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A floor and a wall, 40 m from the origin of the world.
std::vector<std::array<float, 3>> Yard() {
  std::vector<std::array<float, 3>> points_m;
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k < 60; ++k) {
      const auto u_m = 0.15F * static_cast<float>(i);
      const auto v_m = 0.15F * static_cast<float>(k);
      points_m.push_back({40.0F + u_m, v_m, 0.001F * static_cast<float>((7 * i + 3 * k) % 5)});
      points_m.push_back({50.0F, v_m, u_m});
    }
  }
  return points_m;
}

/// Writes the yard as clouds of a bag in this frame of reference.
std::filesystem::path WriteBag(const std::string& frame_id, MadeBag& bag) {
  for (int i = 0; i < 2; ++i) {
    auto cloud = CloudOf(Yard(), i * kSecond_ns);
    cloud.header.frame_id = frame_id;
    bag.Add("/points", i, cloud);
  }
  return bag.Closed();
}

/// Writes the yard in a national grid.
std::filesystem::path WriteInGrid(const TemporaryFolder& folder) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(Yard().size()) +
                     "\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  for (const auto& [x_m, y_m, z_m] : Yard()) {
    text += std::to_string(691'000.0 + double{x_m}) + " " +
            std::to_string(5'335'000.0 + double{y_m}) + " " + std::to_string(z_m) + "\n";
  }
  return folder.Write("grid.ply", text);
}

void ExpectNoRanges(const std::filesystem::path& source, const std::string& why) {
  const std::string remark = "without figures by range: " + why;
  const Ended stats = Analyze("stats " + source.string() + " --format text");
  EXPECT_EQ(stats.status, 0) << stats.said;
  EXPECT_THAT(stats.said, HasSubstr(remark));
  EXPECT_THAT(stats.said, Not(HasSubstr("Range noise on planes")));
  EXPECT_THAT(stats.said, Not(HasSubstr("Exponent of density")));
  const Ended inspect = Analyze("inspect " + source.string() + " --format text");
  EXPECT_EQ(inspect.status, 0) << inspect.said;
  EXPECT_THAT(inspect.said, HasSubstr(remark));
  EXPECT_THAT(inspect.said, Not(HasSubstr("range, median")));
  const std::string other = (source.parent_path() / "other").string();
  std::filesystem::copy(source, other + source.extension().string());
  const Ended compare = Analyze("compare " + source.string() + " " + other +
                                source.extension().string() + " --format json");
  EXPECT_EQ(compare.status, 0) << compare.said;
  EXPECT_THAT(compare.said, HasSubstr(remark));
  for (const char* const command : {"fit ", "preset "}) {
    const Ended run = Analyze(command + source.string() + " --format text");
    EXPECT_EQ(run.status, 1) << command;
    EXPECT_THAT(run.said, HasSubstr(": must be in the axes of its sensor: " + why)) << command;
  }
}

TEST(UnknownRanges, AreInNoReportOfCloudsInAFixedFrame) {
  for (const std::string frame_id : {"map", "robot1/odom"}) {
    MadeBag bag;
    ExpectNoRanges(WriteBag(frame_id, bag),
                   "its frame_id \"" + frame_id +
                       "\" is that of a fixed frame, and where the sensor was is not known");
  }
}

TEST(UnknownRanges, AreInNoReportOfMapCoordinates) {
  const TemporaryFolder folder;
  ExpectNoRanges(WriteInGrid(folder),
                 "its positions are map coordinates, and where the sensor was is not known");
}

TEST(UnknownRanges, AreKnownInTheAxesOfTheSensor) {
  MadeBag bag;
  const Ended stats = Analyze("stats " + WriteBag("lidar", bag).string() + " --format text");
  EXPECT_THAT(stats.said, HasSubstr("Range noise on planes, 50 to 60 m"));
}

}  // namespace
}  // namespace railcast
