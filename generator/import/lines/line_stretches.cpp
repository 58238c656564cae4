#include "generator/import/lines/line_stretches.h"

#include <algorithm>

namespace railcast {

std::vector<LineStretch> WaysAlong(const TrackLine& line, std::span<const double> chainages_m) {
  std::vector<LineStretch> ways;
  for (std::size_t i = 0; i < line.ways.size(); ++i) {
    ways.push_back({chainages_m[i], chainages_m[i + 1], line.ways[i]});
  }
  return ways;
}

std::vector<LineStretch> StretchesWhere(const RailMap& map,
                                        std::span<const LineStretch> ways,
                                        const std::function<bool(const MapTags&)>& has) {
  std::vector<LineStretch> stretches;
  bool goes_on = false;
  for (const LineStretch& way : ways) {
    const bool is_on_it = has(map.ways[way.way].tags);
    if (is_on_it && !goes_on) stretches.push_back({way.begin_s_m, way.begin_s_m, way.way});
    // Feet of points that lie beside each other may change places.
    if (is_on_it) stretches.back().end_s_m = std::max(stretches.back().end_s_m, way.end_s_m);
    goes_on = is_on_it;
  }
  std::erase_if(stretches,
                [](const LineStretch& stretch) { return stretch.end_s_m <= stretch.begin_s_m; });
  return stretches;
}

std::vector<LineStretch> StretchesWhere(const RailMap& map,
                                        const TrackLine& line,
                                        std::span<const double> chainages_m,
                                        const std::function<bool(const MapTags&)>& has) {
  return StretchesWhere(map, WaysAlong(line, chainages_m), has);
}

}  // namespace railcast
