// Targets narrower than the beam, from 1 m to 300 m. A single ray per beam hits them now and then
// and then reports a filled beam; a beam with a width sees their share of it every time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/detect/base/beam_optics.h"
#include "railcast/simulator.h"
#include "tests/stability/regime.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr double kRanges_m[] = {1.0, 3.0, 10.0, 30.0, 100.0, 300.0};
constexpr std::uint16_t kTargetGrey = 2;  // Reflectivity 0.5.
constexpr double kReflectance = 0.5;
constexpr double kWireRadius_m = 0.006;

double Phi(double x) {
  return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

// Round beams of 3 mrad, so that sigma is 0.75 mrad in every direction.
SimulatorSpec SpecWith(const EffectSet& effects) {
  SimulatorSpec spec{
      .detector = {.seed = 4, .range_min_m = 0.1, .range_max_m = 400.0, .effects = effects}};
  spec.detector.beam.divergence_mrad = {3.0, 3.0};
  return spec;
}
constexpr double kBeamSigma_rad = 0.75e-3;

constexpr EffectSet kRay{.surface_response = true};
constexpr EffectSet kBeam{.surface_response = true, .footprint = true, .thin_conductors = true};
constexpr EffectSet kDenseBeam{
    .surface_response = true, .footprint = true, .dense_footprint = true, .sampled_waveform = true};

// A wire across the view at `range_m` that rises by an eighth, so that every column meets it at
// another height between its rows.
constexpr double kWireSlope = 0.1237;
std::shared_ptr<SimpleWorld> WireAcross(double range_m) {
  const double half_m = 0.1 * range_m;
  auto world = std::make_shared<SimpleWorld>();
  const Vector3 begin(range_m, -half_m, -kWireSlope * half_m);
  const Vector3 end(range_m, half_m, kWireSlope * half_m);
  world->wires = {
      {.material = kTargetGrey, .label = 7, .radius_m = kWireRadius_m, .points_m = {begin, end}}};
  Mesh tube = MakeCylinder(kWireRadius_m, (end - begin).norm() / 2.0, 16);
  const auto along_wire = Eigen::Quaternionf::FromTwoVectors(
      Eigen::Vector3f::UnitZ(), (end - begin).normalized().cast<float>());
  for (auto& vertex : tube.vertices) {
    vertex = along_wire * vertex + Eigen::Vector3f(static_cast<float>(range_m), 0.0F, 0.0F);
  }
  world->ground.parts = {{tube, kTargetGrey, 7, true}};
  return world;
}

// Beams across the wire: 4 deg wide and 1 deg high.
constexpr double kSpacing_deg = 0.02;
ScanPattern AcrossTheWire() {
  return MakeRaster(4.0, 1.0, kSpacing_deg);
}

// Returns the share of a beam that the wire takes.
double ShareOfWire(const Vector3& beam, double range_m) {
  // Height of the beam above the wire at the beam's azimuth, in the plane x = range.
  const double y_m = range_m * beam.y() / beam.x();
  const double off_m = range_m * beam.z() / beam.x() - kWireSlope * y_m;
  const double across_rad = off_m / std::hypot(1.0, kWireSlope) / range_m;
  const double half_rad = kWireRadius_m / range_m;
  return Phi((across_rad + half_rad) / kBeamSigma_rad) -
         Phi((across_rad - half_rad) / kBeamSigma_rad);
}

TEST(ThinTargets, AWireGivesEveryBeamItsShareAtAnyRange) {
  const ScanPattern pattern = AcrossTheWire();
  for (const double range_m : kRanges_m) {
    const Frame frame = ScanOnce(WireAcross(range_m), pattern, SpecWith(kBeam));
    std::size_t checked = 0;
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      const std::size_t firing =
          // Firings are ordered by columns.
          std::size_t{frame.column[slot]} * pattern.rows + frame.ring[slot];
      const double share = ShareOfWire(DirectionOf(pattern, firing), range_m);
      if (share < 1e-3) continue;
      // The closed form holds in the plane x = range, which is off by 1 - cos 2 deg = 6e-4 at the
      // edge.
      ASSERT_NEAR(static_cast<double>(frame.footprint_share[slot]), share, 2e-3 * share + 2e-4)
          << range_m;
      // A Lambertian cylinder reflects pi / 4 of what a plane of its width does.
      ASSERT_NEAR(static_cast<double>(frame.intensity[slot]),
                  share * kReflectance * std::numbers::pi / 4.0, 5e-3 * share + 2e-4);
      ASSERT_EQ(frame.label[slot], 7U);
      ++checked;
    }
    EXPECT_GE(checked, pattern.columns) << range_m;
  }
}

