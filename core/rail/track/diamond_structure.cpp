#include <algorithm>
#include <cmath>

#include "core/rail/base/rail_section.h"
#include "core/rail/track/cross_section.h"
#include "core/rail/track/switch_parts.h"
#include "core/rail/track/turnout_structure.h"

namespace railcast {
namespace {

bool IsNearDiamond(const ChunkContext& context, const DiamondSite& site) {
  return site.s_m > context.begin_s_m - kDiamondReach_m &&
         site.s_m < context.end_s_m + kDiamondReach_m;
}

}  // namespace

void AddDiamonds(const ChunkContext& context, Chunk& chunk) {
  for (const LaidDiamond& diamond : context.diamonds) {
    const DiamondSite& site = diamond.site;
    if (!IsNearDiamond(context, site)) continue;
    const DiamondCourses courses{site, context.tracks[site.first], context.tracks[site.second]};
    const PairOfTracks pair{site.first, site.second};
    for (const TurnoutRail& rail : RailsOf(courses)) AddRailPiece(context, pair, rail, chunk);
    for (const CheckRail& rail : CheckRailsOf(courses)) AddCheckRail(context, pair, rail, chunk);
  }
}

}  // namespace railcast
