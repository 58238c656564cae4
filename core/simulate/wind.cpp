#include "core/simulate/wind.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"

namespace railcast {
namespace {

constexpr double kTwoPi_rad = 2.0 * std::numbers::pi;
constexpr double kWidestTangent_rad = std::numbers::pi / 4.0;

double UnitOf(std::uint32_t word) {
  return static_cast<double>(UnitFloat(word));
}

/// The frequency f L / U below which lies that share of the variance.
double KaimalQuantile(double share) {
  return (std::pow(1.0 - share, -1.5) - 1.0) / 10.2;
}

double CosineOfTurns(double turns) {
  return std::cos(kTwoPi_rad * (turns - std::floor(turns)));
}

constexpr double kAirDensity_kg_per_m3 = 1.25;
constexpr double kWireDrag = 1.0;
constexpr double kOwnDamping = 0.01;

Vector3 InPlan(const WireSpan& span) {
  const Vector3 way_m = span.end_m - span.begin_m;
  return {way_m.x(), way_m.y(), 0.0};
}

double WindAcross_mps(const Wind& wind, const WireSpan& span) {
  return wind.speed_mps() * wind.downwind().dot(LeftOf(span));
}

}  // namespace

Wind::Wind(const Vector3& velocity_mps, std::uint64_t seed)
    : speed_mps_(velocity_mps.norm()), seed_(seed) {
  if (!blows()) return;
  downwind_ = velocity_mps / speed_mps_;
  const Vector3 aside = Vector3::UnitZ().cross(downwind_);
  for (std::size_t i = 0; i < kNumWaves; ++i) {
    const auto words = RandomWords(seed, RandomUse::kGusts, 0, static_cast<std::uint32_t>(i));
    const double share = (static_cast<double>(i) + UnitOf(words[0])) / kNumWaves * kSlowShare;
    const double turns_per_m = KaimalQuantile(share) / kLength_m;
    const double slant_rad = kWidestTangent_rad * (2.0 * UnitOf(words[1]) - 1.0);
    waves_[i] = {turns_per_m * (downwind_ + std::tan(slant_rad) * aside), turns_per_m * speed_mps_,
                 UnitOf(words[2])};
  }
}

double Wind::Gust(const Vector3& place_m, double time_s) const {
  double sum = 0.0;
  for (const Wave& wave : waves_) {
    sum += CosineOfTurns(wave.turns_per_m.dot(place_m) - wave.frequency_hz * time_s +
                         wave.phase_turns);
  }
  return std::sqrt(2.0 / kNumWaves) * sum;
}

double Wind::Resonance(double frequency_hz, double damping, double width_m) const {
  const double x = frequency_hz * kLength_m / speed_mps_;
  const double spectrum = 6.8 * x / std::pow(1.0 + 10.2 * x, 5.0 / 3.0);
  const double eta = 4.6 * width_m / kLength_m * x;
  const double whole =
      eta > 0.0 ? 1.0 / eta - (1.0 - std::exp(-2.0 * eta)) / (2.0 * eta * eta) : 1.0;
  return std::numbers::pi / (4.0 * damping) * spectrum * whole;
}

double Ringing(const std::array<std::uint32_t, 4>& words,
               double frequency_hz,
               double damping,
               double time_s) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double aside = (static_cast<double>(i) - 1.0) * std::sqrt(3.0) * damping;
    sum += CosineOfTurns(frequency_hz * (1.0 + aside) * time_s + UnitOf(words[i]));
  }
  return std::sqrt(2.0 / 3.0) * sum;
}

Vector3 LeftOf(const WireSpan& span) {
  return Vector3::UnitZ().cross(InPlan(span).normalized());
}

double BlowOffShare(const WireSpan& span, const Vector3& point_m) {
  const Vector3 way_m = InPlan(span);
  const double at = std::clamp((point_m - span.begin_m).dot(way_m) / way_m.squaredNorm(), 0.0, 1.0);
  return 4.0 * at * (1.0 - at);
}

double MeanSpanBlowOff_m(const Wind& wind, const WireSpan& span) {
  const double across_mps = WindAcross_mps(wind, span);
  const double load_n_per_m =
      0.5 * kAirDensity_kg_per_m3 * kWireDrag * span.width_m * across_mps * std::abs(across_mps);
  return load_n_per_m * InPlan(span).squaredNorm() / (8.0 * span.tension_n);
}

SpanGusts SpanGustsOf(const Wind& wind, const WireSpan& span) {
  const double length_m = InPlan(span).norm();
  SpanGusts gusts;
  gusts.frequency_hz = std::sqrt(span.tension_n / span.mass_kg_per_m) / (2.0 * length_m);
  const double drag_per_s = kAirDensity_kg_per_m3 * kWireDrag * span.width_m *
                            std::abs(WindAcross_mps(wind, span)) / span.mass_kg_per_m;
  gusts.damping = kOwnDamping + drag_per_s / (4.0 * std::numbers::pi * gusts.frequency_hz);
  const double covered = 1.0 / (1.0 + 0.9 * std::pow(length_m / Wind::kLength_m, 0.63));
  gusts.slow = 2.0 * Wind::kTurbulence * std::sqrt(Wind::kSlowShare * covered);
  gusts.ringing = 2.0 * Wind::kTurbulence *
                  std::sqrt(wind.Resonance(gusts.frequency_hz, gusts.damping, length_m));
  return gusts;
}

double SpanBlowOff_m(const Wind& wind, const WireSpan& span, double time_s) {
  if (!(span.tension_n > 0.0)) return 0.0;
  const SpanGusts gusts = SpanGustsOf(wind, span);
  const auto words = RandomWords(wind.seed(), RandomUse::kSpanSway, span.number, 0);
  const double gust = wind.Gust(0.5 * (span.begin_m + span.end_m), time_s);
  return MeanSpanBlowOff_m(wind, span) *
         (1.0 + gusts.slow * gust +
          gusts.ringing * Ringing(words, gusts.frequency_hz, gusts.damping, time_s));
}

double TreeFrequency_hz(double height_m) {
  constexpr double kDiameter_cm_per_m = 2.2;
  return 0.0766 + 3.1219 * kDiameter_cm_per_m / height_m;
}

double MeanTreeTip_m(double wind_mps, double height_m) {
  constexpr double kLeanAt10mps = 0.015;
  return kLeanAt10mps * height_m * std::pow(wind_mps / 10.0, kTreeDragExponent);
}

Vector3 TreeTip_m(const Wind& wind, const TreeInWind& tree, double time_s) {
  const double frequency_hz = TreeFrequency_hz(tree.height_m);
  const double resonance = wind.Resonance(frequency_hz, kTreeDamping, 0.0);
  const auto ringing = [&](std::uint32_t block) {
    const auto words =
        RandomWords(wind.seed(), RandomUse::kTreeSway, tree.chunk, tree.number, block);
    return Ringing(words, frequency_hz, kTreeDamping, time_s);
  };
  const double gust = std::sqrt(Wind::kSlowShare) * wind.Gust(tree.foot_world_m, time_s);
  const double along =
      1.0 + kTreeDragExponent * Wind::kTurbulence * (gust + std::sqrt(resonance) * ringing(0));
  const double across =
      kAcrossGusts * Wind::kTurbulence * std::sqrt(Wind::kSlowShare + resonance) * ringing(1);
  return MeanTreeTip_m(wind.speed_mps(), tree.height_m) *
         (along * wind.downwind() + across * Vector3::UnitZ().cross(wind.downwind()));
}

}  // namespace railcast
