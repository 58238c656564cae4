#include "core/base/input_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <string_view>

#include "core/base/unread_formats.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

std::string Opening(const std::filesystem::path& file) {
  return MessageOf([&] { static_cast<void>(OpenInput(file)); });
}

TEST(OpenInput, ReadsRegularFilesAndWhatLinksToThem) {
  const TemporaryDirectory directory;
  std::ofstream(directory.path() / "a") << "text";
  std::filesystem::create_symlink("a", directory.path() / "link");
  for (const char* name : {"a", "link"}) {
    std::ifstream stream = OpenInput(directory.path() / name);
    std::string word;
    stream >> word;
    EXPECT_EQ(word, "text");
  }
}

// Opening the FIFO would wait for a writer indefinitely.
TEST(OpenInput, WaitsForNothing) {
  const TemporaryDirectory directory;
  const std::string fifo = (directory.path() / "fifo").string();
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  std::filesystem::create_symlink("fifo", directory.path() / "link");
  EXPECT_EQ(Opening(fifo), fifo + ": must be a regular file (got a FIFO)");
  const std::string link = (directory.path() / "link").string();
  EXPECT_EQ(Opening(link), link + ": must be a regular file (got a FIFO)");
  EXPECT_EQ(Opening("/dev/zero"), "/dev/zero: must be a regular file (got a character device)");
  EXPECT_EQ(Opening("/"), "/: must be a regular file (got a directory)");
}

TEST(OpenInput, SaysWhyAFileCannotBeRead) {
  EXPECT_EQ(Opening("/no/such/file"), "/no/such/file: no such file or directory");
  const TemporaryDirectory directory;
  const std::filesystem::path loop = directory.path() / "loop";
  std::filesystem::create_symlink("loop", loop);
  EXPECT_EQ(Opening(loop), loop.string() + ": too many levels of symbolic links");
}

TEST(ReadFileWhole, GivesTheBytesAsTheyAre) {
  const TemporaryDirectory directory;
  const std::filesystem::path file = directory.path() / "a";
  for (const std::string& bytes : {std::string(), std::string("a\r\n\0\x1a\xff\n\0", 8)}) {
    std::ofstream(file, std::ios::binary) << bytes;
    EXPECT_EQ(ReadFileWhole(file), bytes);
  }
}

TEST(ReadFileWhole, SaysWhyItCannot) {
  EXPECT_EQ(MessageOf([] { static_cast<void>(ReadFileWhole("/")); }),
            "/: must be a regular file (got a directory)");
  EXPECT_EQ(MessageOf([] { static_cast<void>(ReadFileWhole("/no/such/file")); }),
            "/no/such/file: no such file or directory");
}

TEST(FileError, StaysOneLineWhateverTheFileIsCalled) {
  EXPECT_STREQ(FileError("a\nb\x1b[2J\xff", ENOENT).what(),
               "a\\nb\\u001b[2J\\xff: no such file or directory");
}

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
  const auto num_rows = count("docs/results/unread_formats.md", row, [&](const std::smatch& found) {
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
  EXPECT_TRUE(AdviceOn("dem.asc", "ncols 4\n").starts_with("is a grid of heights"));
  EXPECT_TRUE(AdviceOn("log.txt", "$GPGGA,1,2\n").starts_with("is a log of a GPS receiver"));
  EXPECT_EQ(AdviceOn("drive.pcap", "version https://git-lfs.github.com/spec/v1\n"),
            "is a pointer of Git LFS to the file, which is not read: git lfs pull fetches it");
}

TEST(UnreadTypes, AreKnownByTheirNamesAndEncodings) {
  const auto begins = [](std::string_view type, std::string_view encoding) {
    const std::string_view advice = AdviceOnType(type, encoding);
    return advice.substr(0, advice.find(", which"));
  };
  EXPECT_EQ(begins("sensor_msgs/PointCloud2", "ros1"), "of ROS 1");
  EXPECT_EQ(begins("point_cloud_interfaces/msg/CompressedPointCloud2", "cdr"), "compressed");
  EXPECT_EQ(begins("foxglove.PointCloud", "protobuf"), "Foxglove's own");
  EXPECT_EQ(begins("sensor_msgs/msg/PointCloud", "cdr"), "the older cloud");
  EXPECT_EQ(begins("sensor_msgs/msg/LaserScan", "cdr"), "a scan of one plane");
  EXPECT_EQ(begins("rslidar_msg/msg/RslidarPacket", "cdr"), "packets of RoboSense");
  EXPECT_EQ(begins("hesai_ros_driver/msg/UdpFrame", "cdr"), "packets of Hesai's driver");
  EXPECT_EQ(begins("sensor_msgs/msg/PointCloud2", "cdr"), "");
}

TEST_F(UnreadFormats, TellTextOfPosesFromTextOfPoints) {
  const std::string poses =
      " numbers a line, which is not read: if these are poses, name the clouds, and them with "
      "--poses; if it is a cloud, name its columns with --columns";
  EXPECT_EQ(AdviceOn("tum.txt", "# time x y z qx qy qz qw\n1.5 0 0 0 0 0 0 1\n"),
            "is text with 8" + poses);
  EXPECT_EQ(AdviceOn("kitti.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n"), "is text with 12" + poses);
  EXPECT_EQ(AdviceOn("cloud.csv", "x,y,z\n1,2,3\n"), "");
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
