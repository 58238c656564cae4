#include "core/simulate/story_echoes.h"

#include <cstdint>
#include <limits>

namespace railcast {

void TellEchoes(const std::vector<Surface>& surfaces,
                const ReturnRule& rule,
                std::size_t beam,
                EchoTiles& echoes,
                FiringStory& story) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const auto returns = ReturnsOf(rule, echoes, beam);
  for (const auto& [tile, lane] : EchoesOf(echoes, beam)) {
    const bool is_clutter = tile.clutter[lane] != kNoClutter;
    story.echoes.push_back(
        {.label = is_clutter ? tile.clutter[lane] : surfaces[tile.surface[lane]].label,
         .true_range_m = tile.true_range_m[lane],
         .range_m = tile.range_m[lane],
         .power_ratio = tile.power_ratio[lane],
         .footprint_share = tile.surface[lane] != 0 ? tile.share[lane] : kNaN,
         .outcome = static_cast<Outcome>(tile.outcome[lane]),
         .slot = {}});
    for (std::uint32_t r = 0; r < returns.size(); ++r) {
      const bool is_this = &returns[r].tile == &tile && returns[r].lane == lane;
      if (is_this) story.echoes.back().slot = story.slot + r;
    }
  }
}

}  // namespace railcast
