#include "core/motion/gnss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>

#include "core/motion/markov_sequence.h"
#include "core/rail/line/map_place.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

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

/// A square of 2 km across, turned and moved from x = 0, where it faces -x.
Model Plane(const Transform& to_from_plane) {
  Mesh mesh;
  mesh.Append(MakeWall(0.0F, 1000.0F), to_from_plane);
  return {"plane", {{std::move(mesh), 1, 5}}};
}
Transform Beside(double y_m) {
  return MakeTransform(RotationFromYawPitchRoll(0.5 * std::numbers::pi, 0.0, 0.0), {0.0, y_m, 0.0});
}
Transform Above(double z_m) {
  return MakeTransform(RotationFromYawPitchRoll(0.0, 0.5 * std::numbers::pi, 0.0), {0.0, 0.0, z_m});
}

double ShareAt(std::shared_ptr<const World> world,
               const Vector3& place_m,
               double elevation_mask_rad = 0.0) {
  const SimulatorSpec spec{.detector = {.range_max_m = 100.0}};
  Simulator simulator(std::move(world), MakeRaster(10, 10, 1), TestMaterials(), spec, 1);
  double share = -1.0;
  simulator.VisitScene(0, [&](const SceneOfFrame& scene) {
    share = FreeSkyShare(scene, place_m, elevation_mask_rad, kSkyReach_m);
  });
  return share;
}

// Of rays that are spread evenly, a few lie on either side of any line.
constexpr double kTolerance = 4.0 / 256.0;

TEST(FreeSkyShare, IsOneWhereNothingStands) {
  const auto world = std::make_shared<SimpleWorld>();
  world->ground = Plane(Above(-1.0));
  EXPECT_EQ(ShareAt(world, {0.0, 0.0, 4.0}), 1.0);
}

TEST(FreeSkyShare, IsNoneBelowARoof) {
  const auto world = std::make_shared<SimpleWorld>();
  world->ground = Plane(Above(5.0));
  // Below 0.6 degrees, the roof is farther than 100 m.
  EXPECT_EQ(ShareAt(world, {0.0, 0.0, 4.0}, 0.1), 0.0);
}

TEST(FreeSkyShare, IsHalfBesideAHighWall) {
  const auto world = std::make_shared<SimpleWorld>();
  world->ground = Plane(Beside(1.0));
  EXPECT_NEAR(ShareAt(world, Vector3::Zero()), 0.5, kTolerance);
}

// Solid angle above the elevation e is 2 pi (1 - sin e): a wall beside the antenna up to an
// elevation of 45 degrees all along, 20 m high and 20 m away, hides the half circle's part 1/2 -
// asin(sin 45 deg) / pi of the half sphere, which is 1/4.
TEST(FreeSkyShare, CountsSolidAngle) {
  const auto world = std::make_shared<SimpleWorld>();
  Transform low = Beside(20.0);
  low.translation().z() = 20.0 - 1000.0;
  world->ground = Plane(low);
  // Rays reach 100 m, so that those of directions within 0.2 of the wall's own miss it: 0.04 sr of
  // the half sphere.
  EXPECT_NEAR(ShareAt(world, Vector3::Zero()), 0.75, kTolerance + 0.01);
}

TEST(FreeSkyShare, DoesNotCountWhatIsBelowTheMask) {
  const auto world = std::make_shared<SimpleWorld>();
  Transform low = Beside(20.0);
  low.translation().z() = 20.0 - 1000.0;
  world->ground = Plane(low);
  EXPECT_EQ(ShareAt(world, Vector3::Zero(), 46.0 / 180.0 * std::numbers::pi), 1.0);
}

TEST(FreeSkyShare, TheVehicleHidesNothing) {
  const auto world = std::make_shared<SimpleWorld>();
  auto box = std::make_shared<Model>(Model{"box", {{MakeSphere(3.0, 8, 8), 1, 6}}});
  world->AddObject(box, Transform::Identity(), Vector3::Zero(), /*is_ego=*/true);
  EXPECT_EQ(ShareAt(world, Vector3::Zero()), 1.0);
  const auto with_roof = std::make_shared<SimpleWorld>(*world);
  with_roof->ground = Plane(Above(10.0));
  EXPECT_EQ(ShareAt(with_roof, Vector3::Zero(), 0.2), 0.0);
}

constexpr int kNumSequences = 4000;
// Five standard deviations of a mean over that many independent numbers of variance 1, and of their
// mean square, whose variance is 2.
const double kMeanTolerance = 5.0 / std::sqrt(kNumSequences);
const double kSquareTolerance = 5.0 * std::sqrt(2.0 / kNumSequences);

/// Mean of f(seed) over independent seeds.
template <typename F>
double MeanOverSeeds(const F& f) {
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < kNumSequences; ++seed) sum += f(seed);
  return sum / kNumSequences;
}

double WalkAt(std::uint64_t seed, std::uint64_t index) {
  return MarkovSequence::Walk({seed, 1}).At(index);
}

