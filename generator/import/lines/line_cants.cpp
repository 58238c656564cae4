#include "generator/import/lines/line_cants.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "generator/import/fit/plan_model.h"
#include "railcast/alignment.h"

namespace railcast {
namespace {

/// 1 where a line turns left about a chainage, -1 where it turns right, 0 where it is straight. The
/// ramp of a cant may reach into the straight, so that some way before and behind counts, too.
double TurnOf(const Alignment& alignment, double s_m) {
  constexpr double kReach_m = 60.0;
  constexpr double kStraight_rad = 1e-6;
  const double turn_rad =
      alignment.At(s_m + kReach_m).heading_rad - alignment.At(s_m - kReach_m).heading_rad;
  if (std::abs(turn_rad) < kStraight_rad) return 0.0;
  return turn_rad > 0.0 ? 1.0 : -1.0;
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
  for (std::size_t i = 0; i < track.nodes.size(); ++i) {
    const std::optional<double>& cant_mm = map.nodes[track.nodes[i]].cant_mm;
    if (!cant_mm) continue;
    const double s_m = line.chainages_m[i];
    // An alignment's first entry is at 0.
    const ChainageValue entry{cants_mm.empty() ? 0.0 : RoundedTo(s_m, kSteps_per_m),
                              TurnOf(alignment, s_m) * *cant_mm};
    if (!cants_mm.empty() && !(entry.s_m > cants_mm.back().s_m)) continue;
    if (entry.s_m > last_s_m) continue;
    const std::size_t num = cants_mm.size();
    if (num >= 2 && IsBetween(cants_mm[num - 2], cants_mm[num - 1], entry)) cants_mm.pop_back();
    cants_mm.push_back(entry);
  }
  line.alignment.cants_mm = std::move(cants_mm);
}

}  // namespace railcast
