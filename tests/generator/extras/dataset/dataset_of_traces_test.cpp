#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>

#include "core/extras/osi/trace_file.h"
#include "core/io/write_file.h"
#include "tests/generator/extras/dataset/dataset_in_format.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

/// Data sets whose frames are in traces of OSI.
class DatasetOfTraces : public DatasetInFormat {};

INSTANTIATE_TEST_SUITE_P(Formats, DatasetOfTraces, testing::Values("osi", "osi-mcap"));

TEST_P(DatasetOfTraces, SaysInItsIndexWhereTheMessagesAre) {
  Make("set");
  std::istringstream lines(ReadFileWhole(Path("set/index.jsonl")));
  std::size_t num_lines = 0;
  for (std::string line; std::getline(lines, line); ++num_lines) {
    const Json frame = Json::parse(line);
    EXPECT_EQ(frame.at("files"), Json::array());
    const std::string trace = frame.at("trace");
    EXPECT_THAT(trace, EndsWith(GetParam() == std::string("osi") ? ".osi" : ".mcap"));
    const fs::path folder = Path("set") / frame.at("folder").get<std::string>();
    const std::string sensor = frame.at("sensor");
    EXPECT_THAT(trace, HasSubstr("_" + sensor + "."));
    osi::TraceReader messages(folder / trace);
    std::size_t num_messages = 0;
    while (messages.NextHash()) ++num_messages;
    EXPECT_EQ(num_messages, sensor == "front" ? 2U : 4U);
  }
  EXPECT_EQ(num_lines, 3U * (2 + 4));
  EXPECT_THAT(FaultsOf("set"), IsEmpty());
}

TEST_P(DatasetOfTraces, IsTheSameOfShardsAndIsWholeThen) {
  ExpectTheSameOfShards();
}

TEST_P(DatasetOfTraces, HasTheSameBytesAfterAnInterruption) {
  ExpectTheSameAfterAnInterruption();
}

TEST_P(DatasetOfTraces, IsNotWholeWithoutAMessage) {
  Make("set");
  for (const auto& entry : fs::recursive_directory_iterator(Path("set"))) {
    const fs::path& file = entry.path();
    if (file.extension() != ".osi" && file.extension() != ".mcap") continue;
    const std::string bytes = ReadFileWhole(file);
    WriteFileWhole(file, bytes.substr(0, bytes.size() / 2));
    EXPECT_THAT(FaultsOf("set"), Contains(HasSubstr(file.string())));
    return;
  }
  FAIL() << "there is no trace";
}

}  // namespace
}  // namespace railcast
