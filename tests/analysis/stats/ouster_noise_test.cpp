// Checks what docs/ouster.md says of the noise of Ouster's sensors, and that their presets have no
// more.
#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>

#include "analysis/stats/bins.h"
#include "analysis/stats/neighbour_noise.h"
#include "core/base/input_file.h"
#include "core/scenario/ouster_metadata.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

struct SeenNoise {
  const char* unit;
  const char* capture;
  const char* metadata;
  double range_m{};  ///< In the bin with the least second differences.
  std::uint64_t num_triples{};
  double sigma_mm{};

  friend std::ostream& operator<<(std::ostream& out, const SeenNoise& seen) {
    return out << seen.unit;
  }
};

class OusterNoise : public testing::TestWithParam<SeenNoise> {};

TEST_P(OusterNoise, OfThePresetIsAtMostThatOfACapture) {
  const std::filesystem::path data = RAILCAST_SHARED_DATA_DIR;
  const std::filesystem::path capture = data / GetParam().capture;
  if (!exists(capture)) GTEST_SKIP() << "the capture is not here: " << capture;
  const std::filesystem::path metadata = data / GetParam().metadata;
  const auto recording = OpenRecording(capture.string() + ":" + metadata.string());
  NeighbourNoise noise;
  while (const auto read = recording->Next()) noise.Add((*read)());
  const std::size_t bin = RangeBins().Find(GetParam().range_m).value();
  EXPECT_EQ(noise.bins()[bin].num(), GetParam().num_triples);
  EXPECT_NEAR(1e3 * noise.Sigma_m(bin).value, GetParam().sigma_mm, 0.05);
  LidarSpec lidar;
  UseOusterMetadata(ReadFileWhole(metadata), lidar);
  // It is rounded to whole millimetres.
  EXPECT_LT(1e3 * lidar.receiver.range_noise_floor_m, GetParam().sigma_mm + 0.5);
}

INSTANTIATE_TEST_SUITE_P(
    Captures,
    OusterNoise,
    testing::Values(SeenNoise{"Os0", "ouster_more/OS-0-32-U1_v2.2.0_1024x10.pcap",
                              "ouster_more/OS-0-32-U1_v2.2.0_1024x10.json", 3.0, 11'196, 5.1},
                    SeenNoise{"Os1", "lidar_ouster/OS-1-128_767798045_1024x10_20230712_120049.pcap",
                              "lidar_ouster/OS-1-128_767798045_1024x10_20230712_120049.json", 1.0,
                              13'465, 4.8},
                    SeenNoise{"Os2", "ouster_more/OS-2-32-U0_v2.0.0_1024x10.pcap",
                              "ouster_more/OS-2-32-U0_v2.0.0_1024x10.json", 7.0, 4'918, 14.9}),
    testing::PrintToStringParamName());

}  // namespace
}  // namespace railcast
