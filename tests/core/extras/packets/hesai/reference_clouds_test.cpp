// Points of real captures against the clouds that another decoder (tier4/nebula) made of them.

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <tuple>
#include <vector>

#include "core/base/units.h"
#include "core/extras/packets/spinning/spinning_decoder.h"
#include "core/extras/packets/spinning/spinning_model.h"
#include "railcast/transform.h"
#include "tests/core/extras/packets/hesai/made_packet.h"
#include "tests/support/captures.h"
#include "tests/support/decoded_turns.h"
#include "tests/support/hesai_bag.h"
#include "tests/support/pcl_reads.h"

namespace railcast {
namespace {

using Cell = std::tuple<long, long, long>;  // In cells of 1 cm.
using Cells = std::multimap<Cell, TurnPoint>;

Cell CellOf(float x, float y, float z) {
  return {std::lround(100.0F * x), std::lround(100.0F * y), std::lround(100.0F * z)};
}

/// Returns the distance from a point of the other decoder (x right, y forward) to the nearest of
/// ours in the surrounding cells; 1 m if there is none.
double NearestOf(const Cells& cells, const pcl::PointXYZ& point) {
  double nearest_m = 1.0;
  const auto [x, y, z] = CellOf(point.y, -point.x, point.z);
  for (long i = 0; i < 27; ++i) {
    const auto [begin, end] = cells.equal_range({x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1});
    for (auto cell = begin; cell != end; ++cell) {
      const TurnPoint& ours = cell->second;
      const Vector3 apart_m(static_cast<double>(ours.x - point.y),
                            static_cast<double>(ours.y + point.x),
                            static_cast<double>(ours.z - point.z));
      nearest_m = std::min(nearest_m, apart_m.norm());
    }
  }
  return nearest_m;
}

std::vector<SensorTurn> TurnsOf(const std::filesystem::path& capture, const SpinningModel& model) {
  SpinningDecoder decoder(model);
  return TurnsOfPackets(decoder, PacketsInCapture(capture));
}

/// The points of a turn, and those of its neighbours that are this near to azimuth 0: a laser may
/// see beyond it on either side, before or after its block has passed it.
Cells CellsOf(const std::vector<SensorTurn>& turns, std::size_t turn, double seam_deg) {
  Cells cells;
  for (std::size_t i = turn - 1; i <= turn + 1; ++i) {
    for (const TurnPoint& point : turns.at(i).points) {
      const double azimuth_deg = DegFromRad(static_cast<double>(point.azimuth_rad));
      if (i == turn || std::abs(std::remainder(azimuth_deg, 360.0)) < seam_deg) {
        cells.emplace(CellOf(point.x, point.y, point.z), point);
      }
    }
  }
  return cells;
}

void ExpectAllIn(const Cells& ours, const std::filesystem::path& cloud, std::size_t num_points) {
  const auto theirs = PclReads<pcl::PointCloud<pcl::PointXYZ>>(cloud);
  ASSERT_EQ(theirs.size(), num_points);
  std::vector<double> distances_m;
  for (const pcl::PointXYZ& point : theirs) distances_m.push_back(NearestOf(ours, point));
  std::ranges::sort(distances_m);
  // The float32 rounding of both clouds at up to 200 m.
  constexpr double kSame_m = 5e-5;
  const auto num_same = std::ranges::upper_bound(distances_m, kSame_m) - distances_m.begin();
  const double share = static_cast<double>(num_same) / static_cast<double>(theirs.size());
  const double median_m = distances_m[distances_m.size() / 2];
  testing::Test::RecordProperty("share", std::to_string(share));
  testing::Test::RecordProperty("median_um", std::to_string(1e6 * median_m));
  EXPECT_EQ(share, 1.0) << num_same << " the same, the farthest at " << distances_m.back() << " m";
  EXPECT_LT(median_m, 1e-6);
}

TEST(HesaiReference, Pandar64GivesTheSamePoints) {
  const std::filesystem::path folder = RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula";
  const auto capture = folder / "pandar64.pcap";
  if (!exists(capture)) GTEST_SKIP() << capture << " is not there";
  const std::vector<SensorTurn> turns = TurnsOf(capture, Pandar64Model());
  // Four whole turns and the beginning of one. The published cloud is the third.
  ASSERT_EQ(turns.size(), 5U);
  ExpectAllIn(CellsOf(turns, 2, 6.0), folder / "pandar64_decoded.pcd", 93'591);
}

struct Reference {
  const char* name;
  const SpinningModel* model;
  std::size_t turn;
  std::size_t num_points;  ///< Of the cloud, which for QT128 lacks what is nearer than 0.3 m.
  std::size_t num_ours;
};

void PrintTo(const Reference& reference, std::ostream* out) {
  *out << reference.name;
}

class HesaiReferenceOf : public testing::TestWithParam<Reference> {};

// The other decoder leaves out how far the rotor has turned until each laser fires.
TEST_P(HesaiReferenceOf, GivesTheSamePointsWhenTheRotorWaits) {
  const auto& [name, model, turn, num_points, num_ours] = GetParam();
  if (const std::string why = WhyNoHesaiBag(name); !why.empty()) GTEST_SKIP() << why;
  const TemporaryDirectory folder;
  SpinningModel waiting = *model;
  waiting.turns_azimuths = true;
  const auto turns = TurnsOf(CaptureOfHesaiBag(name, folder), waiting);
  EXPECT_EQ(turns.at(turn).points.size(), num_ours);
  // The lasers of QT128 look up to 10.2 deg aside.
  ExpectAllIn(CellsOf(turns, turn, 11.0), HesaiCloud(name), num_points);
}

INSTANTIATE_TEST_SUITE_P(Captures,
                         HesaiReferenceOf,
                         testing::Values(Reference{"xt32", &Xt32Model(), 3, 63'021, 63'021},
                                         Reference{"qt128", &Qt128Model(), 1, 73'560, 88'495},
                                         Reference{"pandar40p", &ModelOfSize("pandar40p", 1262), 2,
                                                   56'762, 56'763}),
                         [](const auto& test) { return std::string(test.param.name); });

// The table of the 128E4X against a cloud of packets in its high-resolution mode.

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
    const auto cloud = PclReads<pcl::PointCloud<pcl::PointXYZ>>(file);
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