TEST(ThinTargets, AWireDimsTheWallBehindItAndHidesBehindAWallInFront) {
  const ScanPattern pattern = MakeRaster(0.2, 0.2, 0.02);
  for (const double wall_m : {90.0, 110.0}) {
    auto world = WireAcross(100.0);
    world->ground.parts.push_back({MakeWall(static_cast<float>(wall_m), 20.0F), kTargetGrey, 8});
    SimulatorSpec spec = SpecWith(kBeam);
    spec.detector.receiver.return_mode = ReturnMode::kDual;
    const Frame frame = ScanOnce(world, pattern, spec);
    std::size_t num_seen = 0;
    for (std::size_t slot = 0; slot < frame.num_slots(); slot += 2) {
      ASSERT_EQ(frame.label[slot], 8U) << "the wall is the stronger";
      const std::size_t firing = std::size_t{frame.column[slot]} * pattern.rows + frame.ring[slot];
      // Where the wire is too weak for an echo of its own, its light is counted as the wall's: up
      // to 0.01 of the beam, of which it reflects pi / 4.
      const bool is_seen = frame.return_count[slot] == 2;
      const double share = is_seen ? ShareOfWire(DirectionOf(pattern, firing), 100.0) : 0.0;
      num_seen += is_seen ? 1 : 0;
      ASSERT_NEAR(static_cast<double>(frame.footprint_share[slot]), 1.0 - share, 1e-3);
      ASSERT_NEAR(static_cast<double>(frame.intensity[slot]), kReflectance * (1.0 - share), 1.5e-3);
    }
    EXPECT_EQ(num_seen > 20, wall_m > 100.0) << num_seen;
  }
}

TEST(ThinTargets, AWireLosesPowerInFogAsAnythingDoes) {
  SimulatorSpec spec = SpecWith(kBeam);
  spec.detector.effects.extinction = true;
  spec.detector.weather.visibility_m = 200.0;
  const Frame frame = ScanOnce(WireAcross(100.0), MakeRaster(0.2, 0.2, 0.02), spec);
  std::size_t checked = 0;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (frame.label[slot] != 7) continue;
    const double range_m = static_cast<double>(frame.true_range_m[slot]);
    const double expected = static_cast<double>(frame.intensity[slot]) * 4e5 / (range_m * range_m) *
                            std::exp(-2.0 * std::log(20.0) / 200.0 * range_m);
    ASSERT_NEAR(static_cast<double>(frame.power_ratio[slot]) / expected, 1.0, 1e-4);
    ++checked;
  }
  EXPECT_GT(checked, 50U);
}

// Returns the share of columns in which at least one beam meets the wire.
double ShareOfColumnsThatHit(const Frame& frame) {
  std::vector<bool> is_hit(frame.columns);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (frame.outcome[slot] == Outcome::kReturned) is_hit[frame.column[slot]] = true;
  }
  return static_cast<double>(std::count(is_hit.begin(), is_hit.end(), true)) / frame.columns;
}

// A ray meets a wire of 12 mm with the probability d / (spacing x range); the share of 200 columns,
// whose heights are evenly spread, equals that to within a few columns. A ray that meets it reports
// a filled beam.
TEST(ThinTargets, ARayHitsAWireNowAndThenAndThenClaimsAFilledBeam) {
  const ScanPattern pattern = AcrossTheWire();
  for (const double range_m : {60.0, 100.0, 300.0}) {
    const Frame rays = ScanOnce(WireAcross(range_m), pattern, SpecWith(kRay));
    const Frame beams = ScanOnce(WireAcross(range_m), pattern, SpecWith(kBeam));
    const double p = 2.0 * kWireRadius_m / (RadFromDeg(kSpacing_deg) * range_m);
    EXPECT_NEAR(ShareOfColumnsThatHit(rays), p, 0.03) << range_m;
    RecordRegime("a wire of 12 mm at " + std::to_string(std::lround(range_m)) + " m",
                 {"met in " + TwoDigits(100.0 * ShareOfColumnsThatHit(rays)) + " % of " +
                      std::to_string(rays.columns) + " columns, each time as if it filled the beam",
                  "met in " + TwoDigits(100.0 * ShareOfColumnsThatHit(beams)) +
                      " %, with its share of the beam to 0.2 %",
                  "as its sub-rays meet it"});
    EXPECT_EQ(ShareOfColumnsThatHit(beams), 1.0) << range_m;
    const auto highest = [](const std::vector<float>& values) {
      float most = 0.0F;
      for (const float value : values) most = value > most ? value : most;
      return static_cast<double>(most);
    };
    EXPECT_GT(highest(rays.intensity), 0.8 * kReflectance) << range_m;
    const double most = 2.0 * Phi(kWireRadius_m / range_m / kBeamSigma_rad) - 1.0;
    EXPECT_LE(highest(beams.intensity), 1.01 * most * kReflectance * std::numbers::pi / 4.0);
  }
}

