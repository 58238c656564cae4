#include "core/extras/osi/trace_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "core/io/content_hash.h"
#include "core/io/run/sequence_files.h"
#include "core/io/run/trace_name.h"
#include "core/io/write_file.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast::osi {
namespace {

std::string LengthText(std::uint32_t length) {
  std::string text(sizeof length, '\0');
  std::memcpy(text.data(), &length, sizeof length);
  return text;
}

class TraceFile : public testing::Test {
 protected:
  // What is wrong with a trace of these bytes behind a message of three.
  [[nodiscard]] std::string FaultOf(const std::string& bytes) const {
    WriteFileWhole(file_, LengthText(3) + "abc" + bytes);
    TraceReader trace(file_);
    EXPECT_EQ(trace.NextHash(), ContentHash("abc"));
    EXPECT_EQ(trace.NextHash(), std::nullopt);
    return trace.fault();
  }

  const TemporaryDirectory folder_;
  const std::filesystem::path file_ = folder_.path() / "a.osi";
};

TEST_F(TraceFile, HasMessagesBehindTheirLengths) {
  WriteFileWhole(file_, LengthText(3) + "abc" + LengthText(0) + LengthText(2) + "de");
  TraceReader trace(file_);
  for (const char* const message : {"abc", "", "de"}) {
    EXPECT_EQ(trace.NextHash(), ContentHash(message));
  }
  EXPECT_EQ(trace.NextHash(), std::nullopt);
  EXPECT_EQ(trace.fault(), "");
}

TEST_F(TraceFile, OfNothingHasNoMessages) {
  WriteFileWhole(file_, "");
  TraceReader trace(file_);
  EXPECT_EQ(trace.NextHash(), std::nullopt);
  EXPECT_EQ(trace.fault(), "");
}

TEST_F(TraceFile, EndsBeforeWhatIsNotWhole) {
  const std::string place = file_.string() + ": message 2: ";
  EXPECT_EQ(FaultOf("ab"), place + "must begin with its length, 4 bytes (got 2)");
  EXPECT_EQ(FaultOf(LengthText(9) + "1234"),
            place + "must lie within the file (got 9 bytes where it has 4 more)");
  EXPECT_EQ(FaultOf(LengthText(std::numeric_limits<std::uint32_t>::max()) + "1234"),
            place + "length: must be < 2^31 (got 4294967295)");
}

TEST(TraceName, SaysWhatTheStandardRecommends) {
  const std::string name = TraceName({"3.21.12", 50, "front left", ".osi"});
  EXPECT_EQ(name, "19700101T000000Z_sv_380_32112_50_front_left.osi");
  EXPECT_TRUE(IsTraceName(name));
  EXPECT_TRUE(IsSequenceFile(name));
  const std::string unnamed = TraceName({"3.21.12", 7, "", ".mcap"});
  EXPECT_EQ(unnamed, "19700101T000000Z_sv_380_32112_7_lidar.mcap");
  EXPECT_TRUE(IsTraceName(unnamed));
}

TEST(TraceName, IsNoOtherName) {
  for (const char* const name :
       {"", "a.osi", "19700101T000000Z_sv_380_", "19700101T000000Z_sv_380_1_1_a",
        "19700101T000000Z_sv_380_1_1_a.osi.part", "19700101T000000Z_sv_380_1_1_a/b.osi",
        "19700101T000000Z_sv_380_1_1_../a.osi", "20230621T113737Z_sv_350_32112_100.osi"}) {
    EXPECT_FALSE(IsTraceName(name)) << name;
  }
}

}  // namespace
}  // namespace railcast::osi
