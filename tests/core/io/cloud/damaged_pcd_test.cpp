#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/io/cloud/cloud_file.h"
#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"
#include "tests/core/io/damage.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

std::string Example(PcdEncoding encoding) {
  std::string bytes;
  EncodePcd(ExampleFrame(0, 2, 3), FieldSelection("x,y,z,label"), encoding, bytes);
  return bytes;
}

std::string Message(const std::string& bytes) {
  return MessageOf([&] { (void)ParsePcdFile("a.pcd", bytes); });
}

struct Damage {
  const char* from;
  const char* to;
  const char* message;
};

TEST(ParsePcdFile, NamesTheFaultOfADamagedHeader) {
  const std::vector<Damage> damages = {
      {"WIDTH 3\n", "", "a.pcd: WIDTH: missing"},
      {"WIDTH 3", "WIDTH 4294967295",
       "a.pcd: POINTS: must be WIDTH x HEIGHT (got 6 for 4294967295 x 2)"},
      {"WIDTH 3", "WIDTH 99999999999999999999",
       "a.pcd: WIDTH: must be a whole number below 2^32 (got 99999999999999999999)"},
      {"WIDTH 3", "WIDTH -3", "a.pcd: WIDTH: must be a whole number below 2^32 (got -3)"},
      {"WIDTH 3\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 6",
       "WIDTH 4000000000\nHEIGHT 1\nPOINTS 4000000000",
       "a.pcd: POINTS: 4000000000 points of 16 bytes are 4 GiB or more"},
      {"WIDTH 3\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 6", "WIDTH 0\nHEIGHT 2\nPOINTS 0",
       "a.pcd: POINTS: 0 need 0 bytes, the file has 96"},
      {"POINTS 6", "POINTS 7", "a.pcd: POINTS: must be WIDTH x HEIGHT (got 7 for 3 x 2)"},
      {"SIZE 4 4 4 4", "SIZE 4 4 4",
       "a.pcd: SIZE: must have 4 entries, one for each of FIELDS (got 3)"},
      {"SIZE 4 4 4 4", "SIZE 4 4 4 3", "a.pcd: SIZE: no U has 3 bytes"},
      {"SIZE 4 4 4 4", "SIZE 4 4 2 4", "a.pcd: SIZE: no F has 2 bytes"},
      {"SIZE 4 4 4 4", "SIZE 4 4 8 4", "a.pcd: POINTS: 6 need 120 bytes, the file has 96"},
      {"TYPE F F F U", "TYPE F F F X", "a.pcd: TYPE: must be I, U or F (got X)"},
      {"COUNT 1 1 1 1", "COUNT 1 1 1 0", "a.pcd: POINTS: 6 need 72 bytes, the file has 96"},
      {"COUNT 1 1 1 1", "COUNT 1 1 1 1000", "a.pcd: POINTS: 6 need 24072 bytes, the file has 96"},
      {"VIEWPOINT 0 0 0 1 0 0 0", "VIEWPOINT 0 0", "a.pcd: VIEWPOINT: must have 7 numbers"},
      {"DATA binary", "DATA zip", "a.pcd: DATA: must be ascii, binary or binary_compressed"},
      {"HEIGHT 2", "WIDTH 3", "a.pcd: WIDTH: comes twice"},
      {"VERSION 0.7", "VERZION 0.7",
       "a.pcd: is no PCD file: a header line begins with none of its keys"},
  };
  const std::string sound = Example(PcdEncoding::kBinary);
  EXPECT_EQ(Message(sound), "no error");
  for (const Damage& damage : damages) {
    EXPECT_EQ(Message(Replaced(sound, damage.from, damage.to)), damage.message);
  }
}

// As PCL writes a PCLPointCloud2.
TEST(ParsePcdFile, TakesZerosBehindThePoints) {
  for (const PcdEncoding encoding : {PcdEncoding::kBinary, PcdEncoding::kBinaryCompressed}) {
    const std::string sound = Example(encoding);
    EXPECT_EQ(Message(sound + std::string(65'536, '\0')), "no error");
    EXPECT_NE(Message(sound + std::string(65'537, '\0')), "no error");
    EXPECT_NE(Message(sound + std::string(100, '\0') + "x"), "no error");
    const std::string padded = sound + std::string(300, '\0');
    const CloudFile read = ParsePcdFile("a.pcd", padded);
    EXPECT_EQ(Rewritten(read, {read.cloud.data, {0, 1, 2, 3, 4, 5}}), std::vector{sound});
  }
}

TEST(ParsePcdFile, NamesTheFaultOfDamagedPoints) {
  const std::string binary = Example(PcdEncoding::kBinary);
  EXPECT_EQ(Message(binary.substr(0, binary.size() - 1)),
            "a.pcd: POINTS: 6 need 96 bytes, the file has 95");
  EXPECT_EQ(Message(binary + std::string(65'537, '\0')),
            "a.pcd: POINTS: 6 need 96 bytes, the file has 65633");
  EXPECT_EQ(Message(binary + "x"), "a.pcd: POINTS: 6 need 96 bytes, the file has 97");
  const std::string ascii = Example(PcdEncoding::kAscii);
  EXPECT_EQ(Message(ascii.substr(0, ascii.rfind('\n', ascii.size() - 2) + 1)),
            "a.pcd: POINTS: 6 need as many lines, the file has 5");
  EXPECT_EQ(Message(Replaced(ascii, "nan nan nan 0", "nan nan 0")),
            "a.pcd: a point has fewer values than FIELDS asks for");
  EXPECT_EQ(Message(Replaced(ascii, "nan nan nan 0", "nan nan nan 0 0")),
            "a.pcd: a point has more values than FIELDS asks for");
  EXPECT_EQ(Message(Replaced(ascii, "nan nan nan 0", "nan nan nan -1")),
            "a.pcd: label: no value of its type (got -1)");
  const std::string packed = Example(PcdEncoding::kBinaryCompressed);
  EXPECT_EQ(Message(packed.substr(0, packed.size() - 1)).substr(0, 12), "a.pcd: DATA:");
  EXPECT_EQ(Message(""), "a.pcd: is no PCD file: its header has no DATA line");
}

TEST(ReadPcd, SurvivesEveryTruncation) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcd";
  for (const auto encoding :
       {PcdEncoding::kBinary, PcdEncoding::kBinaryCompressed, PcdEncoding::kAscii}) {
    const std::string sound = Example(encoding);
    // An ASCII file may lose its last line end, and the last digits of its last number, unnoticed.
    const std::size_t slack = encoding == PcdEncoding::kAscii ? 2 : 0;
    for (std::size_t size = 0; size + slack < sound.size(); ++size) {
      WriteFileWhole(file, sound.substr(0, size));
      const std::string message = MessageOf([&] { (void)ReadPcd(file); });
      EXPECT_EQ(message.find(file.string() + ": "), 0U) << size;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

TEST(ReadPcd, SurvivesEveryFlippedByte) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcd";
  for (const auto encoding :
       {PcdEncoding::kBinary, PcdEncoding::kBinaryCompressed, PcdEncoding::kAscii}) {
    const std::string sound = Example(encoding);
    for (std::size_t place = 0; place < sound.size(); ++place) {
      WriteFileWhole(file, Flipped(sound, place));
      const std::string message = MessageOf([&] { (void)ReadPcd(file); });
      // Some flips change only a value, a name or a comment.
      EXPECT_TRUE(message == "no error" || message.find(file.string() + ": ") == 0U) << message;
    }
  }
}

}  // namespace
}  // namespace railcast
