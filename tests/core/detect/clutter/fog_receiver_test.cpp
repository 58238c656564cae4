// The fog that the sensors see against a slow model of a receiver that has one noise: a waveform in
// steps of a ninth of its pulse, on which noise of the receiver's bandwidth decides both whether it
// rises above the threshold and where it is highest.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "core/detect/base/beam_optics.h"
#include "core/detect/clutter/fog_profile.h"
#include "tests/core/detect/facing_beams.h"

namespace railcast {
namespace {

// Neighbours of one packet meet the same patches; packets are independent enough to count.
constexpr std::uint32_t kPacket = 16;

FacingBeams ThroughManyPatches(std::uint32_t num_firings) {
  FacingBeams beams;
  beams.num_firings = num_firings;
  beams.origin_y_m = [](std::uint32_t firing) {
    return 40.0F * static_cast<float>(firing / kPacket);
  };
  return beams;
}

/// The fog's point in one beam.
struct FogPoint {
  double range_m{}, power_ratio{};
};

class SlowReceiver {
 public:
  explicit SlowReceiver(const DetectorSpec& spec)
      : spec_(spec), step_m_(PulseSigma_m(spec.beam) / kStepsPerSigma) {
    for (int i = 0; i < static_cast<int>(kReach_m / step_m_); ++i) {
      power_.push_back(MeanFogRatio(spec, i * step_m_));
    }
    // White noise through a receiver that answers a point with its pulse.
    double squares = 0.0;
    for (int i = -5 * kStepsPerSigma; i <= 5 * kStepsPerSigma; ++i) {
      const double z = static_cast<double>(i) / kStepsPerSigma;
      pulse_.push_back(std::exp(-0.5 * z * z));
      squares += pulse_.back() * pulse_.back();
    }
    for (double& value : pulse_) value /= std::sqrt(squares) * spec.receiver.snr_at_threshold;
  }

  /// The highest point of the waveform, if it reaches the threshold.
  [[nodiscard]] std::optional<FogPoint> Look(const std::vector<double>& density,
                                             std::mt19937_64& random) const {
    std::normal_distribution<double> normal;
    std::vector<double> white(power_.size() + pulse_.size());
    for (double& value : white) value = normal(random);
    std::optional<FogPoint> highest;
    for (std::size_t i = 0; i < power_.size(); ++i) {
      const double range_m = static_cast<double>(i) * step_m_;
      double amplitude = power_[i] * density[i];
      for (std::size_t k = 0; k < pulse_.size(); ++k) amplitude += pulse_[k] * white[i + k];
      if (range_m < spec_.range_min_m || amplitude < 1.0) continue;
      if (!highest || amplitude > highest->power_ratio) highest = {range_m, amplitude};
    }
    return highest;
  }

  /// The density of the droplets along a beam from the place `y_m`.
  [[nodiscard]] std::vector<double> DensityFrom(double y_m, const FogWaves& waves) const {
    const double sigma = spec_.weather.fog_variation;
    std::vector<double> density;
    for (std::size_t i = 0; i < power_.size(); ++i) {
      double field = 0.0;
      for (std::size_t w = 0; w < kNumFogWaves; ++w) {
        const double turns = static_cast<double>(waves.x[w]) * static_cast<double>(i) * step_m_ +
                             static_cast<double>(waves.y[w]) * y_m +
                             static_cast<double>(waves.phase[w]);
        field += static_cast<double>(waves.amplitude[w]) * std::cos(2.0 * std::numbers::pi * turns);
      }
      density.push_back(std::exp(sigma * field - 0.5 * sigma * sigma));
    }
    return density;
  }

 private:
  static constexpr int kStepsPerSigma = 4;
  static constexpr double kReach_m = 35.0;

  DetectorSpec spec_;
  double step_m_;
  std::vector<double> power_, pulse_;
};

/// What is seen of the fog in beams that meet nothing else.
struct Seen {
  double share{}, mean_m{}, sigma_m{}, mean_ratio{};

