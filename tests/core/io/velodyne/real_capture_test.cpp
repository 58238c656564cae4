#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "core/io/pcap/pcap_reader.h"
#include "core/io/velodyne/velodyne_decoder.h"

namespace railcast {
namespace {

const std::filesystem::path kCaptures = RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula";

std::vector<VelodyneTurn> DecodeCapture(const std::filesystem::path& file,
                                        std::string_view format) {
  PcapReader reader(file);
  VelodyneDecoder decoder(*FindVelodyneFormat(format).model);
  std::vector<VelodyneTurn> turns;
  while (const auto datagram = reader.Next()) {
    EXPECT_EQ(datagram->destination_port, kVelodyneDataPort);
    EXPECT_EQ(decoder.Decode(datagram->payload, turns), std::nullopt);
  }
  turns.push_back(decoder.TakeUnfinished());
  return turns;
}

/// How the points of another decoder differ from the nearest of ours.
struct Difference {
  double median_m{};
  double max_m{};
  double matched_share{};  ///< Nearer than 50 mm.
};

Difference Compare(const pcl::PointCloud<pcl::PointXYZ>& theirs, std::vector<VelodynePoint> ours) {
  constexpr float kReach_m = 0.05F;
  std::ranges::sort(ours, {}, &VelodynePoint::x);
  std::vector<double> distances_m;
  for (const pcl::PointXYZ& point : theirs) {
    float nearest_m = kReach_m;
    auto near = std::ranges::lower_bound(ours, point.x - kReach_m, {}, &VelodynePoint::x);
    for (; near != ours.end() && near->x <= point.x + kReach_m; ++near) {
      nearest_m =
          std::min(nearest_m, std::hypot(near->x - point.x, near->y - point.y, near->z - point.z));
    }
    if (nearest_m < kReach_m) distances_m.push_back(static_cast<double>(nearest_m));
  }
  if (distances_m.empty()) return {};
  std::ranges::sort(distances_m);
  return {.median_m = distances_m[distances_m.size() / 2],
          .max_m = distances_m.back(),
          .matched_share =
              static_cast<double>(distances_m.size()) / static_cast<double>(theirs.size())};
}

void Record(const Difference& difference) {
  testing::Test::RecordProperty("median_mm", std::to_string(1e3 * difference.median_m));
  testing::Test::RecordProperty("max_mm", std::to_string(1e3 * difference.max_m));
  testing::Test::RecordProperty("matched_share", std::to_string(difference.matched_share));
}

TEST(RealCapture, DecodesVlp16InDualModeAsNebulaDoes) {
  const auto file = kCaptures / "vlp16_dual.pcap";
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const auto turns = DecodeCapture(file, "vlp16");
  pcl::PointCloud<pcl::PointXYZ> theirs;
  ASSERT_EQ(pcl::io::loadPCDFile((kCaptures / "vlp16_dual_decoded.pcd").string(), theirs), 0);
  ASSERT_EQ(theirs.size(), 14'831U);
  for (const auto& turn : turns) {
    const Difference d = Compare(theirs, turn.points);
    std::printf("vlp16 turn %zu points: median %.3f mm max %.3f mm share %.4f\n",
                turn.points.size(), 1e3 * d.median_m, 1e3 * d.max_m, d.matched_share);
  }
}

TEST(RealCapture, DecodesVlp32cAsNebulaDoes) {
  const auto file = kCaptures / "vlp32c_single.pcap";
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const auto turns = DecodeCapture(file, "vlp32c");
  pcl::PointCloud<pcl::PointXYZ> theirs;
  ASSERT_EQ(pcl::io::loadPCDFile((kCaptures / "vlp32c_single_decoded.pcd").string(), theirs), 0);
  ASSERT_EQ(theirs.size(), 26'216U);
  std::vector<VelodynePoint> all;
  for (const auto& turn : turns) {
    const Difference d = Compare(theirs, turn.points);
    std::printf("vlp32 turn %zu points: median %.3f mm max %.3f mm share %.4f\n",
                turn.points.size(), 1e3 * d.median_m, 1e3 * d.max_m, d.matched_share);
    all.insert(all.end(), turn.points.begin(), turn.points.end());
  }
  const Difference d = Compare(theirs, all);
  std::printf("vlp32 all %zu points: median %.3f mm max %.3f mm share %.4f\n", all.size(),
              1e3 * d.median_m, 1e3 * d.max_m, d.matched_share);
  Record(d);
}

}  // namespace
}  // namespace railcast
