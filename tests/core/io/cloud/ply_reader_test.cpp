#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "core/io/cloud/cloud_file.h"
#include "tests/core/io/message_of.h"

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

std::vector<double> PlyValues(const CloudFile& read, const std::string& name) {
  std::vector<double> values(read.cloud.num_points());
  VisitField(read.cloud, *read.cloud.Find(name),
             [&](std::size_t i, auto value) { values[i] = static_cast<double>(value); });
  return values;
}

std::string PlyFault(const std::string& bytes) {
  return MessageOf([&] { (void)ParsePlyFile("a.ply", bytes); });
}

TEST(PlyReader, ReadsAndRewritesEitherByteOrder) {
  for (const bool is_big : {false, true}) {
    const std::string bytes = PlyHeaderOf(is_big, kPlyVertex) + PlyPoints(is_big);
    const CloudFile read = ParsePlyFile("a.ply", bytes);
    EXPECT_THAT(PlyValues(read, "x"), ElementsAre(6.5, -0.25));
    EXPECT_THAT(PlyValues(read, "ring"), ElementsAre(300, 2));
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
    EXPECT_THAT(PlyValues(read, "x"), ElementsAre(6.5, -0.25));
    EXPECT_EQ(Rewritten(read, {read.cloud.data, {0, 1}}), std::vector{bytes});
  }
  const CloudFile text = ParsePlyFile("a.ply", "ply\nformat ascii 1.0\n" + camera + kPlyVertex +
                                                   "end_header\n1 0\n2 1 7\n6.5 3\n1 4\n");
  EXPECT_THAT(PlyValues(text, "ring"), ElementsAre(3, 4));
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
  EXPECT_THAT(PlyValues(read, "x"), ElementsAre(456789.15, 456790.12));
}

}  // namespace
}  // namespace railcast