// Detection limit: P = rho (pi / 4) d / (sqrt(2 pi) sigma R) / R^2 >= 0.1 / R0^2.
TEST(ThinTargets, AWireIsSeenAsFarAsTheClosedFormSays) {
  const double range_m =
      std::cbrt(kReflectance * std::numbers::pi / 4.0 * 2.0 * kWireRadius_m * 200.0 * 200.0 / 0.1 /
                (std::sqrt(2.0 * std::numbers::pi) * kBeamSigma_rad));
  SimulatorSpec spec = SpecWith(kBeam);
  spec.detector.effects.detection = true;
  const ScanPattern pattern = MakeRaster(0.1, 0.5, 0.005);
  const auto is_seen = [&](double at_m) {
    const Frame frame = ScanOnce(WireAcross(at_m), pattern, spec);
    return std::count(frame.outcome.begin(), frame.outcome.end(), Outcome::kReturned) > 0;
  };
  EXPECT_NEAR(range_m, 99.9, 1.0);
  EXPECT_TRUE(is_seen(0.99 * range_m));
  EXPECT_FALSE(is_seen(1.01 * range_m));
}

/// Mean share of the beam in one column.
struct Column {
  double azimuth_rad{};
  double share{};
};

// Scans with beams 0.1 deg (2.3 sigma) apart in a fan of 4 deg, with a hundred beams per azimuth.
std::vector<Column> SharesByColumn(const std::shared_ptr<SimpleWorld>& world,
                                   const EffectSet& effects) {
  const ScanPattern pattern = MakeRaster(4.0, 10.0, 0.1);
  const Frame frame = ScanOnce(world, pattern, SpecWith(effects));
  std::vector<Column> columns(pattern.columns);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    Column& column = columns[frame.column[slot]];
    column.azimuth_rad = RadFromDeg(2.0 - 0.1 * (frame.column[slot] + 0.5));
    if (frame.outcome[slot] == Outcome::kReturned) {
      column.share += static_cast<double>(frame.footprint_share[slot]) / pattern.rows;
    }
  }
  return columns;
}

// The mean over a hundred beams, each turned at random. A beam of rung footprint has 64 cells, a
// dense one 257.
constexpr double kSparse = 0.012;
constexpr double kDense = 0.005;

TEST(ThinTargets, APoleTakesItsShareOfTheBeamsThatMeetIt) {
  double worst[] = {0.0, 0.0};
  for (const double range_m : {3.0, 10.0, 30.0, 100.0, 300.0}) {
    constexpr double kRadius_m = 0.05;
    Mesh pole = MakeCylinder(kRadius_m, 40.0, 64);
    // The pole is in the middle of a beam, so that at least one ray meets it at any range.
    const double azimuth_rad = RadFromDeg(0.05);
    for (auto& vertex : pole.vertices) {
      vertex.x() += static_cast<float>(range_m * std::cos(azimuth_rad));
      vertex.y() += static_cast<float>(range_m * std::sin(azimuth_rad));
    }
    const auto world = WorldOfParts({{pole, kTargetGrey, 7}});
    // Apparent half width: the tangents touch the pole in front of its axis.
    const double half_rad = std::asin(kRadius_m / range_m);
    for (const bool is_dense : {false, true}) {
      for (const Column& column : SharesByColumn(world, is_dense ? kDenseBeam : kBeam)) {
        const double off_rad = column.azimuth_rad - azimuth_rad;
        const double expected =
            Phi((off_rad + half_rad) / kBeamSigma_rad) - Phi((off_rad - half_rad) / kBeamSigma_rad);
        EXPECT_NEAR(column.share, expected, is_dense ? kDense : kSparse)
            << range_m << " " << off_rad / kBeamSigma_rad;
        worst[is_dense] = std::max(worst[is_dense], std::abs(column.share - expected));
      }
    }
  }
  RecordRegime("a pole of 10 cm at 3 to 300 m, its share of a beam",
               {"0 or 1", "to " + TwoDigits(worst[0]), "to " + TwoDigits(worst[1])});
}

TEST(ThinTargets, APlatesEdgeFadesAsTheBeamsProfileAtAnyRange) {
  for (const double range_m : kRanges_m) {
    const auto x = static_cast<float>(range_m);
    const auto world =
        WorldOfParts({{{{{x, -x, -x}, {x, 0, -x}, {x, 0, x}, {x, -x, x}}, {{0, 1, 2}, {0, 2, 3}}},
                       kTargetGrey,
                       7}});
    for (const bool is_dense : {false, true}) {
      for (const Column& column : SharesByColumn(world, is_dense ? kDenseBeam : kBeam)) {
        const double expected = Phi(-column.azimuth_rad / kBeamSigma_rad);
        EXPECT_NEAR(column.share, expected, is_dense ? kDense : kSparse)
            << range_m << " " << column.azimuth_rad / kBeamSigma_rad;
      }
    }
    for (const Column& column : SharesByColumn(world, kRay)) {
      EXPECT_EQ(column.share > 0.5, column.azimuth_rad < 0.0) << "a ray knows no shares";
    }
  }
}

}  // namespace
}  // namespace railcast
