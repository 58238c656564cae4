#include "core/io/recording/cloud_fields.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "core/io/cloud/cloud_file.h"
#include "core/io/recording/cloud_frame.h"

namespace railcast {
namespace {

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
