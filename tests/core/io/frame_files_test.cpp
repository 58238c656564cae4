#include "core/io/frame_files.h"

#include <gtest/gtest.h>

#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

std::vector<std::string> Names(const std::string& format, std::uint32_t number) {
  std::vector<FrameFile> files;
  EncodeFrameFiles(ExampleFrame(0), {ParseFrameFormat(format), {}, ExampleLabels()}, number, files);
  std::vector<std::string> names;
  for (const FrameFile& file : files) names.push_back(file.name);
  return names;
}

TEST(FrameFiles, AreNamedByFormatAndNumber) {
  using Strings = std::vector<std::string>;
  EXPECT_EQ(Names("pcd", 0), Strings{"frames/000000.pcd"});
  EXPECT_EQ(Names("pcd-compressed", 12), Strings{"frames/000012.pcd"});
  EXPECT_EQ(Names("pcd-ascii", 1234567), Strings{"frames/1234567.pcd"});
  EXPECT_EQ(Names("ply", 3), Strings{"frames/000003.ply"});
  EXPECT_EQ(Names("ply-cloudcompare", 3), Strings{"frames/000003.ply"});
  EXPECT_EQ(Names("kitti", 3),
            (Strings{"sequences/00/velodyne/000003.bin", "sequences/00/labels/000003.label"}));
}

TEST(FrameFiles, OfOneFrameAreTheSameWhateverWasEncodedBefore) {
  std::vector<FrameFile> used;
  for (const char* format :
       {"pcd", "pcd-compressed", "pcd-ascii", "ply", "ply-cloudcompare", "kitti"}) {
    const FrameFileSpec spec{ParseFrameFormat(format), {}, ExampleLabels()};
    EncodeFrameFiles(ExampleFrame(5, 8, 20), spec, 0, used);
    EncodeFrameFiles(ExampleFrame(1), spec, 0, used);
    std::vector<FrameFile> fresh;
    EncodeFrameFiles(ExampleFrame(1), spec, 0, fresh);
    ASSERT_EQ(used.size(), fresh.size());
    for (std::size_t i = 0; i < fresh.size(); ++i)
      EXPECT_EQ(used[i].bytes, fresh[i].bytes) << format;
  }
}

TEST(FrameFormat, NamesReadBack) {
  for (const char* name :
       {"pcd", "pcd-compressed", "pcd-ascii", "ply", "ply-cloudcompare", "kitti"}) {
    EXPECT_EQ(FrameFormatName(ParseFrameFormat(name)), name);
  }
  EXPECT_EQ(MessageOf([] { (void)ParseFrameFormat("las"); }),
            "--format: unknown format \"las\" (valid: pcd, pcd-compressed, pcd-ascii, ply, "
            "ply-cloudcompare, kitti)");
}

}  // namespace
}  // namespace railcast