TEST(WhiteNoise, IsStandardNormalAndIndependentFromOneElementToTheNext) {
  const auto noise = [](std::uint64_t index) { return WhiteNoise({5, 2}, index); };
  EXPECT_NEAR(MeanOverSeeds(noise), 0.0, kMeanTolerance);
  EXPECT_NEAR(MeanOverSeeds([&](std::uint64_t i) { return noise(i) * noise(i); }), 1.0,
              kSquareTolerance);
  EXPECT_NEAR(MeanOverSeeds([&](std::uint64_t i) { return noise(i) * noise(i + 1); }), 0.0,
              kMeanTolerance);
  // The normal distribution's share within one standard deviation, and its deviation.
  const double within = std::erf(std::sqrt(0.5));
  EXPECT_NEAR(MeanOverSeeds([&](std::uint64_t i) { return std::abs(noise(i)) < 1.0; }), within,
              5.0 * std::sqrt(within * (1.0 - within) / kNumSequences));
}

TEST(WhiteNoise, DiffersBetweenSeedsAndComponents) {
  EXPECT_NE(WhiteNoise({5, 2}, 7), WhiteNoise({6, 2}, 7));
  EXPECT_NE(WhiteNoise({5, 2}, 7), WhiteNoise({5, 3}, 7));
  EXPECT_NE(WhiteNoise({5, 2}, 7), WhiteNoise({5, 2}, 7 + (std::uint64_t{1} << 32U)));
}

TEST(MarkovSequence, AWalkBeginsAtZeroAndItsVarianceIsItsIndex) {
  EXPECT_EQ(WalkAt(3, 0), 0.0);
  for (const std::uint64_t index : {1U, 2U, 3U, 5U, 64U, 1000U, 65'537U}) {
    const double square = MeanOverSeeds([&](std::uint64_t seed) {
      const double at = WalkAt(seed, index);
      return at * at / static_cast<double>(index);
    });
    EXPECT_NEAR(square, 1.0, kSquareTolerance) << index;
  }
}

// Elements that are known from different halvings: their covariance is the lesser index.
TEST(MarkovSequence, AWalkHasTheCovarianceOfASum) {
  for (const auto& [i, j] : {std::pair{5U, 6U}, {7U, 9U}, {1000U, 1040U}, {1023U, 1025U}}) {
    const double covariance = MeanOverSeeds(
        [i = i, j = j](std::uint64_t seed) { return WalkAt(seed, i) * WalkAt(seed, j); });
    // The variance of the product of two normal numbers is at most twice that of either squared.
    EXPECT_NEAR(covariance, i, std::sqrt(static_cast<double>(i) * j) * kSquareTolerance) << i;
  }
}

TEST(MarkovSequence, TheStepsOfAWalkAreWhite) {
  const MarkovSequence walk = MarkovSequence::Walk({9, 0});
  const auto step = [&](std::uint64_t i) { return walk.At(2000 + i + 1) - walk.At(2000 + i); };
  EXPECT_NEAR(MeanOverSeeds(step), 0.0, kMeanTolerance);
  EXPECT_NEAR(MeanOverSeeds([&](std::uint64_t i) { return step(i) * step(i); }), 1.0,
              kSquareTolerance);
  for (const std::uint64_t lag : {1U, 2U, 8U}) {
    EXPECT_NEAR(MeanOverSeeds([&](std::uint64_t i) { return step(i) * step(i + lag); }), 0.0,
                kMeanTolerance);
  }
}

TEST(MarkovSequence, AStationaryOneHasVarianceOneAndForgetsExponentially) {
  constexpr double kDecay = 0.01;
  const auto at = [](std::uint64_t seed, std::uint64_t index) {
    return MarkovSequence::Stationary({seed, 2}, kDecay).At(index);
  };
  for (const std::uint64_t index : {0U, 1U, 5U, 1000U, 1'000'000U}) {
    const auto square = [&](std::uint64_t seed) { return at(seed, index) * at(seed, index); };
    EXPECT_NEAR(MeanOverSeeds(square), 1.0, kSquareTolerance) << index;
  }
  for (const auto& [i, j] : {std::pair{0U, 30U}, {1000U, 1001U}, {1000U, 1040U}, {1020U, 1170U}}) {
    const double product =
        MeanOverSeeds([&, i = i, j = j](std::uint64_t seed) { return at(seed, i) * at(seed, j); });
    EXPECT_NEAR(product, std::exp(-kDecay * (j - i)), kSquareTolerance) << i;
  }
}

TEST(MarkovSequence, IsFoundFarAwayAtOnce) {
  const double far = WalkAt(1, std::uint64_t{1} << 45U);
  EXPECT_TRUE(std::isfinite(far));
  EXPECT_LT(std::abs(far), 6.0 * std::exp2(22.5));
  EXPECT_TRUE(std::isfinite(MarkovSequence::Stationary({1, 0}, 1e-9).At((1ULL << 45U) + 12'345)));
}

}  // namespace
}  // namespace railcast
