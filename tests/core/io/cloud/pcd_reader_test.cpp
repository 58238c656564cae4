#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/io/cloud/cloud_file.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

using testing::ElementsAre;

std::vector<double> PcdValues(const Cloud& cloud, const std::string& name) {
  std::vector<double> values(cloud.num_points());
  VisitField(cloud, *cloud.Find(name),
             [&](std::size_t i, auto value) { values[i] = static_cast<double>(value); });
  return values;
}

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
  EXPECT_THAT(PcdValues(read.cloud, "n"), ElementsAre(7, 8));
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
  EXPECT_THAT(PcdValues(read.cloud, "x"), ElementsAre(0.5));
  EXPECT_THAT(PcdValues(read.cloud, "n"), ElementsAre(5));
}

TEST(PcdReader, TakesKeysTypesAndDataInAnyCase) {
  const std::string text =
      "Version .7\nfields x n\nsize 4 1\nType f u\ncount 1 1\nwidth 2\nHeight 1\npoints 2\n"
      "data ASCII\n0.5 7\n1.5 8\n";
  const CloudFile read = ParsePcdFile("a.pcd", text);
  EXPECT_THAT(PcdValues(read.cloud, "n"), ElementsAre(7, 8));
  const std::vector<std::uint8_t> first(read.cloud.data.begin(), read.cloud.data.begin() + 5);
  const std::string one = Rewritten(read, {first, {0}}).at(0);
  EXPECT_THAT(PcdValues(ParsePcdFile("a.pcd", one).cloud, "n"), ElementsAre(7));
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
  EXPECT_THAT(PcdValues(read.cloud, "x"), ElementsAre(456789.15, 456790.12));
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
  EXPECT_THAT(PcdValues(ParsePcdFile("a.pcd", "\xEF\xBB\xBF" + text).cloud, "x"),
              ElementsAre(1, 2));
  std::string utf16 = "\xFF\xFE";
  for (const char letter : text) utf16 += {letter, '\0'};
  EXPECT_EQ(MessageOf([&] { (void)ParsePcdFile("a.pcd", utf16); }),
            "a.pcd: is UTF-16; save as UTF-8");
}

}  // namespace
}  // namespace railcast
