#include "core/io/recording/plausibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/recording/cloud_fields.h"
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

/// A turn of a VLP-16 or XT16 or, with other elevations, of no known sensor in a room 9 m away, in
/// a unit.
Cloud VlpRoom(double metre, double step_deg = 2.0) {
  constexpr std::uint32_t kColumns = 180;
  constexpr std::uint32_t kRows = 16;
  Cloud cloud;
  for (const char* axis : {"x", "y", "z"}) cloud.AddField(axis, NumberType::kFloat);
  cloud.width = kColumns * kRows;
  cloud.height = 1;
  for (std::uint32_t i = 0; i < cloud.width; ++i) {
    const double azimuth_rad = RadFromDeg(2.0 * (i / kRows) + 0.3);
    const double elevation_rad = RadFromDeg(step_deg * (i % kRows) - 15.0);
    const double level_m = metre * 9.0;
    const std::array<float, 3> point = {static_cast<float>(level_m * std::cos(azimuth_rad)),
                                        static_cast<float>(level_m * std::sin(azimuth_rad)),
                                        static_cast<float>(level_m * std::tan(elevation_rad))};
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(point.data());
    cloud.data.insert(cloud.data.end(), bytes, bytes + sizeof point);
  }
  return cloud;
}

TEST(CheckUnit, HoldsRangesAgainstThoseOfTheSensorThatRingsShow) {
  EXPECT_TRUE(MakeCloudFrame(VlpRoom(1.0), "a.pcd").remarks.empty());
  for (const double unit : {15.0, 39.4, 100.0, 1000.0}) {
    EXPECT_THAT(
        MessageOf([&] { (void)MakeCloudFrame(VlpRoom(unit), "a.pcd"); }),
        testing::AllOf(testing::StartsWith("a.pcd: range_m: at most 10 % of the returns may "
                                           "be beyond 120 m, the range of a sensor with "
                                           "such rings (got 100 %, the farthest "),
                       testing::EndsWith(" m): another unit?")));
  }
}

// Of RS-LiDAR-16, Helios-16P or C16, whose rings are those of a VLP-16, in open country.
TEST(CheckUnit, TellsReturnsOfASensorThatSeesFartherThanOneWithItsRings) {
  for (const float longer : {1.4F, 1.6F, 2.1F}) {
    for (const std::uint32_t num_far : {1U, 5U, 18U, 19U}) {  // Of 180 columns.
      Cloud cloud = VlpRoom(10.0);
      for (std::uint32_t i = 0; i < 3 * 16 * num_far; ++i) {
        float value{};
        std::memcpy(&value, cloud.data.data() + 4 * std::size_t{i}, sizeof value);
        value *= longer;
        std::memcpy(cloud.data.data() + 4 * std::size_t{i}, &value, sizeof value);
      }
      if (num_far == 19) {
        EXPECT_THAT(MessageOf([&] { (void)MakeCloudFrame(cloud, "a.pcd"); }),
                    testing::HasSubstr("with such rings (got 10.56 %, the farthest "));
        continue;
      }
      const auto remarks = MakeCloudFrame(cloud, "a.pcd").remarks;
      ASSERT_EQ(remarks.size(), 1U) << longer << ", " << num_far;
      EXPECT_EQ(remarks[0].kind, RemarkKind::kFarReturns);
      EXPECT_EQ(remarks[0].number, 16U * num_far);
      EXPECT_THAT(remarks[0].detail,
                  testing::EndsWith(" % beyond 120 m, the range of a sensor with such rings"));
    }
  }
}

TEST(CheckUnit, TellsRangesThatNoSensorHas) {
  EXPECT_TRUE(MakeCloudFrame(VlpRoom(30.0, 1.5), "a.pcd").remarks.empty());
  for (const double unit : {100.0, 1000.0}) {
    const auto remarks = MakeCloudFrame(VlpRoom(unit, 1.5), "a.pcd").remarks;
    ASSERT_EQ(remarks.size(), 1U);
    EXPECT_EQ(remarks[0].kind, RemarkKind::kUnitsAssumed);
    EXPECT_THAT(remarks[0].detail, testing::StartsWith("half of its ranges are beyond 9"));
  }
}

TEST(CheckPositions, AreNoneOfPolarNumbers) {
  const double rad = std::numbers::pi / 180.0;
  for (const double unit : {1.0, rad}) {
    for (const double first_deg : {-180.0, 0.0}) {
      for (const std::array<std::size_t, 3>& order :
           {std::array<std::size_t, 3>{0, 1, 2}, {1, 2, 0}, {2, 0, 1}}) {
        Cloud cloud = RoomOf(16 * 90, 1.0);
        for (std::size_t i = 0; i < cloud.num_points(); ++i) {
          const std::array<double, 3> polar = {
              7.0 + std::sin(0.1 * static_cast<double>(i)),
              unit * (first_deg + 4.0 * static_cast<double>(i / 16)),
              unit * (2.0 * static_cast<double>(i % 16) - 15.0)};
          std::array<double, 3> stored{};
          for (std::size_t axis = 0; axis < 3; ++axis) stored.at(order.at(axis)) = polar.at(axis);
          std::memcpy(cloud.data.data() + i * cloud.point_step, stored.data(), sizeof stored);
        }
        const std::string name = "xyz";
        EXPECT_EQ(PositionFault(cloud), std::string("a.pcd: x, y, z: must be places (got ") +
                                            name[order[0]] + " is like a range, " + name[order[1]] +
                                            " like an azimuth and " + name[order[2]] +
                                            " like an elevation in " +
                                            (unit == 1.0 ? "degrees" : "radians") + ")");
      }
    }
  }
}

