#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
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

/// The bytes of a number in either order.
template <typename Number>
std::string NumberBytes(Number number, bool is_big) {
  auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  if (is_big) std::ranges::reverse(bytes);
  return {bytes.begin(), bytes.end()};
}

const std::string kPlyVertex = "element vertex 2\nproperty float x\nproperty ushort ring\n";

std::string PlyHeaderOf(bool is_big, const std::string& elements) {
  return std::string("ply\nformat binary_") + (is_big ? "big" : "little") + "_endian 1.0\n" +
         elements + "end_header\n";
}

std::string PlyPoints(bool is_big) {
  return NumberBytes(6.5F, is_big) + NumberBytes(std::uint16_t{300}, is_big) +
         NumberBytes(-0.25F, is_big) + NumberBytes(std::uint16_t{2}, is_big);
}

std::string PlyFault(const std::string& bytes) {
  return MessageOf([&] { (void)ParsePlyFile("a.ply", bytes); });
}

TEST(PlyReader, ReadsAndRewritesEitherByteOrder) {
  for (const bool is_big : {false, true}) {
    const std::string bytes = PlyHeaderOf(is_big, kPlyVertex) + PlyPoints(is_big);
    const CloudFile read = ParsePlyFile("a.ply", bytes);
    EXPECT_THAT(FieldNumbers(read.cloud, "x"), ElementsAre(6.5, -0.25));
    EXPECT_THAT(FieldNumbers(read.cloud, "ring"), ElementsAre(300, 2));
    EXPECT_EQ(Rewritten(read, {read.cloud.data, {0, 1}}), std::vector{bytes});
  }
}

TEST(PlyReader, SkipsElementsBeforeThePointsByTheirSize) {
  const std::string camera =
      "element camera 2\nproperty double w\nproperty list uchar short list\n";
  for (const bool is_big : {false, true}) {
    const std::string skipped = NumberBytes(1.0, is_big) + NumberBytes(std::uint8_t{0}, is_big) +
                                NumberBytes(2.0, is_big) + NumberBytes(std::uint8_t{1}, is_big) +
                                NumberBytes(std::int16_t{7}, is_big);
    const std::string bytes =
        PlyHeaderOf(is_big, camera + kPlyVertex) + skipped + PlyPoints(is_big);
    const CloudFile read = ParsePlyFile("a.ply", bytes);
    EXPECT_THAT(FieldNumbers(read.cloud, "x"), ElementsAre(6.5, -0.25));
    EXPECT_EQ(Rewritten(read, {read.cloud.data, {0, 1}}), std::vector{bytes});
  }
  const CloudFile text = ParsePlyFile("a.ply", "ply\nformat ascii 1.0\n" + camera + kPlyVertex +
                                                   "end_header\n1 0\n2 1 7\n6.5 3\n1 4\n");
  EXPECT_THAT(FieldNumbers(text.cloud, "ring"), ElementsAre(3, 4));
}

TEST(PlyReader, PassesOverBlankLinesOfText) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n\n1 2 3\n\n4 5 6\n";
  EXPECT_EQ(ParsePlyFile("a.ply", text, {}).cloud.num_points(), 2U);
}

TEST(PlyReader, RefusesWhatStandsBehindItsElements) {
  const std::string bytes = PlyHeaderOf(false, kPlyVertex) + PlyPoints(false);
  EXPECT_EQ(
      PlyFault(bytes + PlyPoints(false)),
      "a.ply: element vertex: 2 points, but the file has 12 bytes more than its elements need");
  EXPECT_EQ(PlyFault(bytes + "\r\n"), "no error");
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string text = "ply\nformat ascii 1.0\n" + kPlyVertex + face + "end_header\n1 2\n3 4\n";
  EXPECT_EQ(PlyFault(text + "3 0 1 0\n\n"), "no error");
  EXPECT_EQ(
      PlyFault(text + "3 0 1 0\n5 6\n7 8\n"),
      "a.ply: element vertex: 2 points, but the file has 2 lines more than its elements need");
}

TEST(PlyReader, TellsOfElementsBehindThePointsThatAreCut) {
  const std::string faces = "element face 2\nproperty list uchar uchar vertex_indices\n";
  const std::string bytes = PlyHeaderOf(false, kPlyVertex + faces) + PlyPoints(false);
  const std::string face = {'\3', '\0', '\1', '\0'};
  EXPECT_THAT(ParsePlyFile("a.ply", bytes + face + face, {}).cloud.remarks, testing::IsEmpty());
  const std::vector<Remark> remarks = ParsePlyFile("a.ply", bytes + face, {}).cloud.remarks;
  EXPECT_EQ(
      remarks,
      (std::vector<Remark>{{RemarkKind::kRecordingCut, "a.ply", 1, "it lacks elements face"}}));
}

