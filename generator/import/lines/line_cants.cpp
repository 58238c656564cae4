#include "generator/import/lines/line_cants.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "generator/import/fit/plan_model.h"
#include "railcast/alignment.h"

namespace railcast {
namespace {

/// 1 where a line turns left, -1 where it turns right. On a straight, into which the ramp of a cant
/// may reach, that of the nearest curve; 0 if none is near.
double TurnOf(const Alignment& alignment, double s_m) {
  constexpr double kReach_m = 100.0;
  constexpr double kStep_m = 5.0;
  constexpr double kStraight_per_m = 1e-6;
  for (double away_m = 0.0; away_m <= kReach_m; away_m += kStep_m) {
    double sharpest_per_m = 0.0;
    for (const double at_s_m : {s_m - away_m, s_m + away_m}) {
      const double curvature_per_m = alignment.At(at_s_m).curvature_per_m;
      if (std::abs(curvature_per_m) > std::abs(sharpest_per_m)) sharpest_per_m = curvature_per_m;
    }
    if (std::abs(sharpest_per_m) > kStraight_per_m) return std::copysign(1.0, sharpest_per_m);
  }
  return 0.0;
}

/// Whether the middle one of three entries is where a line through the others is.
bool IsBetween(const ChainageValue& a, const ChainageValue& middle, const ChainageValue& b) {
  constexpr double kSame_mm = 0.05;
  const double share = (middle.s_m - a.s_m) / (b.s_m - a.s_m);
  return std::abs(a.value + share * (b.value - a.value) - middle.value) <= kSame_mm;
}

}  // namespace

void SetCants(const RailMap& map, const TrackLine& track, ImportedLine& line) {
  constexpr double kSteps_per_m = 10.0;
  constexpr double kNearest_m = 1.0 / kSteps_per_m;  // Entries, and the last one and the end.
  const Alignment alignment(line.alignment);
  const double last_s_m = alignment.length_m() - kNearest_m;
  std::vector<ChainageValue> cants_mm;
  const auto is_surveyed = [&](std::size_t node) { return map.nodes[node].cant_mm.has_value(); };
  if (std::ranges::none_of(track.nodes, is_surveyed)) return;
  for (std::size_t i = 0; i < track.nodes.size(); ++i) {
    const double cant_mm = map.nodes[track.nodes[i]].cant_mm.value_or(0.0);
    const double s_m = line.chainages_m[i];
    // An alignment's first entry is at 0.
    const ChainageValue entry{cants_mm.empty() ? 0.0 : RoundedTo(s_m, kSteps_per_m),
                              cant_mm == 0.0 ? 0.0 : TurnOf(alignment, s_m) * cant_mm};
    if (!cants_mm.empty() && !(entry.s_m > cants_mm.back().s_m)) continue;
    if (entry.s_m > last_s_m) continue;
    const std::size_t num = cants_mm.size();
    if (num >= 2 && IsBetween(cants_mm[num - 2], cants_mm[num - 1], entry)) cants_mm.pop_back();
    cants_mm.push_back(entry);
  }
  line.alignment.cants_mm = std::move(cants_mm);
}

}  // namespace railcast
