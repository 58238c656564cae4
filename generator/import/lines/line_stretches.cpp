#include "generator/import/lines/line_stretches.h"

#include <algorithm>

namespace railcast {

std::vector<LineStretch> StretchesWhere(const RailMap& map,
                                        const TrackLine& line,
                                        std::span<const double> chainages_m,
                                        const std::function<bool(const MapTags&)>& has) {
  std::vector<LineStretch> stretches;
  bool goes_on = false;
  for (std::size_t i = 0; i < line.ways.size(); ++i) {
    const std::size_t way = line.ways[i];
    const bool is_on_it = has(map.ways[way].tags);
    if (is_on_it && !goes_on) stretches.push_back({chainages_m[i], chainages_m[i], way});
    // Feet of points that lie beside each other may change places.
    if (is_on_it) stretches.back().end_s_m = std::max(stretches.back().end_s_m, chainages_m[i + 1]);
    goes_on = is_on_it;
  }
  std::erase_if(stretches,
                [](const LineStretch& stretch) { return stretch.end_s_m <= stretch.begin_s_m; });
  return stretches;
}

}  // namespace railcast
