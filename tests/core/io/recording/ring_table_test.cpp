#include "core/io/recording/ring_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/random.h"
#include "core/base/units.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/recording/elevation_rings.h"
#include "core/io/recording/slot_plans.h"

namespace railcast {
namespace {

/// Parameters of a made turn of a spinning sensor.
struct MadeTurn {
  std::uint32_t rings = 16;
  std::uint32_t columns = 900;
  double first_deg = 0.0;  ///< Clockwise.
  double step_deg = 0.4;
  double jitter_steps = 0.0;  ///< Jitter of each firing's azimuth, to either side.
  double drop_share = 0.0;
  bool is_counterclockwise = false;
  /// From this column on, odd rows fire in every second column only.
  std::uint32_t first_sparse_column = ~0U;
};

/// The points of a turn and the row and column where each belongs.
struct MadePoints {
  PointPositions positions;
  std::vector<std::uint32_t> rings;  ///< Numbered as by a vendor, not by elevation.
  std::vector<std::uint32_t> row, column;

  void Add(double azimuth_deg, double elevation_deg, double range_m) {
    const double azimuth_rad = RadFromDeg(azimuth_deg);
    const double elevation_rad = RadFromDeg(elevation_deg);
    positions.x.push_back(
        static_cast<float>(range_m * std::cos(elevation_rad) * std::cos(azimuth_rad)));
    positions.y.push_back(
        static_cast<float>(range_m * std::cos(elevation_rad) * std::sin(azimuth_rad)));
    positions.z.push_back(static_cast<float>(range_m * std::sin(elevation_rad)));
  }
};

double ElevationOf_deg(const MadeTurn& turn, std::uint32_t row) {
  return -15.0 + 30.0 * row / (turn.rings - 1);
}

MadePoints Make(const MadeTurn& turn) {
  MadePoints made;
  for (std::uint32_t column = 0; column < turn.columns; ++column) {
    for (std::uint32_t ring = 0; ring < turn.rings; ++ring) {
      const auto words = RandomWords(3, RandomUse::kNoise, column, ring);
      if (static_cast<double>(UnitFloat(words[0])) < turn.drop_share) continue;
      const double jitter = (2.0 * static_cast<double>(UnitFloat(words[1])) - 1.0);
      const double clockwise_deg =
          turn.first_deg + turn.step_deg * (column + turn.jitter_steps * jitter);
      // Ring numbers alternate between the two ends of the fan and run towards its middle.
      const std::uint32_t row = ring % 2 == 0 ? ring / 2 : turn.rings - 1 - ring / 2;
      if (column >= turn.first_sparse_column && column % 2 == 1 && row % 2 == 1) continue;
      made.Add(turn.is_counterclockwise ? clockwise_deg : -clockwise_deg,
               ElevationOf_deg(turn, row), 5.0 + 40.0 * static_cast<double>(UnitFloat(words[2])));
      made.rings.push_back(ring);
      made.row.push_back(row);
      made.column.push_back(column);
    }
  }
  return made;
}

/// Counts the points that are in their row and, up to a common offset, in their column.
std::size_t NumRight(const MadePoints& made, const SlotPlan& plan) {
  std::map<std::int64_t, std::size_t> by_offset;
  for (std::size_t i = 0; i < made.row.size(); ++i) {
    if (plan.slots[i] == kNoSlot) continue;
    const std::uint32_t cell = plan.slots[i] / plan.returns;
    if (cell / plan.columns != made.row[i]) continue;
    // The first column may lie at any azimuth.
    const std::int64_t offset = std::int64_t{cell % plan.columns} - made.column[i];
    ++by_offset[(offset + std::int64_t{2} * plan.columns) % plan.columns];
  }
  std::size_t most = 0;
  for (const auto& [offset, num] : by_offset) most = std::max(most, num);
  return most;
}

TEST(RingTable, PutsEveryPointOfAnEvenTurnIntoItsCell) {
  const MadePoints made = Make({});
  const auto plan = MakeRingTable(made.positions, made.rings);
  ASSERT_TRUE(plan.has_value());
  EXPECT_TRUE(plan->is_grid);
  EXPECT_EQ(plan->rows, 16U);
  EXPECT_EQ(plan->columns, 900U);
  EXPECT_EQ(plan->returns, 1U);
  EXPECT_EQ(NumRight(made, *plan), made.row.size());
}

TEST(RingTable, FindsTheRingsInTheElevations) {
  const MadePoints made = Make({.drop_share = 0.3});
  const auto plan = MakeRingTable(made.positions, {});
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(plan->rows, 16U);
  EXPECT_EQ(plan->columns, 900U);
  EXPECT_EQ(NumRight(made, *plan), made.row.size());
}

TEST(RingTable, KeepsColumnsInTheOrderInWhichTheyFired) {
  for (const bool is_counterclockwise : {false, true}) {
    const MadePoints made = Make({.columns = 300, .is_counterclockwise = is_counterclockwise});
    const auto plan = MakeRingTable(made.positions, made.rings);
    ASSERT_TRUE(plan.has_value());
    for (std::size_t i = 0; i < made.row.size(); ++i) {
      ASSERT_EQ(plan->slots[i] % plan->columns, made.column[i]);
    }
  }
}

TEST(RingTable, CoversOnlyTheAzimuthsSeen) {
  // Covers 270 deg through 0 to 90 deg.
  const MadePoints made = Make({.columns = 450, .first_deg = 270.0, .drop_share = 0.1});
  const auto plan = MakeRingTable(made.positions, made.rings);
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(plan->columns, 450U);
  const double filled = static_cast<double>(made.row.size()) / (16 * 450);
  // Of 7200 firings a tenth is dropped at random; 3 sigma are 0.011.
  EXPECT_NEAR(filled, 0.9, 0.011);
  EXPECT_EQ(NumRight(made, *plan), made.row.size());
}

TEST(RingTable, ToleratesAnUnevenRotor) {
  const MadePoints made = Make({.jitter_steps = 0.2, .drop_share = 0.1});
  const auto plan = MakeRingTable(made.positions, made.rings);
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(plan->columns, 900U);
  EXPECT_EQ(NumRight(made, *plan), made.row.size());
}

// Eight rings fire every 0.4 deg, eight every 0.8 deg: each of the former makes two rows of columns
// of 0.8 deg, in which every slot is a firing.
TEST(RingTable, GivesARingThatFiresTwiceAsOftenTwoRows) {
  const MadePoints made = Make({.drop_share = 0.1, .first_sparse_column = 0});
  const auto plan = MakeRingTable(made.positions, made.rings);
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(plan->rows, 8U * 2 + 8U);
  EXPECT_EQ(plan->columns, 450U);
  EXPECT_EQ(plan->returns, 1U);
  const double filled = static_cast<double>(made.row.size()) / (24 * 450);
  // Of 10,800 firings a tenth is dropped at random; 4 sigma are 0.012.
  EXPECT_NEAR(filled, 0.9, 0.012);
  for (std::size_t i = 0; i < made.row.size(); ++i) {
    const std::uint32_t first_row = (3 * made.row[i] + 1) / 2;
    const std::uint32_t row = plan->slots[i] / plan->columns;
    ASSERT_GE(row, first_row);
    ASSERT_LT(row, first_row + (made.row[i] % 2 == 0 ? 2 : 1));
  }
}

// Two lasers of one elevation, 0.12 deg apart in azimuth, are seen as one ring whose steps are 0.12
// and 0.28 deg in turn. It does not fire three times within a column.
TEST(RingTable, TakesTwoLasersOfOneElevationForNoFasterRing) {
  MadePoints made = Make({.rings = 15});
  for (std::uint32_t column = 0; column < 900; ++column) {
    for (const double offset_deg : {0.0, 0.12}) {
      made.Add(-0.4 * column - offset_deg, 20.0, 30.0);
      made.rings.push_back(99);
    }
  }
  const auto plan = MakeRingTable(made.positions, made.rings);
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(plan->rows, 16U);
}

// From the middle of the turn on, half of the rings fire half as often: their gaps there look like
// firings that returned nothing, and are none.
TEST(RingTable, IsNoneWhereStepsDoubleWithinATurn) {
  const MadePoints made = Make({.drop_share = 0.02, .first_sparse_column = 450});
  EXPECT_FALSE(MakeRingTable(made.positions, made.rings).has_value());
}

TEST(RingTable, IsNoneWhereAzimuthsAreAtNoSteps) {
  const MadePoints made = Make({.jitter_steps = 20.0});
  EXPECT_FALSE(MakeRingTable(made.positions, made.rings).has_value());
}

TEST(RingTable, GivesACellTwoReturnsIfManyHaveTwoPoints) {
  MadePoints made = Make({.rings = 8, .columns = 300});
  const std::size_t num_firsts = made.row.size();
  for (std::size_t i = 0; i < num_firsts; i += 10) {
    made.positions.x.push_back(1.5F * made.positions.x[i]);
    made.positions.y.push_back(1.5F * made.positions.y[i]);
    made.positions.z.push_back(1.5F * made.positions.z[i]);
    made.rings.push_back(made.rings[i]);
  }
  const auto plan = MakeRingTable(made.positions, made.rings);
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(plan->returns, 2U);
  std::set<std::uint32_t> taken;
  for (std::size_t i = 0; i < plan->slots.size(); ++i) {
    EXPECT_EQ(plan->slots[i] % 2, i < num_firsts ? 0U : 1U);
    EXPECT_TRUE(taken.insert(plan->slots[i]).second);
  }
}

TEST(RingTable, KeepsPointsThatShareACellAsReturnsFromTheNearestOn) {
  MadePoints made = Make({.rings = 8, .columns = 300});
  made.positions.x.push_back(0.5F * made.positions.x[7]);
  made.positions.y.push_back(0.5F * made.positions.y[7]);
  made.positions.z.push_back(0.5F * made.positions.z[7]);
  made.rings.push_back(made.rings[7]);
  const auto plan = MakeRingTable(made.positions, made.rings);
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(plan->returns, 2U);
  EXPECT_EQ(std::ranges::count(plan->slots, kNoSlot), 0);
  EXPECT_EQ(plan->slots[7], plan->slots.back() + 1);
}

TEST(RingTable, IsNoneWhereFivePointsShareACell) {
  MadePoints made = Make({.rings = 8, .columns = 300});
  for (const float share : {0.5F, 0.6F, 0.7F, 0.8F}) {
    made.positions.x.push_back(share * made.positions.x[7]);
    made.positions.y.push_back(share * made.positions.y[7]);
    made.positions.z.push_back(share * made.positions.z[7]);
    made.rings.push_back(made.rings[7]);
  }
  EXPECT_FALSE(MakeRingTable(made.positions, made.rings).has_value());
}

TEST(RingTable, IsNoneOfPointsWithoutRings) {
  MadePoints made;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const auto words = RandomWords(3, RandomUse::kNoise, 0, i);
    made.Add(360.0 * static_cast<double>(UnitFloat(words[0])),
             -30.0 + 60.0 * static_cast<double>(UnitFloat(words[1])), 20.0);
  }
  EXPECT_FALSE(MakeRingTable(made.positions, {}).has_value());
}

TEST(RingTable, IsNoneOfFewOrNoPoints) {
  EXPECT_FALSE(MakeRingTable({}, {}).has_value());
  MadePoints made;
  made.Add(10.0, 0.0, 20.0);
  EXPECT_FALSE(MakeRingTable(made.positions, {}).has_value());
  const std::vector<std::uint32_t> rings = {4};
  EXPECT_FALSE(MakeRingTable(made.positions, rings).has_value());
  made.positions.x[0] = std::nanf("");
  EXPECT_FALSE(MakeRingTable(made.positions, rings).has_value());
}

TEST(ElevationRings, GiveStraysToTheNearest) {
  std::vector<double> elevations_rad;
  for (int i = 0; i < 1000; ++i) elevations_rad.push_back(RadFromDeg(2.0 * (i % 4)));
  elevations_rad.push_back(RadFromDeg(3.1));
  const auto rings = RingsByElevation(elevations_rad);
  ASSERT_TRUE(rings.has_value());
  EXPECT_EQ((*rings)[6], 2U);
  EXPECT_EQ(rings->back(), 2U);
}

// The sensor fired 909 cycles of 0.199 deg over half a turn. Its lasers have azimuth offsets of up
// to 4.2 deg to either side, which adds 42 columns that some of them did not reach.
TEST(RingTable, OfARealHalfTurnHoldsAllPointsAndCoversHalfATurn) {
  const std::filesystem::path file =
      RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/vlp32c_single_decoded.pcd";
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const auto plan = MakeRingTable(LoadPositions(ReadCloud(file)), {});
  ASSERT_TRUE(plan.has_value());
  EXPECT_EQ(plan->rows, 32U);
  // 63 of 26,216 points share a cell with another.
  EXPECT_EQ(plan->returns, 2U);
  EXPECT_NEAR(plan->columns, 951.0, 5.0);
  EXPECT_EQ(std::ranges::count(plan->slots, kNoSlot), 0);
}

}  // namespace
}  // namespace railcast
