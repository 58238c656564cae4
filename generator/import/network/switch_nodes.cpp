#include "generator/import/network/switch_nodes.h"

#include <algorithm>

namespace railcast {

std::vector<SwitchNode> FindSwitches(const RailMap& map,
                                     const LinePlaces& places,
                                     double farthest_m) {
  std::vector<std::size_t> num_ways(map.nodes.size());
  for (const MapWay& way : map.ways) {
    for (std::size_t i = 0; i < way.nodes.size(); ++i) {
      num_ways[way.nodes[i]] += i == 0 || i + 1 == way.nodes.size() ? 1 : 2;
    }
  }
  std::vector<SwitchNode> switches;
  for (std::size_t i = 0; i < map.nodes.size(); ++i) {
    const bool is_tagged = num_ways[i] > 0 && TagOf(map.nodes[i].tags, "railway") == "switch";
    if (num_ways[i] < 3 && !is_tagged) continue;
    const auto place = places.Of(map.nodes[i].place_m, farthest_m);
    constexpr double kAtEnd_m = 1.0;
    if (!place || place->s_m < kAtEnd_m || place->s_m > places.length_m() - kAtEnd_m) continue;
    switches.push_back({{place->s_m, place->d_m}, num_ways[i]});
  }
  std::ranges::stable_sort(switches, {}, [](const SwitchNode& node) { return node.place_m.x(); });
  return switches;
}

}  // namespace railcast