  Seen(const std::vector<FogPoint>& points, double num_beams) {
    const auto num = static_cast<double>(points.size());
    share = num / num_beams;
    double squares_m2 = 0.0;
    for (const FogPoint& point : points) {
      mean_m += point.range_m / num;
      squares_m2 += point.range_m * point.range_m / num;
      mean_ratio += point.power_ratio / num;
    }
    sigma_m = std::sqrt(squares_m2 - mean_m * mean_m);
  }
};

Seen SeenBySlowReceiver(const DetectorSpec& spec, std::uint32_t num_beams) {
  const SlowReceiver receiver(spec);
  const FogWaves waves = FogPatches(spec.air_seed).WavesAt(Transform::Identity(), 0.0);
  std::mt19937_64 random(7);
  std::vector<FogPoint> points;
  std::vector<double> density;
  for (std::uint32_t firing = 0; firing < num_beams; ++firing) {
    // Every fourth beam of those that are looked at below, over the same patches.
    if (firing % 4 == 0) density = receiver.DensityFrom(40.0 * (firing / 4), waves);
    if (const auto point = receiver.Look(density, random)) points.push_back(*point);
  }
  return {points, static_cast<double>(num_beams)};
}

Seen SeenByDetector(const DetectorSpec& spec, std::uint32_t num_beams) {
  std::vector<FogPoint> points;
  for (const FacingEcho& echo : ClutterOf(DetectFacing(spec, ThroughManyPatches(num_beams)))) {
    if (echo.outcome != Outcome::kClutter) continue;
    points.push_back(
        {static_cast<double>(echo.true_range_m), static_cast<double>(echo.power_ratio)});
  }
  return {points, static_cast<double>(num_beams)};
}

struct Sensor {
  const char* name{};
  double range_at_10_percent_m{}, range_min_m{};
};

// All ranges on 10 % of the sensors that are shipped.
constexpr Sensor kSensors[] = {{"qt128", 20.0, 0.05},    {"vlp16", 50.0, 0.5},
                               {"xt32", 80.0, 0.05},     {"vlp32c", 90.0, 0.5},
                               {"pandar64", 200.0, 0.3}, {"vls128", 220.0, 0.5}};

TEST(FogReceiver, SeesTheFogThatAReceiverOfOneNoiseSees) {
  constexpr std::uint32_t kNumSlow = 2048;
  constexpr std::uint32_t kNumFast = 4 * kNumSlow;
  for (const Sensor& sensor : kSensors) {
    for (const double visibility_m : {50.0, 100.0, 200.0, 300.0, 400.0}) {
      SCOPED_TRACE(sensor.name + (" at " + std::to_string(visibility_m)));
      DetectorSpec spec{
          .seed = 5,
          .air_seed = 8,
          .range_min_m = sensor.range_min_m,
          .effects = {.detection = true, .detection_probability = true, .fog_echo = true}};
      spec.weather.visibility_m = visibility_m;
      spec.receiver.range_at_10_percent_m = sensor.range_at_10_percent_m;
      spec.clutter_labels.fog = 25;
      const Seen slow = SeenBySlowReceiver(spec, kNumSlow);
      const Seen fast = SeenByDetector(spec, kNumFast);
      RecordProperty(sensor.name + ("_" + std::to_string(std::lround(visibility_m))),
                     std::to_string(fast.share) + "/" + std::to_string(slow.share));
      // The share of either varies by that of its draws; steps that are not infinitely short and
      // what lies below kLeastFogRatio take at most 0.01 away.
      const double sigma = std::sqrt(slow.share * (1.0 - slow.share) * (1.0 / kNumSlow));
      EXPECT_NEAR(fast.share, slow.share, 4.0 * sigma + 0.01);
      if (slow.share < 0.05) continue;
      const double num = slow.share * kNumSlow;
      EXPECT_NEAR(fast.mean_m, slow.mean_m, 4.5 * slow.sigma_m / std::sqrt(num) + 0.1);
      EXPECT_NEAR(fast.sigma_m, slow.sigma_m, 0.2 * slow.sigma_m);
      EXPECT_NEAR(fast.mean_ratio, slow.mean_ratio, 0.02);
    }
  }
}

}  // namespace
}  // namespace railcast
