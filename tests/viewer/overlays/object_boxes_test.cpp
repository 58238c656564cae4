#include "viewer/overlays/overlays.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace railcast {
namespace {

constexpr float kRounding_m = 1e-5F;  // Rounding of float32 at 100 m is 4e-6.

RecordedObject Wagon(const Vector3& centre_m, double yaw_rad) {
  return {.name = "wagon_7",
          .type = "open_wagon",
          .label = "wagon",
          .instance = 1,
          .size_m = {14.0, 3.0, 4.0},
          .sensor_from_box = MakeTransform(RotationFromYawPitchRoll(yaw_rad, 0.0, 0.0), centre_m)};
}

Overlay DrawOne(const RecordedObject& object) {
  RecordedFrame recorded;
  recorded.objects = {object};
  Label wagon;
  wagon.id = 12;
  wagon.name = "wagon";
  wagon.rgb = {213, 94, 0};
  return DrawObjectBoxes(recorded, LabelTable({wagon}));
}

bool HasEnd(const Overlay& drawing, const Eigen::Vector3f& place_m) {
  return std::ranges::any_of(drawing.segments, [&](const Overlay::Segment& segment) {
    return (segment.from_m - place_m).norm() < kRounding_m ||
           (segment.to_m - place_m).norm() < kRounding_m;
  });
}

TEST(ObjectBoxes, HaveTheirCornersWhereSizeAndPoseSay) {
  // The wagon is turned left by 90 deg, so its length lies along y.
  const Overlay drawing = DrawOne(Wagon({50.0, 2.0, 1.0}, 0.5 * std::numbers::pi));
  for (const float x : {48.5F, 51.5F}) {
    for (const float y : {-5.0F, 9.0F}) {
      for (const float z : {-1.0F, 3.0F}) {
        EXPECT_TRUE(HasEnd(drawing, {x, y, z})) << x << " " << y << " " << z;
      }
    }
  }
}

TEST(ObjectBoxes, OfKittiAreWhereTheirPointsWereSeen) {
  RecordedFrame recorded;
  recorded.axes = PointAxes::kSensorAtStamp;
  recorded.has_pose = true;
  recorded.frame.world_from_sensor =
      MakeTransform(RotationFromYawPitchRoll(0.5 * std::numbers::pi, 0.0, 0.0), Vector3(9, 9, 9));
  RecordedObject wagon = Wagon({50.0, 2.0, 1.0}, 0.0);
  wagon.velocity_world_mps = Vector3(0.0, 30.0, 0.0);  // Ahead, as the sensor looks north.
  wagon.points_time_ns = 50'000'000;
  recorded.objects = {wagon};
  EXPECT_TRUE(HasEnd(DrawObjectBoxes(recorded, LabelTable()), {58.5F, 3.5F, 3.0F}));
}

TEST(ObjectBoxes, HaveFourEdgesAlongEachAxis) {
  const Overlay drawing = DrawOne(Wagon({50.0, 2.0, 1.0}, 0.0));
  for (const auto& [axis, length_m] :
       {std::pair{0, 14.0F}, std::pair{1, 3.0F}, std::pair{2, 4.0F}}) {
    EXPECT_EQ(std::ranges::count_if(drawing.segments,
                                    [&, axis = axis, length_m = length_m](const auto& segment) {
                                      const Eigen::Vector3f way = segment.to_m - segment.from_m;
                                      return std::abs(std::abs(way[axis]) - way.norm()) < 1e-6F &&
                                             std::abs(way.norm() - length_m) < kRounding_m;
                                    }),
              4);
  }
}

TEST(ObjectBoxes, PointANoseWhereTheObjectHeads) {
  // The wagon is turned to head towards -x, so its front is at 43 m and the tip of the nose 1 m
  // before that.
  EXPECT_TRUE(HasEnd(DrawOne(Wagon({50.0, 2.0, 1.0}, std::numbers::pi)), {42.0F, 2.0F, 1.0F}));
}

TEST(ObjectBoxes, CarryTheirNamesAtTheMiddleOfTheTop) {
  const Overlay drawing = DrawOne(Wagon({50.0, 2.0, 1.0}, 0.3));
  ASSERT_EQ(drawing.words.size(), 1U);
  EXPECT_EQ(drawing.words[0].text, "wagon_7");
  EXPECT_LT((drawing.words[0].at_m - Eigen::Vector3f(50.0F, 2.0F, 3.0F)).norm(), kRounding_m);
}

TEST(ObjectBoxes, TakeTheirLabelsColourOrWhite) {
  RecordedObject object = Wagon({50.0, 2.0, 1.0}, 0.0);
  EXPECT_EQ(DrawOne(object).segments[0].rgb, (Rgb{213, 94, 0}));
  EXPECT_EQ(DrawOne(object).words[0].rgb, (Rgb{213, 94, 0}));
  object.label = "spaceship";
  EXPECT_EQ(DrawOne(object).segments[0].rgb, (Rgb{255, 255, 255}));
}

TEST(ObjectBoxes, LeaveOutWhatIsFartherThan400Metres) {
  EXPECT_EQ(DrawOne(Wagon({240.0, 319.9, 0.0}, 0.0)).segments.size(), 14U);
  const Overlay drawing = DrawOne(Wagon({240.0, 320.1, 0.0}, 0.0));
  EXPECT_THAT(drawing.segments, testing::IsEmpty());
  EXPECT_THAT(drawing.words, testing::IsEmpty());
}

}  // namespace
}  // namespace railcast
