#include <gmock/gmock.h>
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
#include "tests/support/clouds.h"
#include "tests/support/written_file.h"

namespace railcast {
namespace {

using testing::ElementsAre;

std::string PcdText(const std::string& fields_to_counts, const std::string& lines) {
  return "VERSION .7\n" + fields_to_counts +
         "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n" + lines;
}

// Before the field `n`, writers leave padding `_` of any count, also of none.
constexpr const char* kPadded = "FIELDS x _ n _\nSIZE 4 1 2 1\nTYPE F U U U\nCOUNT 1 0 1 2\n";

TEST(PcdReader, SkipsFieldsOfCountZero) {
  const std::string lines = "0.5 7 1 1\n1.5 8 2 2\n";
  const std::string text = PcdText(kPadded, lines);
  const CloudFile read = ParsePcdFile("a.pcd", text);
  EXPECT_THAT(FieldNumbers(read.cloud, "n"), ElementsAre(7, 8));
  EXPECT_EQ(Rewritten(read, {read.cloud.data, {0, 1}}), std::vector{text});
  EXPECT_EQ(MessageOf([&] {
              (void)ParsePcdFile("a.pcd", PcdText("FIELDS x\nSIZE 4\nTYPE F\nCOUNT 0\n", "\n\n"));
            }),
            "a.pcd: COUNT: must not be 0 for all of FIELDS");
}

TEST(PcdReader, SkipsFieldsOfCountZeroInBinaryDataToo) {
  const std::string header =
      "FIELDS x _ n\nSIZE 4 1 2\nTYPE F U U\nCOUNT 1 0 1\nWIDTH 1\nHEIGHT 1\n";
  const std::string row("\0\0\0\x3F\x05\0", 6);
  const CloudFile read = ParsePcdFile("a.pcd", header + "DATA binary\n" + row);
  EXPECT_THAT(FieldNumbers(read.cloud, "x"), ElementsAre(0.5));
  EXPECT_THAT(FieldNumbers(read.cloud, "n"), ElementsAre(5));
}

TEST(PcdReader, TakesKeysTypesAndDataInAnyCase) {
  const std::string text =
      "Version .7\nfields x n\nsize 4 1\nType f u\ncount 1 1\nwidth 2\nHeight 1\npoints 2\n"
      "data ASCII\n0.5 7\n1.5 8\n";
  const CloudFile read = ParsePcdFile("a.pcd", text);
  EXPECT_THAT(FieldNumbers(read.cloud, "n"), ElementsAre(7, 8));
  const std::vector<std::uint8_t> first(read.cloud.data.begin(), read.cloud.data.begin() + 5);
  const std::string one = Rewritten(read, {first, {0}}).at(0);
  EXPECT_THAT(FieldNumbers(ParsePcdFile("a.pcd", one).cloud, "n"), ElementsAre(7));
}

TEST(PcdReader, PassesOverTheEndOfALineBehindBinaryDataAndSignsOfNumbers) {
  const std::string header = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nDATA ";
  const std::string point(12, '\1');
  EXPECT_EQ(ParsePcdFile("a.pcd", header + "binary\n" + point + "\n", {}).cloud.num_points(), 1U);
  EXPECT_EQ(ParsePcdFile("a.pcd", header + "ascii\n+1.0e+00 -2 +3\n", {}).cloud.num_points(), 1U);
}

TEST(PcdReader, ReadsACloudWithoutPoints) {
  const std::string header = "FIELDS x\nSIZE 4\nTYPE F\nCOUNT 1\nWIDTH 0\nHEIGHT 0\nPOINTS 0\n";
  for (const char* const data : {"ascii", "binary", "binary_compressed"}) {
    EXPECT_EQ(ParsePcdFile("a.pcd", header + "DATA " + data + "\n").cloud.num_points(), 0U);
  }
}

TEST(PcdReader, KeepsAllDigitsOfTextWhateverItsSizeSays) {
  const std::string fields = "FIELDS x intensity\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\n";
  const std::string lines = "456789.15 40000\n456790.12 50000.0\n";
  const std::string text = PcdText(fields, lines);
  const CloudFile read = ParsePcdFile("a.pcd", text);
  EXPECT_THAT(FieldNumbers(read.cloud, "x"), ElementsAre(456789.15, 456790.12));
  EXPECT_EQ(read.cloud.Find("intensity")->type, NumberType::kFloat);  // It holds these.
  EXPECT_EQ(Rewritten(read, {read.cloud.data, {0, 1}}), std::vector{text});
}

TEST(PcdReader, SaysThatItDoesNotUseTheViewpoint) {
  const std::string fields = "FIELDS x\nSIZE 4\nTYPE F\nCOUNT 1\n";
  std::string text = PcdText(fields, "1\n2\n");
  EXPECT_TRUE(ParsePcdFile("a.pcd", text).cloud.remarks.empty());
  text.replace(text.find("0 0 0 1"), 7, "10 0 2 1");
  EXPECT_THAT(ParsePcdFile("a.pcd", text).cloud.remarks,
              ElementsAre(Remark{.kind = RemarkKind::kViewpointUnused, .place = "a.pcd"}));
  text.replace(text.find("10 0 2 1"), 8, "ten 0 2 1");
  EXPECT_EQ(MessageOf([&] { (void)ParsePcdFile("a.pcd", text); }),
            "a.pcd: VIEWPOINT: must have 7 numbers (got ten)");
}

TEST(PcdReader, PassesOverAByteOrderMarkAndRefusesUtf16) {
  const std::string text = PcdText("FIELDS x\nSIZE 4\nTYPE F\nCOUNT 1\n", "1\n2\n");
  EXPECT_THAT(FieldNumbers(ParsePcdFile("a.pcd", "\xEF\xBB\xBF" + text).cloud, "x"),
              ElementsAre(1, 2));
  std::string utf16 = "\xFF\xFE";
  for (const char letter : text) utf16 += {letter, '\0'};
  EXPECT_EQ(MessageOf([&] { (void)ParsePcdFile("a.pcd", utf16); }),
            "a.pcd: is UTF-16; save as UTF-8");
}

std::string Example(PcdEncoding encoding) {
  return PcdBytes(ExampleFrame(0, 2, 3), FieldSelection("x,y,z,label"), encoding);
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
