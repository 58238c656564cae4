#include "core/base/unread_formats.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace railcast {
namespace {

class UnreadFormats : public testing::Test {
 protected:
  UnreadFormats() { std::filesystem::create_directory(folder_); }
  ~UnreadFormats() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string AdviceOn(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return AdviceOnFile(folder_ / name);
  }

 private:
  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / "railcast_unread_formats";
};

TEST_F(UnreadFormats, AreKnownByTheirEndingsInAnyCase) {
  EXPECT_EQ(AdviceOn("drive.bag", ""),
            "is a bag of ROS 1, which is not read: rosbags-convert --src drive.bag --dst drive");
  EXPECT_EQ(AdviceOn("drive.OSF", ""),
            "is a recording of Ouster's SDK, which is not read: ouster-cli source drive.OSF save "
            "drive.pcap");
  EXPECT_EQ(AdviceOn("site.laz", ""),
            "is compressed LAS, which is not read: pdal translate site.laz site.las (or las2las)");
  EXPECT_EQ(
      AdviceOn("MYNAME.laz", ""),
      "is compressed LAS, which is not read: pdal translate MYNAME.laz MYNAME.las (or las2las)");
}

TEST_F(UnreadFormats, StandInTheTableOfTheirPage) {
  const auto count = [](const std::string& file, const std::regex& row, const auto& visit) {
    std::ifstream in(std::string(RAILCAST_SOURCE_DIR "/") + file);
    const std::string text(std::istreambuf_iterator<char>(in), {});
    const auto rows = std::sregex_iterator(text.begin(), text.end(), row);
    return std::count_if(rows, {}, visit);
  };
  const std::regex row(R"(\| `(\.\w+)` \| ([^|\n]+) \| `?([^|`\n]+)`? \|)");
  const auto num_rows = count("docs/recordings.md", row, [&](const std::smatch& found) {
    const std::string file = "a" + found.str(1);
    std::string advice = std::regex_replace(found.str(3), std::regex("FILE"), file);
    advice = std::regex_replace(advice, std::regex("NAME"), "a");
    EXPECT_EQ(AdviceOn(file, ""), "is " + found.str(2) + ", which is not read: " + advice);
    return true;
  });
  EXPECT_EQ(num_rows, count("core/base/unread_formats.cpp", std::regex(R"(\n    \{"\.)"),
                            [](const std::smatch& /*found*/) { return true; }));
}

TEST_F(UnreadFormats, AreKnownByTheirFirstBytes) {
  EXPECT_TRUE(AdviceOn("drive", "#ROSBAG V2.0\n").starts_with("is a bag of ROS 1"));
  EXPECT_TRUE(AdviceOn("site", "ASTM-E57").starts_with("is a survey in E57"));
  EXPECT_TRUE(AdviceOn("points", "\x93NUMPY").starts_with("is an array of NumPy"));
  EXPECT_EQ(AdviceOn("drive.pcap", "version https://git-lfs.github.com/spec/v1\n"),
            "is a pointer of Git LFS to the file, which is not read: git lfs pull fetches it");
}

TEST_F(UnreadFormats, TellTextOfPosesFromTextOfPoints) {
  const std::string poses =
      " numbers a line, which is not read: if these are poses, name the clouds, and them with "
      "--poses";
  EXPECT_EQ(AdviceOn("tum.txt", "# time x y z qx qy qz qw\n1.5 0 0 0 0 0 0 1\n"),
            "is text with 8" + poses);
  EXPECT_EQ(AdviceOn("kitti.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n"), "is text with 12" + poses);
  EXPECT_TRUE(AdviceOn("cloud.csv", "x,y,z\n1,2,3\n")
                  .starts_with("is text with 3 numbers a line, which is not read: "));
  EXPECT_EQ(AdviceOn("notes.txt", "Dear reader,\n"), "");
}

TEST_F(UnreadFormats, AreNoOthers) {
  EXPECT_EQ(AdviceOn("notes.docx", "PK"), "");
  EXPECT_EQ(AdviceOnFile("/nowhere/drive.bag"), "");
}

TEST(UnreadTypes, AreNamedWithWhatToDo) {
  EXPECT_TRUE(AdviceOnType("foxglove.PointCloud", "protobuf").starts_with("Foxglove's own"));
  EXPECT_TRUE(AdviceOnType("sensor_msgs/PointCloud2", "ros1").starts_with("of ROS 1"));
  EXPECT_TRUE(AdviceOnType("sensor_msgs/msg/PointCloud2", "cdr").empty());
}

}  // namespace
}  // namespace railcast
