#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <map>

#include "core/base/transform.h"
#include "core/base/units.h"
#include "core/io/pcap/pcap_reader.h"
#include "core/io/velodyne/velodyne_decoder.h"

namespace railcast {
namespace {

const std::filesystem::path kCaptures = RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula";
constexpr double kHalfTurn_deg = 180.0;

std::vector<VelodyneTurn> DecodeCapture(const std::filesystem::path& file,
                                        const VelodyneModel& model) {
  PcapReader reader(file);
  VelodyneDecoder decoder(model);
  std::vector<VelodyneTurn> turns;
  while (const auto datagram = reader.Next()) {
    EXPECT_EQ(datagram->destination_port, kVelodyneDataPort);
    EXPECT_EQ(decoder.Decode(datagram->payload, turns), std::nullopt);
  }
  turns.push_back(decoder.TakeUnfinished());
  return turns;
}

/// A point in the axes of the file (x forward, y left), as the packet must have held it.
struct Measured {
  std::uint8_t laser{};
  long distance{};  ///< In the packet's unit.
  double azimuth_deg{};
};

Measured MeasuredOf(const pcl::PointXYZ& point, const VelodyneModel& model) {
  const Vector3 place_m(double{point.x}, double{point.y}, double{point.z});
  const double range_m = place_m.norm();
  const double elevation_deg = DegFromRad(std::asin(place_m.z() / range_m));
  const auto laser = std::ranges::min_element(model.lasers, {}, [&](const ChannelSpec& channel) {
    return std::abs(channel.elevation_deg - elevation_deg);
  });
  return {.laser = static_cast<std::uint8_t>(laser - model.lasers.begin()),
          .distance = std::lround(range_m / model.distance_unit_m),
          .azimuth_deg = -DegFromRad(std::atan2(place_m.y(), place_m.x()))};
}

double Difference_deg(double a_deg, double b_deg) {
  return std::abs(std::remainder(a_deg - b_deg, 2.0 * kHalfTurn_deg));
}

/// How another decoder's points compare with ours of the same laser and the same distance. Azimuths
/// farther apart than 0.5 deg are of other firings: not matched.
struct Comparison {
  double matched_share{};
  double median_deg{};
  double max_deg{};
  double median_mm{};
  double max_mm{};
};

/// @param their_time_us When the other decoder thinks that a laser fires.
Comparison Compare(const pcl::PointCloud<pcl::PointXYZ>& theirs,
                   const std::vector<VelodynePoint>& ours,
                   const VelodyneModel& model,
                   double (*their_time_us)(std::size_t laser)) {
  std::map<std::pair<std::uint8_t, long>, std::vector<VelodynePoint>> by_measurement;
  for (const VelodynePoint& point : ours) {
    const long distance = std::lround(double{point.range_m} / model.distance_unit_m);
    by_measurement[{point.laser, distance}].push_back(point);
  }
  constexpr double kTurn_deg_per_us = 3600e-6;  // Both captures: 600 rpm.
  std::vector<double> angles_deg;
  std::vector<double> distances_mm;
  for (const pcl::PointXYZ& point : theirs) {
    const Measured measured = MeasuredOf(point, model);
    const double earlier_us = their_time_us(measured.laser) - model.lasers[measured.laser].time_us;
    const double azimuth_deg = measured.azimuth_deg - kTurn_deg_per_us * earlier_us;
    double nearest_deg = 0.5;
    double nearest_mm = 0.0;
    for (const VelodynePoint& candidate : by_measurement[{measured.laser, measured.distance}]) {
      const double angle_deg =
          Difference_deg(azimuth_deg, DegFromRad(double{candidate.azimuth_rad}));
      if (angle_deg >= nearest_deg) continue;
      nearest_deg = angle_deg;
      const Eigen::Vector3f apart_m(candidate.x - point.x, candidate.y - point.y,
                                    candidate.z - point.z);
      nearest_mm = 1e3 * double{apart_m.norm()};
    }
    if (nearest_deg == 0.5) continue;
    angles_deg.push_back(nearest_deg);
    distances_mm.push_back(nearest_mm);
  }
  if (angles_deg.empty()) return {};
  std::ranges::sort(angles_deg);
  std::ranges::sort(distances_mm);
  const Comparison result{
      .matched_share = static_cast<double>(angles_deg.size()) / static_cast<double>(theirs.size()),
      .median_deg = angles_deg[angles_deg.size() / 2],
      .max_deg = angles_deg.back(),
      .median_mm = distances_mm[distances_mm.size() / 2],
      .max_mm = distances_mm.back()};
  std::cout << "matched " << 100.0 * result.matched_share << " %; azimuth median "
            << result.median_deg << " deg, max " << result.max_deg << " deg; position median "
            << result.median_mm << " mm, max " << result.max_mm << " mm\n";
  return result;
}

TEST(RealCapture, DecodesVlp16InDualModeAsNebulaDoes) {
  const auto file = kCaptures / "vlp16_dual.pcap";
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const VelodyneModel& model = *FindVelodyneFormat("vlp16").model;
  const auto turns = DecodeCapture(file, model);
  pcl::PointCloud<pcl::PointXYZ> theirs;
  ASSERT_EQ(pcl::io::loadPCDFile((kCaptures / "vlp16_dual_decoded.pcd").string(), theirs), 0);
  ASSERT_EQ(theirs.size(), 14'831U);
  // Four turns, and the first firings of a fifth; the published cloud is the fourth.
  ASSERT_EQ(turns.size(), 5U);
  (void)Compare(theirs, turns[3].points, model,
                [](std::size_t laser) { return 2.304 * static_cast<double>(laser); });
}

TEST(RealCapture, DecodesVlp32cAsNebulaDoes) {
  const auto file = kCaptures / "vlp32c_single.pcap";
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const VelodyneModel& model = *FindVelodyneFormat("vlp32c").model;
  const auto turns = DecodeCapture(file, model);
  pcl::PointCloud<pcl::PointXYZ> theirs;
  ASSERT_EQ(pcl::io::loadPCDFile((kCaptures / "vlp32c_single_decoded.pcd").string(), theirs), 0);
  ASSERT_EQ(theirs.size(), 26'216U);
  // The sensor looked from 270 to 93 deg; the published cloud is the first such sector, in which
  // the azimuth passes 0.
  std::vector<VelodynePoint> sector = turns[0].points;
  std::ranges::copy_if(turns[1].points, std::back_inserter(sector), [](const VelodynePoint& point) {
    return DegFromRad(double{point.azimuth_rad}) < kHalfTurn_deg;
  });
  // Nebula takes 2.304 us from laser to laser as of VLP-16; the manual (9.4) and we, from pair to
  // pair.
  (void)Compare(theirs, sector, model,
                [](std::size_t laser) { return 2.304 * static_cast<double>(laser); });
}

}  // namespace
}  // namespace railcast
