#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/median.h"
#include "core/track/track_search.h"

namespace railcast {
namespace {

constexpr double kBin_m = 0.5;

/// What is seen in half a metre of track.
struct Bin {
  bool has_bed{};                                 ///< Ground between the rails.
  std::array<bool, 2> has_head{};                 ///< Left and right.
  std::array<std::vector<double>, 4> beside_m{};  ///< Heights on both sides of the heads.
};

/// How high ridges are over the ground, in m.
struct RiseLimits {
  double least{}, most{};
};

RiseLimits RiseOfRails(double apart_m) {
  // Rails of narrow lines rise 75 mm over the bed, those of standard gauge 149 mm and more (49E1),
  // less the ballast.
  return {apart_m < 1.3 ? 0.06 : 0.11, 0.35};
}

}  // namespace

std::string WhyNoRails(const std::vector<Vector3>& places_m,
                       double apart_m,
                       double scatter_m,
                       FoundTrack& track) {
  constexpr std::size_t kFewestPoints = 12;
  constexpr int kFewestBins = 4;
  constexpr double kLeastLength_m = 2.5;
  const RiseLimits rise_m = RiseOfRails(apart_m);
  std::map<int, Bin> bins;
  std::array<std::size_t, 2> on_top{};
  std::array<std::size_t, 2> beside_top{};
  std::array<std::vector<double>, 4> ground_m;
  for (const Vector3& place_m : places_m) {
    Bin& bin = bins[static_cast<int>(std::floor(place_m.x() / kBin_m))];
    const std::size_t head = place_m.y() > 0.0 ? 0 : 1;
    const double off_m = place_m.y() - std::copysign(0.5 * apart_m, place_m.y());
    const double away_m = std::abs(off_m);
    const double z_m = place_m.z();
    if (std::abs(place_m.y()) < 0.5 * apart_m - 0.1 && z_m < -0.04 && z_m > -0.5)
      bin.has_bed = true;
    if (z_m > -std::max(0.02, 2.0 * scatter_m) && z_m < 2.0 * scatter_m + 0.01) {
      if (away_m < 0.036) ++on_top[head];
      if (away_m < 0.06) bin.has_head[head] = true;
    }
    if (away_m > 0.047 && away_m < 0.083 && std::abs(z_m) < 0.05) ++beside_top[head];
    if (away_m > 0.09 && away_m < 0.38) {
      const std::size_t side = 2 * head + (off_m > 0.0 ? 0 : 1);
      bin.beside_m[side].push_back(z_m);
    }
  }
  int num_both = 0;
  int num_seen = 0;
  std::array<int, 2> num_head{};
  std::array<int, 4> num_low{};
  std::array<int, 4> num_high{};
  bool is_first = true;
  for (auto& [number, bin] : bins) {
    const bool has_any = bin.has_head[0] || bin.has_head[1];
    if (bin.has_head[0] && bin.has_head[1]) {
      ++num_both;
      if (is_first) track.first_m = number * kBin_m;
      is_first = false;
      track.last_m = (number + 1) * kBin_m;
    }
    if (!is_first && (bin.has_bed || has_any)) ++num_seen;
    for (std::size_t head = 0; head < 2; ++head) num_head[head] += bin.has_head[head] ? 1 : 0;
    for (std::size_t side = 0; side < 4; ++side) {
      if (bin.beside_m[side].size() < 2 || !bin.has_head[side / 2]) continue;
      const double height_m = MedianOf(bin.beside_m[side]);
      ++(height_m < -0.5 * rise_m.least ? num_low : num_high)[side];
      ground_m[side].push_back(height_m);
    }
  }
  // Far along, heads are seen here and there; up to their end they must be where the bed is.
  int num_bed = 0;
  for (const auto& [number, bin] : bins) {
    const double x_m = (number + 0.5) * kBin_m;
    if (x_m > track.first_m && x_m < track.last_m && bin.has_bed) ++num_bed;
  }
  track.share = num_bed == 0 ? 0.0 : std::min(1.0, static_cast<double>(num_both) / num_bed);
  if (std::min(on_top[0], on_top[1]) < kFewestPoints ||
      std::min(num_head[0], num_head[1]) < kFewestBins || num_both < 2 ||
      track.last_m - track.first_m < kLeastLength_m) {
    return "its ridges have too few points";
  }
  if (track.share < 0.3) return "its ridges are not seen where the bed between them is";
  for (std::size_t side = 0; side < 4; ++side) {
    const int num = num_low[side] + num_high[side];
    if (num_low[side] >= 3 && num_low[side] >= 0.6 * num) continue;
    // The shadow of a head may hide one side of it.
    const std::size_t other = side ^ 1U;
    const int num_other = num_low[other] + num_high[other];
    if (num < 3 && num_other >= 3) continue;
    return "the ground is not lower on both sides of its ridges";
  }
  for (std::size_t head = 0; head < 2; ++head) {
    std::vector<double> both_m = ground_m[2 * head];
    both_m.insert(both_m.end(), ground_m[2 * head + 1].begin(), ground_m[2 * head + 1].end());
    if (both_m.empty()) return "no ground is seen beside its ridges";
    const double height_m = -MedianOf(both_m);
    if (height_m < rise_m.least || height_m > rise_m.most)
      return "its ridges are not a rail's height above the ground";
    if (static_cast<double>(beside_top[head]) > 0.35 * static_cast<double>(on_top[head]))
      return "its ridges are wider than a rail's head";
  }
  return {};
}

}  // namespace railcast