TEST(PlyReader, KeepsAllDigitsOfText) {
  const CloudFile read = ParsePlyFile(
      "a.ply", "ply\nformat ascii 1.0\n" + kPlyVertex + "end_header\n456789.15 2\n456790.12 4\n");
  EXPECT_THAT(FieldNumbers(read.cloud, "x"), ElementsAre(456789.15, 456790.12));
}

std::string PlyExample() {
  return PlyBytes(ExampleFrame(0, 2, 9), FieldSelection("x,y,z,label"));
}

TEST(ParsePlyFile, NamesTheFaultOfADamagedFile) {
  const std::string sound = PlyExample();
  EXPECT_EQ(PlyFault(sound), "no error");
  EXPECT_EQ(PlyFault(""), "a.ply: is no PLY file: its first line must be \"ply\"");
  EXPECT_EQ(PlyFault("ply\nformat ascii 1.0\n"),
            "a.ply: is no PLY file: its header has no end_header line");
  EXPECT_EQ(PlyFault(sound.substr(0, sound.size() - 1)),
            "a.ply: element vertex: 4 points need 64 bytes, the file has 63");
  EXPECT_EQ(PlyFault(Replaced(sound, "vertex 4", "vertex 4000000000")),
            "a.ply: element vertex: 4000000000 points need 64000000000 bytes, the file has 64");
  EXPECT_EQ(PlyFault(Replaced(sound, "vertex 4", "vertex -4")),
            "a.ply: element vertex: must be a whole number below 2^32 (got -4)");
  EXPECT_EQ(PlyFault(Replaced(sound, "float y", "half y")), "a.ply: property y: unknown type half");
  EXPECT_EQ(PlyFault(Replaced(sound, "property float y", "property list uchar int y")),
            "a.ply: element vertex: every property must be one number");
  EXPECT_EQ(PlyFault(Replaced(sound, "element vertex", "element face")),
            "a.ply: element vertex: must come once");
  EXPECT_EQ(PlyFault(Replaced(sound, "little_endian", "middle_endian")),
            "a.ply: format: must be ascii, binary_little_endian or binary_big_endian (got "
            "binary_middle_endian)");
  EXPECT_EQ(PlyFault(Replaced(sound, "format binary_little_endian 1.0\n", "")),
            "a.ply: format: missing");
  EXPECT_EQ(PlyFault(Replaced(sound, "end_header", std::string(100, 'x'))),
            "a.ply: is no PLY file: a header line begins with " + std::string(60, 'x') + "...");
}

TEST(ParsePlyFile, WantsItsFirstLineToBePlyAlone) {
  const std::string rest = PlyExample().substr(std::string_view("ply").size());
  EXPECT_EQ(PlyFault("ply" + rest), "no error");
  EXPECT_EQ(PlyFault("ply\r" + rest), "no error");
  for (const char* first : {"", "PLY", "ply ", " ply", "ply 1.0", "format"}) {
    EXPECT_EQ(PlyFault(first + rest), "a.ply: is no PLY file: its first line must be \"ply\"")
        << first;
  }
}

TEST(ParsePlyFile, WantsAVersionBehindItsFormatAndNoMore) {
  const std::string sound = PlyExample();
  for (const std::string line :
       {"format binary_little_endian", "format binary_little_endian 1.0 x"}) {
    EXPECT_EQ(PlyFault(Replaced(sound, "format binary_little_endian 1.0", line)),
              "a.ply: format: must have a version and nothing behind it (got \"" + line + "\")");
  }
  EXPECT_EQ(
      PlyFault(Replaced(sound, "format binary_little_endian 1.0", "format")),
      "a.ply: format: must be ascii, binary_little_endian or binary_big_endian (got nothing)");
}

TEST(ReadPly, NamesThePointWhoseTextIsDamaged) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.ply";
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty uchar label\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  WriteFileWhole(file, header + "1.5 2\n-3e2 255\n3 0 1 0\n");
  EXPECT_EQ(ReadPly(file).data.size(), 10U);
  WriteFileWhole(file, header + "1.5 2\n-3e2x 255\n3 0 1 0\n");
  EXPECT_EQ(MessageOf([&] { (void)ReadPly(file); }),
            file.string() + ": point 1: x: no value of its type (got -3e2x)");
  WriteFileWhole(file, header + "1.5 2\n-300000\n");
  EXPECT_EQ(MessageOf([&] { (void)ReadPly(file); }),
            file.string() + ": point 1: must have 2 values (got 1)");
}

TEST(ReadPly, SurvivesEveryTruncationAndFlippedByte) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.ply";
  const std::string sound = PlyExample();
  for (std::size_t place = 0; place < sound.size(); ++place) {
    WriteFileWhole(file, sound.substr(0, place));
    EXPECT_EQ(MessageOf([&] { (void)ReadPly(file); }).find(file.string() + ": "), 0U) << place;
    WriteFileWhole(file, Flipped(sound, place));
    const std::string message = MessageOf([&] { (void)ReadPly(file); });
    EXPECT_TRUE(message == "no error" || message.find(file.string() + ": ") == 0U) << message;
  }
}

}  // namespace
}  // namespace railcast
