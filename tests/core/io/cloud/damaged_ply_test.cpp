#include <gtest/gtest.h>

#include "core/io/cloud/cloud_file.h"
#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"
#include "tests/core/io/damage.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

std::string PlyExample() {
  std::string bytes;
  EncodePly(ExampleFrame(0, 2, 9), FieldSelection("x,y,z,label"), PlyFlavour::kPcl, bytes);
  return bytes;
}

std::string PlyMessage(const std::string& bytes) {
  return MessageOf([&] { (void)ParsePlyFile("a.ply", bytes); });
}

TEST(ParsePlyFile, NamesTheFaultOfADamagedFile) {
  const std::string sound = PlyExample();
  EXPECT_EQ(PlyMessage(sound), "no error");
  EXPECT_EQ(PlyMessage(""), "a.ply: is no PLY file: its first line must be \"ply\"");
  EXPECT_EQ(PlyMessage("ply\nformat ascii 1.0\n"),
            "a.ply: is no PLY file: its header has no end_header line");
  EXPECT_EQ(PlyMessage(sound.substr(0, sound.size() - 1)),
            "a.ply: element vertex: 4 points need 64 bytes, the file has 63");
  EXPECT_EQ(PlyMessage(Replaced(sound, "vertex 4", "vertex 4000000000")),
            "a.ply: element vertex: 4000000000 points need 64000000000 bytes, the file has 64");
  EXPECT_EQ(PlyMessage(Replaced(sound, "vertex 4", "vertex -4")),
            "a.ply: element vertex: must be a whole number below 2^32 (got -4)");
  EXPECT_EQ(PlyMessage(Replaced(sound, "float y", "half y")),
            "a.ply: property y: unknown type half");
  EXPECT_EQ(PlyMessage(Replaced(sound, "property float y", "property list uchar int y")),
            "a.ply: element vertex: every property must be one number");
  EXPECT_EQ(PlyMessage(Replaced(sound, "element vertex", "element face")),
            "a.ply: element vertex: must come once");
  EXPECT_EQ(PlyMessage(Replaced(sound, "little_endian", "middle_endian")),
            "a.ply: format: must be ascii, binary_little_endian or binary_big_endian (got "
            "binary_middle_endian)");
  EXPECT_EQ(PlyMessage(Replaced(sound, "format binary_little_endian 1.0\n", "")),
            "a.ply: format: missing");
}

TEST(ReadPly, NamesThePointWhoseTextIsDamaged) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.ply";
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty uchar label\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  WriteFileWhole(file, header + "1.5 2\n-3e2 255\n3 0 1 0\n");
  EXPECT_EQ(ReadPly(file).data.size(), 10U);
  WriteFileWhole(file, header + "1.5 2\n-3e2 256\n3 0 1 0\n");
  EXPECT_EQ(MessageOf([&] { (void)ReadPly(file); }),
            file.string() + ": point 1: label: no value of its type (got 256)");
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
