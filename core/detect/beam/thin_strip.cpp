#include "core/detect/beam/facet_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/SpecialFunctions>

#include "core/detect/base/normal_table.h"

namespace railcast {
namespace {

// Strips with more of the beam are hardly better sampled than by patterns that cover it.
constexpr float kMostShare = 0.3F;
// A surface that a single sub-ray meets this far from the middle is taken for an edge that reaches
// into the beam from outside.
constexpr float kOutside = 1.5F;
// By so much, one place may lie beside the edge of such a surface for its direction.
constexpr float kTiltOutside = 0.8F;
// Places of the profile that count lie this far from its middle.
constexpr float kFarAlong = 3.0F;
constexpr float kFarthest = 4.5F;
// Places as near to a side as this part of the width are at the side.
constexpr float kAtSide = 0.02F;

/// The place in the profile with this probability below it.
double QuantileOf(double probability) {
  return Eigen::numext::ndtri(probability);
}

/// A sub-ray's place in a strip: along it as a place in the profile, and across it in 0..1.
struct StripPlace {
  float along{}, across{};
};

// The places of all sets: lattices of the golden ratio, whose projection across the strip is even
// however many sets there are (Kronecker sequence).
std::array<StripPlace, kNumStripSets * kNumSubRays> MakeLattice() {
  std::array<StripPlace, kNumStripSets * kNumSubRays> places{};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t set = i / kNumSubRays;
    const std::size_t k = i % kNumSubRays;
    const double shift = (static_cast<double>(set) + 0.5) / kNumStripSets;
    places[i] = {
        static_cast<float>(QuantileOf((static_cast<double>(k) + shift) / kNumSubRays)),
        static_cast<float>(std::fmod((static_cast<double>(i) + 0.5) * std::numbers::phi, 1.0))};
  }
  return places;
}

}  // namespace

float ThinStrip::Share() const {
  return static_cast<float>(NormalShare(begin, end));
}

bool ThinStrip::IsAtSide(const BeamPlace& place) const {
  const float aside = Aside(place);
  const float near = kAtSide * (end - begin);
  return (aside < begin + near && begin > -kFarAlong) || (aside > end - near && end < kFarAlong);
}

std::optional<ThinStrip> FitStrip(std::span<const BeamPlace> places, float share) {
  const bool is_single = places.size() == 1;
  if (places.empty() || (is_single && std::hypot(places[0].h, places[0].v) < kOutside)) {
    return std::nullopt;
  }
  const auto num = static_cast<float>(places.size());
  BeamPlace mean;
  for (const BeamPlace& place : places) {
    mean.h += place.h / num;
    mean.v += place.v / num;
  }
  float hh = 0.0F, hv = 0.0F, vv = 0.0F;
  for (const BeamPlace& place : places) {
    const float h = place.h - mean.h;
    const float v = place.v - mean.v;
    hh += h * h;
    hv += h * v;
    vv += v * v;
  }
  const float angle_rad =
      is_single ? std::atan2(mean.h, -mean.v) : 0.5F * std::atan2(2.0F * hv, hh - vv);
  ThinStrip strip;
  strip.direction = {std::cos(angle_rad), std::sin(angle_rad)};
  const float middle = strip.Aside(mean);
  float least = middle, most = middle;
  for (const BeamPlace& place : places) {
    least = std::min(least, strip.Aside(place));
    most = std::max(most, strip.Aside(place));
  }
  // By chance, fewer sub-rays than its share may meet the surface.
  const float most_share = share * (1.0F + (2.0F * std::sqrt(num) + 1.0F) / num);
  if (std::fabs(middle) > kOutside) {
    // What reaches into the beam from outside, or lies there.
    const auto edge = static_cast<float>(-QuantileOf(most_share));
    const float margin = kTiltOutside / std::sqrt(num);
    strip.begin = middle > 0.0F ? std::min(least, edge) - margin : -kFarthest;
    strip.end = middle > 0.0F ? kFarthest : std::max(most, -edge) + margin;
  } else {
    // The places may lie on the same or on opposite sides of the surface's middle, so that the line
    // may be shifted and turned.
    const float half_width = 0.5F * most_share / static_cast<float>(NormalDensity(middle));
    const float length2 = strip.direction.h * (strip.direction.h * hh + strip.direction.v * hv) +
                          strip.direction.v * (strip.direction.h * hv + strip.direction.v * vv);
    const float turn = kFarAlong * std::sqrt(num / length2);
    const float margin = half_width * (1.0F + (1.0F + turn) / std::sqrt(num));
    strip.begin = std::max(least - margin, -kFarthest);
    strip.end = std::min(most + margin, kFarthest);
  }
  if (!(strip.Share() < kMostShare)) return std::nullopt;
  return strip;
}

BeamSubRays SubRaysIn(const ThinStrip& strip, std::size_t first_set, std::size_t num_sets) {
  static const auto lattice = MakeLattice();
  // The profile's lower side has the exact probabilities.
  const float sign = strip.begin + strip.end > 0.0F ? -1.0F : 1.0F;
  const double from = sign < 0.0F ? -strip.end : strip.begin;
  const double to = sign < 0.0F ? -strip.begin : strip.end;
  const auto first = static_cast<float>(NormalShare(-kNormalReach, from));
  const auto share = static_cast<float>(NormalShare(from, to));
  BeamSubRays rays;
  rays.num = num_sets * kNumSubRays;
  float largest2 = 0.0F;
  for (std::size_t i = 0; i < rays.num; ++i) {
    const StripPlace& place = lattice[first_set * kNumSubRays + i];
    const float aside = sign * Eigen::numext::ndtri(first + place.across * share);
    rays.h[i] = strip.direction.h * place.along - strip.direction.v * aside;
    rays.v[i] = strip.direction.v * place.along + strip.direction.h * aside;
    largest2 = std::max(largest2, rays.h[i] * rays.h[i] + rays.v[i] * rays.v[i]);
  }
  rays.largest_offset = std::sqrt(largest2);
  return rays;
}

}  // namespace railcast