using testing::ElementsAre;

/// Returns an unorganised cloud with x, y and z stored as `Number`.
template <typename Number>
RecordedFrame FrameOf(const std::vector<Number>& coordinates_m) {
  Cloud cloud;
  for (const char* axis : {"x", "y", "z"}) cloud.AddField(axis, NumberTypeOf<Number>());
  cloud.width = static_cast<std::uint32_t>(coordinates_m.size() / 3);
  cloud.height = 1;
  cloud.data.resize(coordinates_m.size() * sizeof(Number));
  std::memcpy(cloud.data.data(), coordinates_m.data(), cloud.data.size());
  return MakeCloudFrame(cloud, "a.pcd");
}

// A position in UTM zone 32 north.
constexpr double kEast_m = 691234.5;
constexpr double kNorth_m = 5334567.25;

TEST(NearOrigin, KeepsNeighboursInANationalGridApart) {
  const RecordedFrame recorded = FrameOf<double>({kEast_m, kNorth_m, 520.0,         //
                                                  kEast_m + 0.01, kNorth_m, 520.0,  //
                                                  kEast_m, kNorth_m + 0.02, 520.25});
  EXPECT_EQ(recorded.origin_m, Vector3(691000.0, 5335000.0, 1000.0));
  // Below 512 m, float32 rounds by at most 2^-16 m.
  constexpr double kRounding_m = 1.0 / 32768.0;
  const Frame& frame = recorded.frame;
  EXPECT_NEAR(static_cast<double>(frame.x[1] - frame.x[0]), 0.01, kRounding_m);
  EXPECT_NEAR(static_cast<double>(frame.y[2] - frame.y[0]), 0.02, kRounding_m);
  EXPECT_NEAR(recorded.origin_m.y() + static_cast<double>(frame.y[0]), kNorth_m, kRounding_m);
  EXPECT_NEAR(recorded.origin_m.z() + static_cast<double>(frame.z[2]), 520.25, kRounding_m);
}

TEST(NearOrigin, LeavesTheRangeFromTheStoredZero) {
  const RecordedFrame recorded = FrameOf<double>({3e6, 4e6, 0.0});
  EXPECT_THAT(recorded.frame.range_m, ElementsAre(5e6F));
  EXPECT_THAT(recorded.frame.x, ElementsAre(0.0F));
}

TEST(NearOrigin, StaysZeroWithinTenKilometres) {
  const RecordedFrame recorded = FrameOf<double>({9999.0, 0.0, 1.0});
  EXPECT_EQ(recorded.origin_m, Vector3(Vector3::Zero()));
  EXPECT_THAT(recorded.frame.x, ElementsAre(9999.0F));
}

TEST(NearOrigin, StaysZeroOfFloat32WhichHasNothingMoreToGive) {
  const RecordedFrame recorded = FrameOf<float>({691234.5F, 5334567.0F, 520.0F});
  EXPECT_EQ(recorded.origin_m, Vector3(Vector3::Zero()));
  EXPECT_THAT(recorded.frame.y, ElementsAre(5334567.0F));
  EXPECT_THAT(recorded.remarks, ElementsAre(Remark{.kind = RemarkKind::kPositionsRounded,
                                                   .place = "a.pcd",
                                                   .detail = "in steps of 0.5 m"}));
}

TEST(NearOrigin, IsThatOfTextWithAllItsDigits) {
  const CloudFile read =
      ParsePcdFile("a.pcd",
                   "FIELDS X Y Z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\nDATA ascii\n"
                   "691234.15 5334567.61 520.5\n691234.64 5334567.84 520.5\n");
  const RecordedFrame recorded = MakeCloudFrame(read.cloud, "a.pcd");
  EXPECT_EQ(recorded.origin_m, Vector3(691000.0, 5335000.0, 1000.0));
  EXPECT_NEAR(double{recorded.frame.x[1] - recorded.frame.x[0]}, 0.49, 1e-4);
  EXPECT_TRUE(recorded.remarks.empty());
}

TEST(NearOrigin, IsNearMostPointsWhereverAFewAre) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> points_m = {0.0, 0.0, 0.0,  // Not a point.
                                  nan, nan, nan, 1e9, 1e9, 1e9};
  for (int i = 0; i < 99; ++i) points_m.insert(points_m.end(), {kEast_m, kNorth_m, 20.0});
  const RecordedFrame recorded = FrameOf<double>(points_m);
  EXPECT_EQ(recorded.origin_m, Vector3(691000.0, 5335000.0, 0.0));
  EXPECT_GT(recorded.frame.x.front(), 9e8F);
  EXPECT_EQ(recorded.frame.x.back(), 234.5F);
  EXPECT_EQ(recorded.frame.z.back(), 20.0F);
}

TEST(NearOrigin, StaysZeroOfACloudWithoutPoints) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(FrameOf<double>({nan, nan, nan}).origin_m, Vector3(Vector3::Zero()));
}

}  // namespace
}  // namespace railcast
