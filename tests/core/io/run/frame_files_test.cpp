#include "railcast/io/cloud_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/io/cloud/cloud_file.h"
#include "core/io/write_file.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

std::vector<std::string> Names(const std::string& format, std::uint32_t number) {
  std::vector<FrameFile> files;
  EncodeFrameFiles(ExampleFrame(0), {&ParseFrameFormat(format), {}, ExampleLabels()}, number,
                   files);
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
  for (const FrameFormat& format : FrameFormats()) {
    const FrameFileSpec spec{&format, {}, ExampleLabels()};
    EncodeFrameFiles(ExampleFrame(5, 8, 20), spec, 0, used);
    EncodeFrameFiles(ExampleFrame(1), spec, 0, used);
    std::vector<FrameFile> fresh;
    EncodeFrameFiles(ExampleFrame(1), spec, 0, fresh);
    ASSERT_EQ(used.size(), fresh.size());
    for (std::size_t i = 0; i < fresh.size(); ++i)
      EXPECT_EQ(used[i].bytes, fresh[i].bytes) << format.name;
  }
}

TEST(FrameFormat, NamesReadBack) {
  for (const std::string& name : FrameFormatNames()) {
    EXPECT_EQ(ParseFrameFormat(name).name, name);
  }
  EXPECT_EQ(MessageOf([] { (void)ParseFrameFormat("las"); }),
            "--format: unknown format \"las\" (valid: pcd, pcd-compressed, pcd-ascii, ply, "
            "ply-cloudcompare, kitti, objects, mcap, rosbag2, osi, osi-mcap)");
}

TEST(FrameFormat, ReadsBackAsManyPointsAsItHolds) {
  const Frame frame = ExampleFrame(5, 8, 20);
  const auto num_points =
      static_cast<std::size_t>(std::count_if(frame.outcome.begin(), frame.outcome.end(), HasPoint));
  ASSERT_LT(num_points, frame.num_slots());
  for (const FrameFormat& format : FrameFormats()) {
    if (format.parse == nullptr) continue;
    std::vector<FrameFile> files;
    EncodeFrameFiles(frame, {&format, {}, ExampleLabels()}, 7, files);
    const auto second = files.size() > 1 ? std::optional(files[1].bytes) : std::nullopt;
    EXPECT_EQ(format.parse(files[0].name, files[0].bytes, second).cloud.num_points(),
              format.has_all_slots ? frame.num_slots() : num_points)
        << format.name;
    EXPECT_EQ(FindReader(files[0].name)->files.front().extension, format.files.front().extension);
  }
}

TEST(FrameFormat, IsFoundByNoOtherName) {
  EXPECT_EQ(FindFrameFormat("las"), nullptr);
  EXPECT_EQ(FindReader("frames/000001.las"), nullptr);
  EXPECT_EQ(FindReader("frames/pcd"), nullptr);
}

TEST(FrameFormat, SaysWhichExtensionsAreRead) {
  EXPECT_EQ(ReadableExtensions(false), ".pcd or .ply");
  EXPECT_EQ(ReadableExtensions(true), ".pcd, .ply or .bin");
  EXPECT_EQ(ReadableExtensions(true, {".pcap", ".pcapng"}), ".pcd, .ply, .bin, .pcap or .pcapng");
}

// Returns what Open3D's tensor reader finds: each attribute's name, element type and sum.
std::string Open3dReads(const std::filesystem::path& file) {
  const std::string command =
      "/usr/bin/python3 -c \"import open3d, numpy; p = open3d.t.io.read_point_cloud('" +
      file.string() +
      "').point; print('|'.join(k + ' ' + str(p[k].dtype) + ' %.0f' % "
      "numpy.nansum(p[k].numpy().astype('f8')) for k in dir(p) if k[0] != '_'))\" 2>/dev/null";
  return RunCommand(command).said;
}

class Open3d : public testing::TestWithParam<const char*> {};

TEST_P(Open3d, ReadsEveryFieldThatAPlyOrPcdCarries) {
  if (!HasOpen3d()) GTEST_SKIP() << "python3-open3d is not installed";
  const TemporaryDirectory directory;
  const Frame frame = ExampleFrame(4);
  std::vector<FrameFile> files;
  EncodeFrameFiles(frame, {&ParseFrameFormat(GetParam()), {}, ExampleLabels()}, 0, files);
  const auto file = directory.path() / std::filesystem::path(files[0].name).filename();
  WriteFileWhole(file, files[0].bytes);

  std::uint64_t label_sum = 0;
  for (const std::uint32_t label : frame.label) label_sum += label;
  const std::string said = Open3dReads(file);
  const bool is_ply = std::string(GetParam()) == "ply-cloudcompare";
  EXPECT_NE(said.find(is_ply ? "scalar_label Int32 " + std::to_string(label_sum)
                             : "label UInt32 " + std::to_string(label_sum)),
            std::string::npos)
      << said;
  for (const char* name : {"power_ratio", "time_ns", "ring", "instance", "outcome", "material"}) {
    EXPECT_NE(said.find(name), std::string::npos) << name << " in " << said;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats,
                         Open3d,
                         testing::Values("pcd", "pcd-compressed", "pcd-ascii", "ply-cloudcompare"));

}  // namespace
}  // namespace railcast
