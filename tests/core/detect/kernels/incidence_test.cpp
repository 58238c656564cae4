// Compares the formulas for a Gaussian beam on an oblique surface with sums over many rays.
#include "core/detect/kernels/rays.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/detect/base/beam_optics.h"
#include "core/detect/kernels/surface_response.h"
#include "railcast/transform.h"

namespace railcast {
namespace {

/// A beam from the origin that meets a plane.
struct Slant {
  Vector3 direction;
  Vector3 normal;
  double range_m{};
  double sigma_h_rad{}, sigma_v_rad{};
};

struct Tiles {
  RayTile rays;
  DetectTile detect;
};

std::unique_ptr<Tiles> Spread(const Slant& slant) {
  auto tiles = std::make_unique<Tiles>();
  const Eigen::Vector3f d = slant.direction.normalized().cast<float>();
  const Eigen::Vector3f n = slant.normal.cast<float>();
  RayTile& rays = tiles->rays;
  rays.direction_x[0] = d.x();
  rays.direction_y[0] = d.y();
  rays.direction_z[0] = d.z();
  rays.normal_x[0] = n.x();
  rays.normal_y[0] = n.y();
  rays.normal_z[0] = n.z();
  rays.range_m[0] = static_cast<float>(slant.range_m);
  tiles->detect.num_rays = 1;
  baseline::ApplyIncidence(rays, tiles->detect);
  BeamFrame beam{.sigma_h_rad = static_cast<float>(slant.sigma_h_rad),
                 .sigma_v_rad = static_cast<float>(slant.sigma_v_rad)};
  baseline::ApplySpread(rays, beam, tiles->detect);
  return tiles;
}

struct WeightedRange {
  double range_m{}, weight{};
};

// Samples the ranges of the plane over the beam's profile on a grid of +-5 sigma.
std::vector<WeightedRange> BruteForce(const Slant& slant) {
  const Vector3 d = slant.direction.normalized();
  const Vector3 h = Vector3::UnitZ().cross(d).normalized();
  const Vector3 v = d.cross(h);
  const double offset_m = slant.range_m * slant.normal.dot(d);
  std::vector<WeightedRange> ranges;
  constexpr int kHalf = 100;
  for (int i = -kHalf; i <= kHalf; ++i) {
    for (int j = -kHalf; j <= kHalf; ++j) {
      const double a = 5.0 * i / kHalf;
      const double b = 5.0 * j / kHalf;
      const Vector3 ray = (d + a * slant.sigma_h_rad * h + b * slant.sigma_v_rad * v).normalized();
      ranges.push_back({offset_m / slant.normal.dot(ray), std::exp(-0.5 * (a * a + b * b))});
    }
  }
  return ranges;
}

double Deviation_m(const std::vector<WeightedRange>& ranges) {
  double weight = 0.0;
  double sum = 0.0;
  for (const auto& [range_m, w] : ranges) {
    weight += w;
    sum += w * range_m;
  }
  double squares = 0.0;
  for (const auto& [range_m, w] : ranges) squares += w * std::pow(range_m - sum / weight, 2);
  return std::sqrt(squares / weight);
}

// Peak of the sum of all returned pulses relative to that of a plane at normal incidence.
double PeakShare(const std::vector<WeightedRange>& ranges, double mean_m, double pulse_sigma_m) {
  double weight = 0.0;
  for (const auto& [range_m, w] : ranges) weight += w;
  double best = 0.0;
  for (double r = mean_m - pulse_sigma_m; r <= mean_m + pulse_sigma_m; r += 0.05 * pulse_sigma_m) {
    double sum = 0.0;
    for (const auto& [range_m, w] : ranges) {
      sum += w * std::exp(-0.5 * std::pow((range_m - r) / pulse_sigma_m, 2));
    }
    best = std::max(best, sum / weight);
  }
  return best;
}

const Slant kSlants[] = {
    {{1, 0, 0}, {-1, 0, 0}, 50, 7.5e-4, 3.75e-4},         // faces it
    {{1, 0, 0}, {-0.5, 0.8, 0.1}, 80, 7.5e-4, 3.75e-4},   // turned, mostly sideways
    {{1, 0.3, -0.1}, {0, 0, 1}, 30, 7.5e-4, 3.75e-4},     // ground
    {{0.2, -1, 0.4}, {0.3, 0.4, -0.8}, 120, 3e-4, 1e-3},  // a slope above
    {{1, 0, -0.02}, {0.01, 0.02, 1}, 100, 0.0, 3.75e-4},  // grazing, one axis alone
};

TEST(Incidence, IsTheCosineBetweenBeamAndNormalWhateverItsLengthAndSide) {
  for (const double length : {0.01, -3.0}) {
    const auto tiles = Spread({{1, 0, 0}, length * Vector3(0.6, 0.8, 0), 10, 0, 0});
    EXPECT_NEAR(static_cast<double>(tiles->detect.cos_incidence[0]), 0.6, 1e-6);
  }
  EXPECT_TRUE(std::isnan(Spread({{1, 0, 0}, {0, 0, 0}, 10, 0, 0})->detect.cos_incidence[0]));
}

TEST(Incidence, KnowsHowSteepASurfaceIs) {
  EXPECT_NEAR(static_cast<double>(Spread({{1, 0, 0}, {-3, 0, 4}, 10, 0, 0})->detect.normal_up[0]),
              0.8, 1e-6);
}

TEST(Incidence, TellsTheUndersideOfASurfaceHoweverItIsWound) {
  for (const double winding : {-1.0, 1.0}) {
    const Vector3 normal = winding * Vector3(3, 0, 4);
    EXPECT_NEAR(static_cast<double>(Spread({{1, 0, 0}, normal, 10, 0, 0})->detect.normal_up[0]),
                -0.8, 1e-6);
  }
}

TEST(Spread, IsTheDeviationOfTheRangeOverAGaussianBeam) {
  for (const Slant& slant : kSlants) {
    const double spread_m = static_cast<double>(Spread(slant)->detect.spread_m[0]);
    // The formula is linear in the angles; its relative error is below a fifth of spread / range.
    const double truth_m = Deviation_m(BruteForce(slant));
    EXPECT_NEAR(spread_m, truth_m, 0.01 * truth_m + 1e-4) << slant.normal.transpose();
  }
}

TEST(Spread, IsNothingForARay) {
  EXPECT_EQ(Spread({{1, 0, 0}, {-0.5, 0.8, 0.1}, 80, 0, 0})->detect.spread_m[0], 0.0F);
}

double StretchOf(const Slant& slant, const BeamSpec& beam) {
  const auto tiles = Spread(slant);
  tiles->detect.power_ratio[0] = 1.0F;
  tiles->detect.true_range_m[0] = static_cast<float>(slant.range_m);
  baseline::ApplyPulseStretch(tiles->detect, {static_cast<float>(PulseSigma_m(beam)), true, true});
  return static_cast<double>(tiles->detect.power_ratio[0]);
}

TEST(PulseStretch, IsThePeakOfAllPulsesThatASlantingPlaneSendsBack) {
  const BeamSpec beam;
  for (const Slant& slant : kSlants) {
    const double peak = PeakShare(BruteForce(slant), slant.range_m, PulseSigma_m(beam));
    EXPECT_NEAR(StretchOf(slant, beam), peak, 0.01) << slant.normal.transpose();
  }
}

/// Ground under a beam.
struct Ground {
  double height_m{}, range_m{};
  double lambert = 1.0, rough = 0.0;  ///< Weights of cos and sin^2 in its reflectance.
};

// Where the sum of all returned pulses has its peak, in front of the ground on the beam's axis.
double PeakBefore_m(const Ground& ground, const BeamSpec& beam) {
  const double sigma_rad = VerticalSigma_rad(beam);
  const double axis_rad = std::asin(ground.height_m / ground.range_m);
  const double pulse_m = PulseSigma_m(beam);
  const auto wave = [&](double at_m) {
    double sum = 0.0;
    constexpr double kReach = 6.0;
    for (double z = -kReach; z <= kReach; z += 0.002) {
      const double sine = std::sin(axis_rad + z * sigma_rad);
      if (sine <= 0.0) continue;  // Above the horizon.
      const double range_m = ground.height_m / sine;
      const double answer = ground.lambert * sine + ground.rough * (1.0 - sine * sine);
      const double off = (range_m - at_m) / pulse_m;
      sum += std::exp(-0.5 * (z * z + off * off)) * answer / (range_m * range_m);
    }
    return sum;
  };
  // The wave has one peak, which a search by the golden section finds.
  double near_m = 0.8 * ground.range_m;
  double far_m = ground.range_m;
  const double golden = std::numbers::phi - 1.0;
  while (far_m - near_m > 1e-5) {
    const double a = far_m - golden * (far_m - near_m);
    const double b = near_m + golden * (far_m - near_m);
    (wave(a) > wave(b) ? far_m : near_m) = wave(a) > wave(b) ? b : a;
  }
  return ground.range_m - 0.5 * (near_m + far_m);
}

// Between 1 mm and 0.6 m before the ground on the axis.
TEST(PulseStretch, DrawsThePeakOfGrazedGroundToWhereItsPulsesPileUp) {
  for (const double divergence_mrad : {1.5, 3.0}) {
    const BeamSpec beam{.divergence_mrad = {divergence_mrad, divergence_mrad}};
    for (const Ground& ground :
         {Ground{2.0, 40.0}, Ground{2.0, 60.0, 0.7, 0.2}, Ground{2.0, 100.0},
          Ground{4.5, 40.0, 0.7, 0.2}, Ground{4.5, 80.0}, Ground{4.5, 150.0, 0.7, 0.2}}) {
      const double sine = ground.height_m / ground.range_m;
      const double sigma_rad = VerticalSigma_rad(beam);
      const auto tiles = Spread(
          {{std::sqrt(1.0 - sine * sine), 0, -sine}, {0, 0, 1}, ground.range_m, 0.0, sigma_rad});
      DetectTile& tile = tiles->detect;
      tile.true_range_m[0] = static_cast<float>(ground.range_m);
      tile.diffuse_a[0] = static_cast<float>(ground.lambert);
      tile.diffuse_b[0] = static_cast<float>(ground.rough);
      baseline::ApplyPulseStretch(tile, {static_cast<float>(PulseSigma_m(beam)), true, true});
      // The next order of the expansion and the rounding of float32 take 0.2 mm.
      EXPECT_NEAR(static_cast<double>(-tile.peak_shift_m[0]), PeakBefore_m(ground, beam), 2e-4)
          << ground.height_m << " " << ground.range_m;
    }
  }
}

// Values computed by docs/physics.md 3.4 apart from this code.
TEST(PulseStretch, FadesGrazedGround) {
  struct Row {
    double height_m, range_m, share;
  };
  for (const Row& row : {Row{2.0, 20, .974},
                         {2.0, 50, .562},
                         {2.0, 80, .256},
                         {2.0, 100, .167},
                         {3.5, 20, .991},
                         {3.5, 50, .766},
                         {3.5, 80, .421},
                         {3.5, 100, .285}}) {
    const BeamSpec beam{.divergence_mrad = {1.5, 1.5}, .pulse_length_ns = 5.0};
    const double sine = row.height_m / row.range_m;
    const Slant slant{{std::sqrt(1.0 - sine * sine), 0, -sine},
                      {0, 0, 1},
                      row.range_m,
                      HorizontalSigma_rad(beam),
                      VerticalSigma_rad(beam)};
    EXPECT_NEAR(StretchOf(slant, beam), row.share, 0.001) << row.height_m << " " << row.range_m;
  }
}

}  // namespace
}  // namespace railcast
