#include "railcast/io/recording.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "core/io/recording/source_choice.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

/// What is said of a source by a build without extras, as that of this test is.
std::string MessageWithoutExtras(const std::filesystem::path& source) {
  return MessageOf([&] { static_cast<void>(OpenRecording(source)); });
}

TEST(OpenRecording, NamesTheExtraThatItLacks) {
  const TemporaryDirectory folder;
  const auto needs = [](const std::filesystem::path& source, const std::string& extra,
                        const std::string& option) {
    return source.string() + ": needs the extra " + extra +
           ", which is not installed (Debian package railcast-" + extra +
           "; to build it, -D RAILCAST_BUILD_" + option + "=ON)";
  };
  for (const char* name : {"a.pcap", "b.PCAP", "c.pcapng", "d:1.pcap"}) {
    const auto file = folder.path() / name;
    WriteFileWhole(file, "content");
    EXPECT_EQ(MessageWithoutExtras(file), needs(file, "packets", "PACKETS"));
    const std::filesystem::path of_sensor = file.string() + ":os.json:192.168.1.201";
    EXPECT_EQ(MessageWithoutExtras(of_sensor), needs(of_sensor, "packets", "PACKETS"));
    EXPECT_EQ(MessageOf([&] { static_cast<void>(WithChoice({file}, {.sensor = "10.0.0.1"})); }),
              needs(file, "packets", "PACKETS"));
  }
  for (const char* name : {"bag/a.mcap", "bags/a_0.db3"}) {
    const auto file = folder.path() / name;
    std::filesystem::create_directory(file.parent_path());
    WriteFileWhole(file, "content");
    EXPECT_EQ(MessageWithoutExtras(file), needs(file, "ros", "ROS"));
    EXPECT_EQ(MessageWithoutExtras(file.parent_path()), needs(file.parent_path(), "ros", "ROS"));
    const std::filesystem::path topic = file.string() + ":/points";
    EXPECT_EQ(MessageWithoutExtras(topic), needs(topic, "ros", "ROS"));
    EXPECT_EQ(MessageOf([&] { static_cast<void>(WithChoice({file}, {.topic = "/points"})); }),
              needs(file, "ros", "ROS"));
  }
}

TEST(OpenRecording, NamesNoExtraForWhatNoneReads) {
  const TemporaryDirectory folder;
  const auto missing = folder.path() / "a.pcap";
  EXPECT_EQ(MessageWithoutExtras(missing), missing.string() + ": no such file or directory");
  const auto file = folder.path() / "a.dat";
  WriteFileWhole(file, "content");
  EXPECT_EQ(MessageWithoutExtras(file), file.string() +
                                            ": must be a directory or a .pcd, .ply, .bin, .las, "
                                            ".xyz, .pts, .asc, .pc, .txt or .csv file");
}

}  // namespace
}  // namespace railcast
