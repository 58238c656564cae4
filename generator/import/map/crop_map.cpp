#include "generator/import/map/crop_map.h"

#include <limits>

namespace railcast {
namespace {

constexpr std::size_t kNotKept = std::numeric_limits<std::size_t>::max();

/// Appends the runs of a way's points that are kept.
void AppendRuns(const MapWay& way, const std::vector<std::size_t>& kept, RailMap& cropped) {
  MapWay run{way.id, {}, way.tags};
  const auto end_run = [&] {
    if (run.nodes.size() >= 2) cropped.ways.push_back(run);
    run.nodes.clear();
  };
  for (const std::size_t node : way.nodes) {
    if (kept[node] == kNotKept) {
      end_run();
    } else {
      run.nodes.push_back(kept[node]);
    }
  }
  end_run();
}

}  // namespace

RailMap CropMap(const RailMap& map, const Eigen::AlignedBox2d& within_deg) {
  RailMap cropped;
  cropped.attribution = map.attribution;
  std::vector<std::size_t> kept(map.nodes.size(), kNotKept);
  for (std::size_t i = 0; i < map.nodes.size(); ++i) {
    if (!within_deg.contains(map.nodes[i].geographic_deg)) continue;
    kept[i] = cropped.nodes.size();
    cropped.nodes.push_back(map.nodes[i]);
  }
  for (const MapWay& way : map.ways) AppendRuns(way, kept, cropped);
  for (const MapThing& thing : map.things) {
    const bool is_inside = std::ranges::all_of(thing.geographic_deg, [&](const auto& place_deg) {
      return within_deg.contains(place_deg);
    });
    if (is_inside) cropped.things.push_back(thing);
  }
  return cropped;
}

}  // namespace railcast
