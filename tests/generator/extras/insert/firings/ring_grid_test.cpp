#include "generator/extras/insert/firings/ring_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/units.h"
#include "railcast/io/recording.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

std::vector<double> Channels_rad() {
  return {RadFromDeg(-15.0), RadFromDeg(-5.0), RadFromDeg(0.0), RadFromDeg(5.0), RadFromDeg(15.0)};
}

TEST(RingRows, BelongToTheChannelsWithTheLeastDifferenceInAll) {
  const std::vector<RecordedRow> rows = {
      {RadFromDeg(-15.1), 100}, {RadFromDeg(0.1), 100}, {RadFromDeg(4.9), 100}};
  EXPECT_THAT(ChannelsOfRows(rows, Channels_rad()), testing::ElementsAre(0, 2, 3));
}

TEST(RingRows, WithoutPointsAreThoseOfTheGridIfItHasAll) {
  const std::vector<RecordedRow> rows = {
      {RadFromDeg(-15.0), 9}, {0.0, 0}, {RadFromDeg(0.0), 9}, {RadFromDeg(5.0), 9}, {0.0, 0}};
  EXPECT_THAT(ChannelsOfRows(rows, Channels_rad()), testing::ElementsAre(0, 1, 2, 3, 4));
  const std::vector<RecordedRow> fewer(rows.begin(), rows.begin() + 3);
  EXPECT_THAT(ChannelsOfRows(fewer, Channels_rad()), testing::ElementsAre(0, kNoSlot, 2));
}

TEST(RingRows, ThatNoChannelHasAreRefused) {
  const std::vector<RecordedRow> rows = {{RadFromDeg(-15.0), 100}, {RadFromDeg(2.3), 100}};
  EXPECT_EQ(MessageOf([&] { (void)ChannelsOfRows(rows, Channels_rad()); }),
            "ring 1 of 2 lies at 2.3 deg, the sensor's channel at 0 deg");
}

}  // namespace
}  // namespace railcast
