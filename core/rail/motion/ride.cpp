#include "core/rail/motion/ride.h"

#include <cmath>
#include <numbers>

#include "core/base/random.h"

namespace railcast {
namespace {

constexpr double kCorner_rad_per_m = 0.8246;     // Wc
constexpr double kLongWaves_rad_per_m = 0.0206;  // Wr
constexpr double kCant_rad_per_m = 0.4380;       // Ws
constexpr double kHalfTapeDistance_m = 0.75;     // b

constexpr double SquareOf(double value) {
  return value * value;
}

// Per unit of A_v or A_a.
double ShapeOf(double rad_per_m) {
  return SquareOf(kCorner_rad_per_m) / ((SquareOf(rad_per_m) + SquareOf(kLongWaves_rad_per_m)) *
                                        (SquareOf(rad_per_m) + SquareOf(kCorner_rad_per_m)));
}

using Complex = std::complex<double>;

constexpr double kFullTurn_rad = 2.0 * std::numbers::pi;

double PhaseOf(std::uint32_t word) {
  return kFullTurn_rad * 0x1p-32 * static_cast<double>(word);
}

}  // namespace

double TrackSpectrum::Vertical(double rad_per_m) const {
  return vertical_m_rad * ShapeOf(rad_per_m);
}

double TrackSpectrum::Lateral(double rad_per_m) const {
  return lateral_m_rad * ShapeOf(rad_per_m);
}

double TrackSpectrum::Cant(double rad_per_m) const {
  return vertical_m_rad / SquareOf(kHalfTapeDistance_m) * ShapeOf(rad_per_m) * SquareOf(rad_per_m) /
         (SquareOf(rad_per_m) + SquareOf(kCant_rad_per_m));
}

TrackSpectrum SpectrumOf(TrackQuality quality) {
  return quality == TrackQuality::kGood ? TrackSpectrum{4.032e-7, 2.119e-7}
                                        : TrackSpectrum{1.080e-6, 6.125e-7};
}

Complex Suspension::At(double at_hz) const {
  const double ratio = at_hz / frequency_hz;
  const Complex damped(0.0, 2.0 * damping * ratio);
  return (1.0 + damped) / (1.0 - ratio * ratio + damped);
}

double Suspension::LeftOfStep(double since_s) const {
  const double free_radps = kFullTurn_rad * frequency_hz;
  const double damped_radps = free_radps * std::sqrt(1.0 - SquareOf(damping));
  const double decay_per_s = damping * free_radps;
  const double turned_rad = damped_radps * since_s;
  return std::exp(-decay_per_s * since_s) *
         (std::cos(turned_rad) + decay_per_s / damped_radps * std::sin(turned_rad));
}

Ride::Ride(const RideSpec& spec, std::uint64_t seed, double pivot_distance_m)
    : pivot_distance_m_(pivot_distance_m) {
  const TrackSpectrum spectrum = SpectrumOf(spec.track_quality);
  const double ratio = std::pow(kLongestIrregularity_m / kShortestIrregularity_m, 1.0 / kNumWaves);
  double least_rad_per_m = kFullTurn_rad / kLongestIrregularity_m;
  for (std::size_t i = 0; i < kNumWaves; ++i) {
    // Each wave has the variance of a band; bands grow with their frequencies, so that no two waves
    // ever repeat together.
    const double most_rad_per_m = least_rad_per_m * ratio;
    RideWave& wave = waves_[i];
    wave.rad_per_m = std::sqrt(least_rad_per_m * most_rad_per_m);
    const double band = 2.0 / std::numbers::pi * (most_rad_per_m - least_rad_per_m);
    wave.amplitudes = {std::sqrt(band * spectrum.Vertical(wave.rad_per_m)),
                       std::sqrt(band * spectrum.Lateral(wave.rad_per_m)),
                       std::sqrt(band * spectrum.Cant(wave.rad_per_m))};
    const auto words =
        RandomWords(seed, RandomUse::kTrackIrregularity, 0, static_cast<std::uint32_t>(i));
    wave.phases_rad = {PhaseOf(words[0]), PhaseOf(words[1]), PhaseOf(words[2])};
    least_rad_per_m = most_rad_per_m;
  }
}

RideMotion Ride::At(double s_m, double speed_mps, bool runs_back, double sprung_mps2) const {
  // Phases are counted in the direction of travel, in which time passes.
  const double direction = runs_back ? -1.0 : 1.0;
  const double middle_s_m = s_m - direction * 0.5 * pivot_distance_m_;
  RideMotion motion;
  motion.pitch_rad = -sprung_mps2 * kAboveLinks_m /
                     SquareOf(kFullTurn_rad * kVertical.frequency_hz * 0.5 * pivot_distance_m_);
  for (const RideWave& wave : waves_) {
    const double frequency_hz = wave.rad_per_m * speed_mps / kFullTurn_rad;
    const double half_turn_rad = 0.5 * wave.rad_per_m * pivot_distance_m_;
    const double of_axles = std::cos(0.5 * wave.rad_per_m * kAxleDistance_m);
    const double mean = of_axles * std::cos(half_turn_rad);
    const Complex slope(0.0, of_axles * 2.0 * std::sin(half_turn_rad) / pivot_distance_m_);
    const auto at_middle = [&](std::size_t i) {
      const double phase_rad = direction * (wave.rad_per_m * middle_s_m + wave.phases_rad[i]);
      return std::polar(wave.amplitudes[i], phase_rad);
    };
    const Complex vertical_m = kVertical.At(frequency_hz) * at_middle(0);
    const Complex lateral_m = kLateral.At(frequency_hz) * at_middle(1);
    const Complex cant_rad = kRoll.At(frequency_hz) * at_middle(2);
    motion.vertical_m += mean * vertical_m.real();
    motion.lateral_m += direction * mean * lateral_m.real();
    motion.roll_rad += direction * mean * cant_rad.real();
    // The nose points downwards where the front pivot is below the rear one.
    motion.pitch_rad -= (slope * vertical_m).real();
    motion.yaw_rad += direction * (slope * lateral_m).real();
  }
  return motion;
}

Transform Ride::PerfectFromVehicle(const RideMotion& motion) const {
  const Vector3 middle_m(-0.5 * pivot_distance_m_, 0.0, 0.0);
  const Eigen::Matrix3d turn =
      RotationFromYawPitchRoll(motion.yaw_rad, motion.pitch_rad, motion.roll_rad);
  return MakeTransform(
      turn, middle_m + Vector3(0.0, motion.lateral_m, motion.vertical_m) - turn * middle_m);
}

}  // namespace railcast
