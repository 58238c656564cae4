#include "generator/import/lines/sharp_arcs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include "core/base/text.h"
#include "core/rail/base/chainage_range.h"
#include "generator/import/fit/plan_model.h"
#include "railcast/world_spec.h"

namespace railcast {
namespace {

/// The part of a line from one node to another one.
TrackLine PartOfLine(const TrackLine& line, std::size_t first, std::size_t last) {
  const auto at = [](const auto& list, std::size_t i) {
    return list.begin() + static_cast<std::ptrdiff_t>(i);
  };
  return {{},
          {at(line.nodes, first), at(line.nodes, last + 1)},
          {at(line.ways, first), at(line.ways, last)}};
}

}  // namespace

std::optional<LineBesideArcs> CutAtSharpArcs(const RailMap& map,
                                             const TrackLine& track,
                                             const ImportedLine& line) {
  const double least_m = VehicleSpec().pivot_distance_m;
  LineBesideArcs cut;
  std::vector<ChainageRange> arcs;
  double s_m = 0.0;
  for (const auto& element : std::get<AlignmentElementsSpec>(line.alignment.course).elements) {
    const double begin_s_m = s_m;
    s_m += element.length_m;
    if (!element.radius_m || std::abs(*element.radius_m) >= least_m) continue;
    arcs.push_back({begin_s_m, s_m});
    cut.reason += (cut.reason.empty() ? "arc of " : ", of ") +
                  NumberText(RoundedTo(std::abs(*element.radius_m), 10.0)) + " m radius at " +
                  NumberText(std::round(begin_s_m)) + " m";
  }
  if (arcs.empty()) return std::nullopt;
  cut.reason += ": vehicles need " + NumberText(least_m) + " m";
  cut.cut_m = LengthOf_m(map, track);
  std::size_t first = 0;
  const auto end_part = [&](std::size_t behind) {
    if (behind < first + 2) return;
    cut.parts.push_back(PartOfLine(track, first, behind - 1));
    cut.parts.back().name = track.name + "-part-" + std::to_string(cut.parts.size());
    cut.cut_m -= LengthOf_m(map, cut.parts.back());
  };
  for (const ChainageRange& arc : arcs) {
    std::size_t behind = first;
    while (behind < track.nodes.size() && line.chainages_m[behind] < arc.begin_s_m) ++behind;
    end_part(behind);
    first = behind;
    while (first < track.nodes.size() && line.chainages_m[first] <= arc.end_s_m) ++first;
  }
  end_part(track.nodes.size());
  return cut;
}

}  // namespace railcast
