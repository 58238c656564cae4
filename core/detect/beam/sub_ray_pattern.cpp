#include "core/detect/beam/sub_ray_pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"

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

PatternTurn TurnOfPattern(std::uint64_t seed, std::uint32_t frame, std::uint32_t firing) {
  const auto words = RandomWords(seed, RandomUse::kFootprint, frame, firing);
  const float turn_rad = 2.0F * std::numbers::pi_v<float> * UnitFloat(words[0]);
  return {std::cos(turn_rad), std::sin(turn_rad)};
}

SubRayPattern DenseSubRays(std::size_t count) {
  SubRayPattern pattern;
  const auto share = static_cast<float>(1.0 / static_cast<double>(count + 1));
  pattern.central_share = share;
  for (const Place& place : Spiral(count, 1.0)) {
    pattern.sub_rays.push_back({static_cast<float>(place.h), static_cast<float>(place.v), share});
  }
  return pattern;
}

// Sorts places such that equal portions of them, one after another, are the groups of neighbours.
void SortIntoGroups(std::vector<Place>& places) {
  // A quarter of the places, the innermost, make two groups: halves of a disc. The others are the
  // sectors of a ring.
  const auto inner = static_cast<std::ptrdiff_t>(places.size() / 4);
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return std::hypot(a.h, a.v) < std::hypot(b.h, b.v);
  });
  const auto by_angle = [](const Place& a, const Place& b) {
    return std::atan2(a.v, a.h) < std::atan2(b.v, b.h);
  };
  std::sort(places.begin(), places.begin() + inner, by_angle);
  std::sort(places.begin() + inner, places.end(), by_angle);
}

// Stores places from `first` on, so that those of a group are kNumSubRayGroups apart.
void StoreInGroups(std::vector<Place> places, std::size_t first, BeamSubRays& all) {
  SortIntoGroups(places);
  const std::size_t num_in_group = places.size() / kNumSubRayGroups;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::size_t group = k / num_in_group;
    const std::size_t i = first + k % num_in_group * kNumSubRayGroups + group;
    all.h[i] = static_cast<float>(places[k].h);
    all.v[i] = static_cast<float>(places[k].v);
    all.largest_offset = std::max(all.largest_offset, std::hypot(all.h[i], all.v[i]));
  }
}

const BeamSubRays& SubRaysOfBeam() {
  static const BeamSubRays sub_rays = [] {
    BeamSubRays all{};
    StoreInGroups(Spiral(kNumCrowdedSubRays, 0.0), 0, all);
    StoreInGroups(Spiral(kNumSubRays - kNumCrowdedSubRays, 0.0), kNumCrowdedSubRays, all);
    return all;
  }();
  return sub_rays;
}

const std::array<BeamSubRays, kNumCloserSets>& SubRaysOfCloserLook() {
  static const auto sets = [] {
    std::array<std::vector<Place>, kNumCloserSets> places;
    const std::vector<Place> spiral = Spiral(kNumCloserSets * kNumSubRays, 0.0);
    for (std::size_t k = 0; k < spiral.size(); ++k) places[k % kNumCloserSets].push_back(spiral[k]);
    std::array<BeamSubRays, kNumCloserSets> all{};
    for (std::size_t set = 0; set < kNumCloserSets; ++set) {
      StoreInGroups(places[set], 0, all[set]);
    }
    return all;
  }();
  return sets;
}

SubRayAim AimOfFiring(const BeamSubRays& pattern,
                      std::uint64_t seed,
                      std::uint32_t frame,
                      std::uint32_t firing) {
  const PatternTurn turn = TurnOfPattern(seed, frame, firing);
  // A little wider than the pattern, because its directions are rounded.
  constexpr float kMargin = 1.0001F;
  return {pattern.h, pattern.v, kMargin * pattern.largest_offset, turn.cosine, turn.sine};
}

}  // namespace railcast
