#include "core/detect/beam/sub_ray_pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace railcast {
namespace {

// The radius, in standard deviations, outside of which this share of a Gaussian beam lies (Rayleigh
// distribution).
double RadiusOutsideOf(double share) {
  return std::sqrt(-2.0 * std::log(share));
}

struct Place {
  double h, v;
};

// Vogel's spiral of `count` places that fill the whole beam, and each of which represents 1 / count
// of it. `skipped` of them at the centre belong to something else.
std::vector<Place> Spiral(std::size_t count, double skipped) {
  const double golden_rad = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Place> places;
  for (std::size_t k = 0; k < count; ++k) {
    const double share_inside =
        (static_cast<double>(k) + skipped + 0.5) / (static_cast<double>(count) + skipped);
    const double radius = RadiusOutsideOf(1.0 - share_inside);
    const double angle_rad = golden_rad * static_cast<double>(k);
    places.push_back({radius * std::cos(angle_rad), radius * std::sin(angle_rad)});
  }
  return places;
}

}  // namespace

SubRayPattern DenseSubRays(std::size_t count) {
  SubRayPattern pattern;
  const auto share = static_cast<float>(1.0 / static_cast<double>(count + 1));
  pattern.central_share = share;
  for (const Place& place : Spiral(count, 1.0)) {
    pattern.sub_rays.push_back({static_cast<float>(place.h), static_cast<float>(place.v), share});
  }
  return pattern;
}

// Adds places, neighbours one after another: a kernel that tests vectors of sub-rays leaves those
// out that lie beside a surface. A third of the places, the innermost, come first, and then the
// ring around them.
void AddNeighbours(std::vector<Place> places, BeamSubRays& all) {
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return std::hypot(a.h, a.v) < std::hypot(b.h, b.v);
  });
  const auto by_angle = [](const Place& a, const Place& b) {
    return std::atan2(a.v, a.h) < std::atan2(b.v, b.h);
  };
  const auto inner = static_cast<std::ptrdiff_t>(places.size() / 3);
  std::sort(places.begin(), places.begin() + inner, by_angle);
  std::sort(places.begin() + inner, places.end(), by_angle);
  for (const Place& place : places) {
    const std::size_t i = all.num++;
    all.h[i] = static_cast<float>(place.h);
    all.v[i] = static_cast<float>(place.v);
    all.largest_offset = std::max(all.largest_offset, std::hypot(all.h[i], all.v[i]));
  }
}

const BeamSubRays& SubRaysOfBeam() {
  static const BeamSubRays sub_rays = [] {
    BeamSubRays all = SubRaysOfCrowd();
    AddNeighbours(Spiral(kNumSubRays - kNumCrowdedSubRays, 0.0), all);
    return all;
  }();
  return sub_rays;
}

const BeamSubRays& SubRaysOfCrowd() {
  static const BeamSubRays sub_rays = [] {
    BeamSubRays all{};
    AddNeighbours(Spiral(kNumCrowdedSubRays, 0.0), all);
    return all;
  }();
  return sub_rays;
}

const BeamSubRays& SubRaysOfCloserLook() {
  static const BeamSubRays sub_rays = [] {
    BeamSubRays all{};
    AddNeighbours(Spiral(kNumCloserSubRays, 0.0), all);
    return all;
  }();
  return sub_rays;
}

SubRayAim AimOfFiring(const BeamSubRays& pattern, const PatternTurns& turns, std::size_t lane) {
  // A little wider than the pattern, because its directions are rounded.
  constexpr float kMargin = 1.0001F;
  return {pattern.num,        pattern.h,       pattern.v, kMargin * pattern.largest_offset,
          turns.cosine[lane], turns.sine[lane]};
}

}  // namespace railcast
