#include "core/simulate/frame_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/base/units.h"

namespace railcast {
namespace {

constexpr std::int64_t kFrame_ns = 100'000'000;

// A thing that flies along a parabola and turns about an axis of its own.
const Vector3 kFlightStart_m(120.0, -30.0, 2.0);
const Vector3 kFlight_mps(30.0, -4.0, 0.5);
const Vector3 kFlight_mps2(-2.0, 1.0, 0.3);
const Vector3 kFlightTurn_radps(0.4, -1.5, 3.0);

Eigen::Affine3d FlightAt(std::int64_t time_ns) {
  const double t = SecondsFromNs(time_ns);
  Eigen::Affine3d place = Eigen::Affine3d::Identity();
  place.translation() = kFlightStart_m + t * kFlight_mps + 0.5 * t * t * kFlight_mps2;
  place.linear() = Eigen::AngleAxisd(t * kFlightTurn_radps.norm(), kFlightTurn_radps.normalized())
                       .toRotationMatrix();
  return place;
}

Vector3 VelocityInFlight_mps(std::int64_t time_ns, const Vector3& place_m) {
  const Vector3 arm_m = place_m - FlightAt(time_ns).translation();
  return kFlight_mps + SecondsFromNs(time_ns) * kFlight_mps2 + kFlightTurn_radps.cross(arm_m);
}

std::vector<Eigen::Affine3d> InFlight(std::int64_t time_ns) {
  return {FlightAt(time_ns)};
}

TEST(VelocityField, IsThatOfARigidBodyAtItsSteps) {
  const VelocityFields fields = VelocityFieldsOf(&InFlight, kFrame_ns, 5).front();
  ASSERT_EQ(fields.size(), 6U);
  for (std::int64_t step = 0; step <= 5; ++step) {
    const std::int64_t time_ns = kFrame_ns * step / 5;
    const Vector3 place_m = FlightAt(time_ns) * Vector3(2.0, -1.0, 3.0);
    // (w 0.5 ms)^2 / 3 of 3.4 rad/s x 3.7 m is 0.012 mm/s.
    EXPECT_LT((VelocityAt_mps(fields, static_cast<double>(step) / 5.0, place_m) -
               VelocityInFlight_mps(time_ns, place_m))
                  .norm(),
              2e-5)
        << step;
  }
}

TEST(VelocityField, IsLinearBetweenSteps) {
  const VelocityFields fields = VelocityFieldsOf(&InFlight, kFrame_ns, 10).front();
  for (const std::int64_t time_ns : {3'000'000, 47'500'000, 99'000'000}) {
    const Vector3 place_m = FlightAt(time_ns) * Vector3(2.0, -1.0, 3.0);
    const double shutter = static_cast<double>(time_ns) / kFrame_ns;
    // At one place, the velocity of what turns past it bends by w^2 v + w a: dt^2 / 8 of
    // 3.4^2 x 43 + 2 x 3.4 x 2.2 m/s^3 is 6 mm/s.
    EXPECT_LT(
        (VelocityAt_mps(fields, shutter, place_m) - VelocityInFlight_mps(time_ns, place_m)).norm(),
        7e-3)
        << time_ns;
  }
}

// What starts walking with the frame has its full speed from then on.
TEST(VelocityField, AsksForNoPlaceBeforeTheStampNorAfterTheFrame) {
  std::vector<std::int64_t> asked_ns;
  const PlacesAt places_at = [&](std::int64_t time_ns) {
    asked_ns.push_back(time_ns);
    const double x_m = 1.4 * std::max(0.0, SecondsFromNs(time_ns));
    return std::vector<Eigen::Affine3d>{Eigen::Affine3d(Eigen::Translation3d(x_m, 0.0, 0.0))};
  };
  const VelocityFields fields = VelocityFieldsOf(places_at, kFrame_ns, 2).front();
  EXPECT_EQ(*std::ranges::min_element(asked_ns), 0);
  EXPECT_EQ(*std::ranges::max_element(asked_ns), kFrame_ns);
  for (const double shutter : {0.0, 0.3, 1.0}) {
    EXPECT_NEAR(VelocityAt_mps(fields, shutter, Vector3::Zero()).x(), 1.4, 1e-9);
  }
}

TEST(VelocityField, OfAFrameWithoutDurationIsThatAtTheStamp) {
  const VelocityFields fields = VelocityFieldsOf(&InFlight, 0, 0).front();
  ASSERT_EQ(fields.size(), 1U);
  EXPECT_LT((VelocityAt_mps(fields, 0.0, kFlightStart_m) - kFlight_mps).norm(), 1e-6);
}

}  // namespace
}  // namespace railcast
