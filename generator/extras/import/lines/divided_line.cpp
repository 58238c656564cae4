#include "generator/extras/import/lines/divided_line.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>
#include <variant>

#include "core/base/text.h"
#include "core/rail/landform/landform.h"
#include "core/rail/line/track_course.h"
#include "generator/extras/import/fit/plan_model.h"
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

/// A place on a line between two of its nodes.
struct OnLine {
  Eigen::Vector2d place_m;
  Eigen::Vector2d ahead;
  double along_m{};
};

/// The ground needs this radius of the circle that touches the line at one place and meets it at
/// another, and the fitted line may be nearer to itself than the map's by a metre.
constexpr double kLeastRadius_m = (kFormationEdge_m + 0.5) / StripWidth::kShareOfRadius + 1.0;
/// Within such a circle, places are at most this far apart.
constexpr double kNear_m = 2.0 * kLeastRadius_m;
/// Nearer places are beside each other on the line itself: half of the smallest circle that a line
/// may have, and what points are off.
constexpr double kSameStretch_m = 45.0;
constexpr double kStep_m = 4.0;

std::vector<OnLine> PlacesOn(const RailMap& map, const TrackLine& line) {
  std::vector<OnLine> places;
  double along_m = 0.0;
  for (std::size_t i = 0; i + 1 < line.nodes.size(); ++i) {
    const Eigen::Vector2d& from_m = map.nodes[line.nodes[i]].place_m;
    const Eigen::Vector2d step_m = map.nodes[line.nodes[i + 1]].place_m - from_m;
    const double length_m = step_m.norm();
    const auto num_steps = static_cast<int>(std::ceil(length_m / kStep_m));
    for (int k = 0; k < num_steps; ++k) {
      const double share = 1.0 * k / num_steps;
      places.push_back({from_m + share * step_m, step_m / length_m, along_m + share * length_m});
    }
    along_m += length_m;
  }
  return places;
}

/// Whether the circle that touches the line at one place and goes through another is too small.
bool IsTooNear(const OnLine& one, const OnLine& other) {
  if (std::abs(other.along_m - one.along_m) < kSameStretch_m) return false;
  const Eigen::Vector2d across_m = other.place_m - one.place_m;
  if (across_m.norm() > kNear_m) return false;
  const double aside_m = std::abs(one.ahead.x() * across_m.y() - one.ahead.y() * across_m.x());
  return across_m.squaredNorm() < 2.0 * aside_m * kLeastRadius_m;
}

/// The middle between two places at which a line meets itself, of those that are nearest to each
/// other along it; absent if it does so nowhere.
std::optional<double> MiddleOfLoop_m(const std::vector<OnLine>& places) {
  const auto cell_of = [](double value_m) {
    return static_cast<std::int64_t>(std::floor(value_m / kNear_m));
  };
  const auto key_of = [](std::int64_t column, std::int64_t row) {
    return (static_cast<std::uint64_t>(column) << 32U) ^
           (static_cast<std::uint64_t>(row) & 0xffffffffU);
  };
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> cells;
  std::optional<double> middle_m;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::int64_t column = cell_of(places[i].place_m.x());
    const std::int64_t row = cell_of(places[i].place_m.y());
    for (std::int64_t x = column - 1; x <= column + 1; ++x) {
      for (std::int64_t y = row - 1; y <= row + 1; ++y) {
        const auto found = cells.find(key_of(x, y));
        if (found == cells.end()) continue;
        for (const std::size_t k : found->second) {
          const double between_m = places[i].along_m - places[k].along_m;
          if (between_m >= least_m) continue;
          if (!IsTooNear(places[i], places[k]) && !IsTooNear(places[k], places[i])) continue;
          least_m = between_m;
          middle_m = 0.5 * (places[i].along_m + places[k].along_m);
        }
      }
    }
    cells[key_of(column, row)].push_back(i);
  }
  return middle_m;
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

std::vector<TrackLine> DividedWhereItMeetsItself(const RailMap& map, const TrackLine& line) {
  std::vector<TrackLine> open{line};
  std::vector<TrackLine> parts;
  while (!open.empty()) {
    TrackLine part = std::move(open.back());
    open.pop_back();
    const std::optional<double> middle_m = MiddleOfLoop_m(PlacesOn(map, part));
    std::size_t cut = 0;
    for (double along_m = 0.0; middle_m && cut < part.ways.size() && along_m < *middle_m; ++cut) {
      along_m += StepLength_m(map, part, cut);
    }
    if (cut == 0 || cut >= part.ways.size()) {
      parts.push_back(std::move(part));
      continue;
    }
    const auto node = part.nodes.begin() + static_cast<std::ptrdiff_t>(cut);
    const auto way = part.ways.begin() + static_cast<std::ptrdiff_t>(cut);
    open.push_back({{}, {node, part.nodes.end()}, {way, part.ways.end()}});
    open.push_back({{}, {part.nodes.begin(), node + 1}, {part.ways.begin(), way}});
  }
  return parts;
}

}  // namespace railcast
