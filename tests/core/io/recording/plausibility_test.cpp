#include "core/io/recording/plausibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "core/io/recording/cloud_frame.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

/// A cloud of as many points in a room, in this unit, about a place.
Cloud RoomOf(std::size_t num_points, double metre, const Vector3& middle_m = Vector3::Zero()) {
  Cloud cloud;
  for (const char* axis : {"x", "y", "z"}) cloud.AddField(axis, NumberType::kDouble);
  cloud.width = static_cast<std::uint32_t>(num_points);
  cloud.height = 1;
  for (std::size_t i = 0; i < num_points; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(num_points);
    const Vector3 point = metre * (middle_m + Vector3(20.0 * share - 10.0, 12.0, 1.0));
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(point.data());
    cloud.data.insert(cloud.data.end(), bytes, bytes + sizeof point);
  }
  return cloud;
}

void SetX(double value, std::size_t num, Cloud& cloud) {
  for (std::size_t i = 0; i < num; ++i) {
    std::memcpy(cloud.data.data() + i * cloud.point_step, &value, sizeof value);
  }
}

std::string PositionFault(const Cloud& cloud) {
  return MessageOf([&] { (void)CheckPositions(cloud, "a.pcd"); });
}

TEST(CheckPositions, IsNoneOfMetresAboutTheSensorOrInAGrid) {
  EXPECT_EQ(PositionFault(RoomOf(200, 1.0)), "no error");
  EXPECT_EQ(PositionFault(RoomOf(200, 1.0, {691234.0, 5334567.0, 520.0})), "no error");
  EXPECT_EQ(PositionFault(RoomOf(200, 1.0, {12'000.0, 30'000.0, 520.0})), "no error");
  EXPECT_EQ(PositionFault(RoomOf(0, 1.0)), "no error");
}

TEST(CheckPositions, NamesTheShareThatCanBeMetres) {
  const std::string rule =
      "a.pcd: x, y, z: 99 % of the points must be less than 10 km from 0, or all in one place of a "
      "grid "
      "(got ";
  const std::string end = " %): other columns, another byte order or unit?";
  EXPECT_EQ(PositionFault(RoomOf(200, 1000.0)), rule + "0" + end);
  for (const double wrong : {1e19, 1e-30}) {
    Cloud cloud = RoomOf(200, 1.0);
    SetX(wrong, 2, cloud);
    EXPECT_EQ(CheckPositions(cloud, "a.pcd").at(0).number, 2U);
    SetX(wrong, 50, cloud);
    EXPECT_EQ(PositionFault(cloud), rule + "75" + end) << wrong;
  }
}

TEST(CheckPositions, TellsThatAllPointsAreVeryNear) {
  EXPECT_EQ(CheckPositions(RoomOf(200, 0.001), "a.pcd").at(0).kind, RemarkKind::kUnitsAssumed);
  EXPECT_TRUE(CheckPositions(RoomOf(200, 1.0), "a.pcd").empty());
}

TEST(CheckPositions, LeavesOutWhatIsNoPoint) {
  // Simulators write infinity for firings without a return.
  for (const double none :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Cloud cloud = RoomOf(200, 1.0);
    SetX(none, 150, cloud);
    EXPECT_EQ(PositionFault(cloud), "no error");
  }
}

TEST(CheckPositions, RefusesWholeNumbersWhichStateNoUnit) {
  Cloud cloud;
  for (const char* axis : {"x", "y", "z"}) cloud.AddField(axis, NumberType::kInt16);
  cloud.width = cloud.height = 1;
  cloud.data.assign(6, 1);
  EXPECT_EQ(PositionFault(cloud),
            "a.pcd: x: must be floating point, for whole numbers do not state their unit (got 16 "
            "bits)");
}

/// Points around the sensor, the times of which span so many nanoseconds.
Cloud TurnOf(std::uint32_t duration_ns) {
  constexpr std::uint32_t kNum = 400;
  Cloud cloud;
  for (const char* axis : {"x", "y", "z"}) cloud.AddField(axis, NumberType::kFloat);
  cloud.AddField("time_ns", NumberType::kUint32);
  cloud.width = kNum;
  cloud.height = 1;
  for (std::uint32_t i = 0; i < kNum; ++i) {
    const float azimuth_rad = 6.28F * static_cast<float>(i) / kNum;
    const std::array<float, 3> point = {9.0F * std::cos(azimuth_rad), 9.0F * std::sin(azimuth_rad),
                                        1.0F};
    const std::uint32_t time_ns = duration_ns / (kNum - 1) * i;
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(point.data());
    cloud.data.insert(cloud.data.end(), bytes, bytes + sizeof point);
    bytes = reinterpret_cast<const std::uint8_t*>(&time_ns);
    cloud.data.insert(cloud.data.end(), bytes, bytes + sizeof time_ns);
  }
  return cloud;
}

TEST(UnlikelyTimes, OfATurnWithinLessThanAnyTakesAreLeftOut) {
  const RecordedFrame likely = MakeCloudFrame(TurnOf(100'000'000), "a.pcd");
  EXPECT_TRUE(likely.remarks.empty());
  EXPECT_TRUE(likely.Has("time_ns"));
  const RecordedFrame unlikely = MakeCloudFrame(TurnOf(99'750), "a.pcd");
  EXPECT_EQ(
      unlikely.remarks,
      (std::vector<Remark>{{RemarkKind::kFieldsLeftOut, "a.pcd", 1,
                            "times of points, for no turn is as short as theirs, 0.09975 ms"}}));
  EXPECT_FALSE(unlikely.Has("time_ns"));
  EXPECT_EQ(unlikely.frame.duration_ns, 0U);
}

TEST(CheckPositions, IsSaidByWhatMakesFramesOfClouds) {
  EXPECT_THAT(MessageOf([] { (void)MakeCloudFrame(RoomOf(200, 1000.0), "mm.pcd"); }),
              testing::StartsWith("mm.pcd: x, y, z: 99 % of the points must be"));
}

RecordedFrame WithRanges(std::size_t num, std::size_t num_far) {
  RecordedFrame recorded;
  recorded.name = "a.pcd";
  recorded.frame.range_m.assign(num, 20.0F);
  recorded.frame.range_m.push_back(std::numeric_limits<float>::quiet_NaN());
  std::fill_n(recorded.frame.range_m.begin(), num_far, 16681.0F);
  return recorded;
}

TEST(CheckRanges, TellsFewAndRefusesMore) {
  EXPECT_EQ(CheckRanges(WithRanges(200, 0), {}, 100.0), std::nullopt);
  EXPECT_EQ(CheckRanges(WithRanges(200, 2), {}, 100.0),
            (Remark{.kind = RemarkKind::kFarReturns,
                    .place = "a.pcd",
                    .number = 2,
                    .detail = "1 %, the farthest 16681 m"}));
  EXPECT_EQ(MessageOf([] { (void)CheckRanges(WithRanges(200, 50), {}, 100.0); }),
            "a.pcd: range_m: at most 1 % of the returns may be beyond the sensor's range_max_m of "
            "100 (got 25 %, the farthest 16681 m): another unit?");
}

TEST(CheckRanges, TellsAnyNumberOfCapturesWhosePacketsStateTheUnit) {
  RecordedFrame turn = WithRanges(200, 50);
  turn.beam_of = [](std::uint32_t, std::uint32_t) { return RecordedBeam{}; };
  ASSERT_TRUE(CheckRanges(turn, {}, 100.0).has_value());
  EXPECT_EQ(CheckRanges(turn, {}, 100.0)->number, 50U);
}

}  // namespace
}  // namespace railcast
