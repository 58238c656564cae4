#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/io/recording/line_reader.h"
#include "core/io/write_file.h"
#include "core/mesh/mesh_import.h"
#include "core/scenario/command_log.h"
#include "railcast/io/cloud_files.h"
#include "railcast/io/recording.h"
#include "railcast/lidar.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// The reader of each kind of file, by the file's extension.
const std::map<std::string, std::function<void(const fs::path&)>> kReaders = {
    {"pcd", [](const fs::path& file) { static_cast<void>(ReadPcd(file)); }},
    {"ply", [](const fs::path& file) { static_cast<void>(ReadPly(file)); }},
    {"pcap", [](const fs::path& file) { const PcapReader reader(file); }},
    {"txt", [](const fs::path& file) { static_cast<void>(ReadFileWhole(file)); }},
    {"csv", [](const fs::path& file) { const LineReader reader(file); }},
    {"jsonl", [](const fs::path& file) { static_cast<void>(ReadCommandLog(file)); }},
    {"lines", [](const fs::path& file) { static_cast<void>(CountLines(file)); }},
    {"obj", [](const fs::path& file) { static_cast<void>(ReadMesh(file)); }},
};

TEST(InputFiles, AreNoFifosWhoeverReadsThem) {
  const TemporaryDirectory directory;
  const auto make = [&](const std::string& name) {
    fs::path file = directory.path() / name;
    EXPECT_EQ(::mkfifo(file.c_str(), 0600), 0);
    return file;
  };
  for (const auto& [ending, read] : kReaders) {
    const fs::path file = make("read." + ending);
    EXPECT_EQ(MessageOf([&, &read = read] { read(file); }),
              file.string() + ": must be a regular file (got a FIFO)");
  }
  for (const char* ending : {"pcd", "ply", "bin", "pcap", "pcapng"}) {
    const fs::path file = make(std::string("opened.") + ending);
    EXPECT_EQ(MessageOf([&] {
                const auto recording = OpenRecording(file);
                while (const auto read = recording->Next()) (*read)();
              }),
              file.string() + ": must be a regular file (got a FIFO)");
  }
  const std::string scenario = make("scenario.json").string();
  EXPECT_EQ(MessageOf([&] { static_cast<void>(ReadScenario(scenario)); }),
            scenario + ": must be a file, not a FIFO");
  const std::string table = make("table").string();
  EXPECT_EQ(
      MessageOf([&] {
        static_cast<void>(BuildScanPattern({.rate_hz = 10.0, .pattern = FiringTableSpec{table}}));
      }),
      "/pattern/file: " + table + ": must be a regular file (got a FIFO)");
}

TEST(InputFiles, AreNamedOnOneLineWhateverTheyAreCalled) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "a\nb\x1b[31m.pcd";
  WriteFileWhole(file, "VERSION \x1b[2J\n");
  const std::string said = MessageOf([&] {
    const auto recording = OpenRecording(file);
    while (const auto read = recording->Next()) (*read)();
  });
  EXPECT_TRUE(said.starts_with((directory.path() / "a\\nb\\u001b[31m.pcd: ").string())) << said;
  EXPECT_EQ(said.find_first_of("\n\x1b"), std::string::npos) << said;
}

}  // namespace
}  // namespace railcast
