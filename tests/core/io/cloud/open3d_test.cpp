#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "core/io/write_file.h"
#include "railcast/io/cloud_files.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

// /usr/bin/python3 is given in full because Debian's package python3-open3d belongs to Debian's
// interpreter, which need not be the first on the path.
bool HasOpen3d() {
  return std::system("/usr/bin/python3 -c 'import open3d' >/dev/null 2>&1") == 0;
}

// Returns what Open3D's tensor reader finds: each attribute's name, element type and sum.
std::string Open3dReads(const std::filesystem::path& file) {
  const std::string command =
      "/usr/bin/python3 -c \"import open3d, numpy; p = open3d.t.io.read_point_cloud('" +
      file.string() +
      "').point; print('|'.join(k + ' ' + str(p[k].dtype) + ' %.0f' % "
      "numpy.nansum(p[k].numpy().astype('f8')) for k in dir(p) if k[0] != '_'))\" 2>/dev/null";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
  std::string said;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe.get()) != nullptr) said += buffer.data();
  return said;
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
