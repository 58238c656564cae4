// The table of the 128E4X against a cloud that another decoder (tier4/nebula) made of packets of a
// real sensor in its high-resolution mode.
#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <vector>

#include "core/base/units.h"
#include "core/extras/packets/spinning/spinning_model.h"
#include "tests/support/hesai_bag.h"

namespace railcast {
namespace {

/// What the cloud has of a laser.
struct SeenLaser {
  std::array<std::size_t, 2> num_in_state{};  ///< Points in blocks of azimuth state 0 and 1.
  double nearest_m = 1e9;
};

/// The angles of each laser.
std::vector<ChannelSpec> LasersOf(const SpinningModel& model) {
  std::vector<ChannelSpec> lasers(128);
  std::size_t channel = 0;
  for (const auto& loop : model.loops) {
    for (const std::uint8_t laser : loop) lasers[laser] = model.channels[channel++];
  }
  return lasers;
}

class E4xCloud : public testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path file = HesaiFile("captures/ot128_decoded.pcd");
    if (!exists(file)) GTEST_SKIP() << file << " is not there";
    pcl::PointCloud<pcl::PointXYZ> cloud;
    ASSERT_EQ(pcl::io::loadPCDFile(file.string(), cloud), 0);
    ASSERT_EQ(cloud.size(), 72'240U);
    for (const pcl::PointXYZ& point : cloud) Take(point);
  }

  void Take(const pcl::PointXYZ& point) {
    const double x = point.x;
    const double y = point.y;
    const double z = point.z;
    const double range_m = std::hypot(x, y, z);
    const double elevation_deg = DegFromRad(std::asin(z / range_m));
    const auto apart_deg = [&](const ChannelSpec& laser) {
      return std::abs(laser.elevation_deg - elevation_deg);
    };
    const auto laser = std::ranges::min_element(lasers_, {}, apart_deg);
    // The other decoder's angles are in float32; the nearest two lasers are 0.102 deg apart.
    num_strangers_ += apart_deg(*laser) > 0.003;
    // Its x points to the right, and it does not turn the rotor on until a laser fires.
    const double block_deg = DegFromRad(std::atan2(x, y)) - laser->azimuth_deg;
    const double tenths = 10.0 * (block_deg < 0.0 ? block_deg + 360.0 : block_deg);
    // Blocks are at 0.01, 0.11, 0.21 deg ...
    num_between_ += std::abs(std::remainder(tenths - 0.1, 1.0)) > 0.03;
    SeenLaser& seen = seen_[static_cast<std::size_t>(laser - lasers_.begin())];
    ++seen.num_in_state.at(static_cast<std::size_t>(std::lround(tenths - 0.1)) % 2);
    seen.nearest_m = std::min(seen.nearest_m, range_m);
  }

  const SpinningModel& model_ = *FindSpinningModel("pandar128e4x");
  const std::vector<ChannelSpec> lasers_ = LasersOf(model_);
  std::vector<SeenLaser> seen_ = std::vector<SeenLaser>(128);
  std::size_t num_strangers_{};
  std::size_t num_between_{};
};

TEST_F(E4xCloud, HasTheTablesElevationsInBlocksATenthOfADegreeApart) {
  EXPECT_EQ(num_strangers_, 0U);
  EXPECT_EQ(num_between_, 0U);
}

TEST_F(E4xCloud, HasEachLaserInTheAzimuthStatesOfTheTable) {
  std::size_t num_seen = 0;
  for (std::size_t laser = 0; laser < 128; ++laser) {
    if (seen_[laser].nearest_m > 1e6) continue;
    ++num_seen;
    for (std::size_t state = 0; state < 2; ++state) {
      EXPECT_EQ(seen_[laser].num_in_state[state] > 0,
                std::ranges::count(model_.loops[state], laser) > 0)
          << "laser " << laser << ", state " << state;
    }
  }
  EXPECT_EQ(num_seen, 114U);
}

// This sensor stands among near things: most lasers report something at their limit.
TEST_F(E4xCloud, HasNothingNearerThanTheTablesLimits) {
  // One unit of the ranges.
  constexpr double kSame_m = 0.0041;
  std::size_t num_at_limit = 0;
  for (std::size_t laser = 0; laser < 128; ++laser) {
    if (seen_[laser].nearest_m > 1e6) continue;
    const bool is_near = std::ranges::count(model_.near_lasers, laser) > 0;
    const double limit_m = is_near ? model_.near_m : model_.far_m;
    EXPECT_GE(seen_[laser].nearest_m, limit_m - kSame_m) << laser;
    EXPECT_EQ(seen_[laser].nearest_m < model_.far_m - kSame_m, is_near) << laser;
    num_at_limit += seen_[laser].nearest_m < limit_m + 0.1;
  }
  EXPECT_GT(num_at_limit, 90U);
}

}  // namespace
}  // namespace railcast
