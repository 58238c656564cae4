#include "core/motion/gnss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "core/rail/line/map_place.h"

namespace railcast {
namespace {

/// A vehicle at (1000, 2000, 300) that faces north, runs at 20 m/s and turns to the left.
RigidMotion Northbound() {
  RigidMotion motion;
  motion.world_from_body =
      MakeTransform(RotationFromYawPitchRoll(std::acos(0.0), 0.0, 0.0), {1000.0, 2000.0, 300.0});
  motion.velocity_mps = {0.0, 20.0, 0.0};
  motion.angular_velocity_radps = {0.0, 0.0, 0.1};
  return motion;
}

const GnssSpec kExact{.antenna_m = {3.0, 0.5, 4.0}};

GnssSample Measured(const GnssSpec& spec,
                    double sky_share,
                    std::uint64_t sample = 0,
                    std::uint64_t seed = 1,
                    const std::optional<MapSpec>& map = {}) {
  return GnssReceiver{spec, seed, map}.Measure(Northbound(), sky_share, sample);
}

TEST(GnssReceiver, MeasuresThePlaceAndTheVelocityOfItsAntenna) {
  const GnssSample sample = Measured(kExact, 1.0);
  EXPECT_TRUE(sample.has_fix);
  EXPECT_TRUE(sample.position_m.isApprox(Vector3(999.5, 2003.0, 304.0), 1e-14));
  // 3 m ahead and 0.5 m to the left of the origin, about which it turns.
  EXPECT_TRUE(sample.velocity_mps.isApprox(Vector3(-0.3, 20.0 - 0.05, 0.0), 1e-12));
  EXPECT_EQ(sample.true_position_m, sample.position_m);
  EXPECT_EQ(sample.true_velocity_mps, sample.velocity_mps);
}

TEST(GnssReceiver, HasNoFixWhereTooLittleOfTheSkyIsFree) {
  const GnssSample lost = Measured(kExact, 0.29);
  EXPECT_FALSE(lost.has_fix);
  EXPECT_EQ(lost.sky_share, 0.29);
  EXPECT_TRUE(std::isnan(lost.position_m.x()));
  EXPECT_TRUE(std::isnan(lost.velocity_mps.x()));
  EXPECT_EQ(lost.true_position_m, Measured(kExact, 1.0).position_m);
  EXPECT_TRUE(Measured(kExact, 0.3).has_fix);
  GnssSpec undemanding = kExact;
  undemanding.least_sky_share = 0.0;
  EXPECT_FALSE(Measured(undemanding, 0.0).has_fix);
}

TEST(GnssReceiver, GivesLongitudeAndLatitudeWhereTheMapIsKnown) {
  EXPECT_TRUE(std::isnan(Measured(kExact, 1.0).longitude_deg));
  const MapSpec map{{0.0, 0.0}, 15.63, 48.21, {}};
  const GnssSample sample = Measured(kExact, 1.0, 0, 1, map);
  const Eigen::Vector2d back_m =
      WorldFromGeographic(map, sample.longitude_deg, sample.latitude_deg);
  EXPECT_LT((back_m - sample.position_m.head<2>()).norm(), 2e-6);
  EXPECT_EQ(sample.height_m(), 304.0);
}

GnssSpec Noisy() {
  GnssSpec spec = kExact;
  spec.rate_hz = 2.0;
  spec.horizontal_noise_m = 1.5;
  spec.vertical_noise_m = 3.0;
  spec.velocity_noise_mps = 0.05;
  spec.correlation_time_s = 20.0;
  return spec;
}

// Errors of position of two samples tau apart have the covariance sigma^2 exp(-tau / T), and under
// half a sky twice that. Tolerances are five standard deviations over independent seeds.
TEST(GnssReceiver, ErrorsOfPositionAreCorrelatedInTimeAndGrowAsTheSkyCloses) {
  constexpr int kNumSeeds = 2000;
  const auto covariance = [](double sky_share, int axis, std::uint64_t apart) {
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < kNumSeeds; ++seed) {
      const auto error_at = [&](std::uint64_t sample) {
        const GnssSample measured = Measured(Noisy(), sky_share, sample, seed);
        return measured.position_m(axis) - measured.true_position_m(axis);
      };
      sum += error_at(500) * error_at(500 + apart);
    }
    return sum / kNumSeeds;
  };
  const double tolerance = 5.0 * std::sqrt(2.0 / kNumSeeds);
  EXPECT_NEAR(covariance(1.0, 0, 0) / 2.25, 1.0, tolerance);
  EXPECT_NEAR(covariance(1.0, 2, 0) / 9.0, 1.0, tolerance);
  EXPECT_NEAR(covariance(1.0, 1, 40) / 2.25, std::exp(-1.0), tolerance);
  EXPECT_NEAR(covariance(0.5, 1, 0) / 2.25, 2.0, 2.0 * tolerance);
  const GnssSample half = Measured(Noisy(), 0.5);
  EXPECT_DOUBLE_EQ(half.position_sigma_m.z(), 3.0 * std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(half.velocity_sigma_mps, 0.05 * std::sqrt(2.0));
}

TEST(GnssReceiver, ErrorsOfVelocityAreWhite) {
  constexpr std::uint64_t kNum = 4000;
  const auto error_at = [](std::uint64_t sample) {
    const GnssSample measured = Measured(Noisy(), 1.0, sample);
    return (measured.velocity_mps.x() - measured.true_velocity_mps.x()) / 0.05;
  };
  double squares = 0.0;
  double products = 0.0;
  for (std::uint64_t sample = 0; sample < kNum; ++sample) {
    squares += error_at(sample) * error_at(sample) / kNum;
    products += error_at(sample) * error_at(sample + 1) / kNum;
  }
  EXPECT_NEAR(squares, 1.0, 5.0 * std::sqrt(2.0 / kNum));
  EXPECT_NEAR(products, 0.0, 5.0 / std::sqrt(static_cast<double>(kNum)));
}

}  // namespace
}  // namespace railcast
