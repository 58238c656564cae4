#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>

#include "core/io/write_file.h"
#include "generator/extras/import/map/read_map.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFolder = RAILCAST_SOURCE_DIR "/tests/generator/extras/import/malformed";

std::string FaultOf(const fs::path& file) {
  return MessageOf([&] { static_cast<void>(ReadMap(file)); });
}

/// The lines of NAME.expected, each with the file before it.
std::string ExpectedFaultOf(const fs::path& file) {
  std::istringstream lines(ReadFileWhole(file.string() + ".expected"));
  std::string expected;
  for (std::string line; std::getline(lines, line);) {
    expected += (expected.empty() ? "" : "\n") + file.string() + ": " + line;
  }
  return expected;
}

TEST(MalformedMaps, AreRefusedWithFilePlaceRuleAndValue) {
  int num_maps = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().extension() == ".expected") continue;
    ++num_maps;
    EXPECT_EQ(FaultOf(entry.path()), ExpectedFaultOf(entry.path()));
  }
  EXPECT_GE(num_maps, 10);
}

}  // namespace
}  // namespace railcast
