#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "railcast/lidar.h"

namespace railcast {
namespace {

/// Expects that the firing of every slot has the slot's row and column, and that no two firings
/// share a slot.
void ExpectFiringsOfAllSlots(const ScanPattern& pattern, std::uint32_t returns) {
  std::vector<std::uint32_t> num_slots(pattern.num_firings());
  for (std::size_t slot = 0; slot < std::size_t{returns} * pattern.num_firings(); ++slot) {
    const std::uint32_t firing = FiringOfSlot(pattern, returns, slot);
    ASSERT_LT(firing, num_slots.size());
    const std::size_t first =
        (std::size_t{pattern.row[firing]} * pattern.columns + pattern.column[firing]) * returns;
    ASSERT_GE(slot, first);
    ASSERT_LT(slot, first + returns);
    ++num_slots[firing];
  }
  EXPECT_EQ(num_slots, std::vector<std::uint32_t>(pattern.num_firings(), returns));
}

TEST(FiringOfSlot, FindsTheColumnsOfARasterInWhateverOrderTheyFire) {
  for (const RasterOrder order : {RasterOrder::kColumns, RasterOrder::kRows}) {
    const ScanPattern pattern =
        BuildScanPattern({.rate_hz = 10.0, .pattern = RasterSpec{6.0, 4.0, 1.0, order}});
    ExpectFiringsOfAllSlots(pattern, 1);
  }
  // Six columns of four rows each; columns fire one after another.
  const ScanPattern pattern =
      BuildScanPattern({.rate_hz = 10.0, .pattern = RasterSpec{6.0, 4.0, 1.0}});
  EXPECT_EQ(FiringOfSlot(pattern, 1, 1), 4U);
  EXPECT_EQ(FiringOfSlot(pattern, 1, 6), 1U);
}

TEST(FiringOfSlot, FindsTheChannelsOfASpinningSensorWithSeveralReturns) {
  // Rows are ordered by elevation: the channel that fires first is the highest.
  const SpinningSpec spinning{.channels = {{.elevation_deg = 5.0, .time_us = 0.0},
                                           {.elevation_deg = -10.0, .time_us = 25.0},
                                           {.elevation_deg = 0.0, .time_us = 50.0}},
                              .cycle_us = 100.0,
                              .columns = 20};
  const ScanPattern pattern = BuildScanPattern({.rate_hz = 10.0, .pattern = spinning});
  for (const std::uint32_t returns : {1U, 2U, 3U}) ExpectFiringsOfAllSlots(pattern, returns);
  EXPECT_EQ(FiringOfSlot(pattern, 2, 0), 1U);
  EXPECT_EQ(FiringOfSlot(pattern, 2, 2 * 20 * 2 + 1), 0U);
}

TEST(FiringOfSlot, CountsAlongTheTableOfAPatternThatIsNoGrid) {
  const std::string file = testing::TempDir() + "firing_of_slot.csv";
  std::ofstream(file) << "azimuth_deg,elevation_deg,time_us\n10,-5,0\n-20,7,12.5\n0,0,12.5\n";
  const ScanPattern pattern = BuildScanPattern({.rate_hz = 10.0, .pattern = FiringTableSpec{file}});
  std::filesystem::remove(file);
  EXPECT_EQ(FiringOfSlot(pattern, 1, 2), 2U);
  EXPECT_EQ(FiringOfSlot(pattern, 3, 5), 1U);
}

}  // namespace
}  // namespace railcast
