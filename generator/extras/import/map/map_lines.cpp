#include "generator/extras/import/map/map_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <utility>

#include "core/base/text.h"
#include "generator/extras/import/map/map_formats.h"

namespace railcast {
namespace {

/// Makes one node of points with equal coordinates.
class NodeIndex {
 public:
  explicit NodeIndex(RailMap& map) : map_(map) {}

  std::size_t Of(const Eigen::Vector2d& point_deg) {
    const auto [entry, is_new] =
        nodes_.try_emplace({point_deg.x(), point_deg.y()}, map_.nodes.size());
    if (is_new) map_.nodes.push_back({.geographic_deg = point_deg, .tags = {}});
    return entry->second;
  }

 private:
  RailMap& map_;
  std::map<std::pair<double, double>, std::size_t> nodes_;
};

bool IsDegrees(const Eigen::Vector2d& point_deg) {
  return std::abs(point_deg.x()) <= kMostLongitude_deg &&
         std::abs(point_deg.y()) <= kMostLatitude_deg;
}

/// Moves platforms, signals and the like from the lines to the map, and drops other points.
void TakeThings(std::vector<MapLine>& lines, RailMap& map) {
  std::erase_if(lines, [&](MapLine& line) {
    const bool is_place =
        !line.points_deg.empty() && std::ranges::all_of(line.points_deg, IsDegrees);
    if (!IsThing(line.tags) || !is_place) return line.is_point;
    map.things.push_back({std::move(line.points_deg), {}, std::move(line.tags)});
    return true;
  });
}

/// Geofabrik's exports have the values of `railway`, and of those of OtherKind(), in one key.
constexpr std::string_view kClass = "fclass";

void TellLeftOut(const MapLine& line, std::string why, RailMap& map) {
  map.remarks.push_back({RemarkKind::kLinesLeftOut, line.place, 1, std::move(why)});
}

/// Whether a line has a key that OpenStreetMap's roads, rivers and the like have.
std::string_view OtherKind(const MapTags& tags) {
  constexpr auto kOthers = std::to_array<std::string_view>(
      {"highway", "waterway", "aerialway", "aeroway", "power", "barrier", "boundary", "building",
       "landuse", "leisure", "man_made", "natural", "pipeline"});
  for (const std::string_view key : kOthers) {
    if (!TagOf(tags, key).empty()) return key;
  }
  if (!TagOf(tags, kClass).empty() && !IsTrack(TagOf(tags, kClass))) return kClass;
  return {};
}

/// Leaves the tracks.
void EraseOthers(std::vector<MapLine>& lines, RailMap& map) {
  for (MapLine& line : lines) {
    const std::string_view of_class = TagOf(line.tags, kClass);
    if (IsTrack(of_class) && TagOf(line.tags, "railway").empty()) line.tags["railway"] = of_class;
  }
  const bool has_railways = std::ranges::any_of(
      lines, [](const MapLine& line) { return !TagOf(line.tags, "railway").empty(); });
  std::erase_if(lines, [&](const MapLine& line) {
    const std::string_view railway = TagOf(line.tags, "railway");
    if (IsTrack(railway)) return false;
    const std::string unread = UnreadTrackTag(line.tags);
    if (!unread.empty()) TellLeftOut(line, unread, map);
    if (!railway.empty() || !unread.empty()) return true;
    const std::string_view kind = OtherKind(line.tags);
    if (kind.empty() && !has_railways) return false;
    TellLeftOut(line,
                kind.empty() ? "it has no railway"
                             : std::string(kind) + "=" + ShownText(TagOf(line.tags, kind)),
                map);
    return true;
  });
}

/// Appends a line as a way.
void AddLine(const MapLine& line, NodeIndex& nodes, RailMap& map, ErrorList& errors) {
  if (line.is_area) {
    errors.Add({line.place, "must be a line, since it is to be a track", "a polygon"});
    return;
  }
  MapWay way{static_cast<std::int64_t>(map.ways.size()), {}, line.tags, line.place};
  std::size_t num_without = 0;
  for (std::size_t i = 0; i < line.points_deg.size(); ++i) {
    const Eigen::Vector2d& point_deg = line.points_deg[i];
    if (!IsDegrees(point_deg)) {
      errors.Add({line.place, "must have longitudes and latitudes in degrees",
                  NumberText(point_deg.x()) + ", " + NumberText(point_deg.y())});
      return;
    }
    const std::size_t node = nodes.Of(point_deg);
    AppendNode(node, way);
    if (line.heights_m.empty()) continue;
    const std::optional<double>& height_m = line.heights_m[i];
    if (!height_m) ++num_without;
    if (!height_m || map.nodes[node].height_m) continue;
    if (!IsHeight(*height_m)) {
      errors.Add({line.place, kHeightRule, NumberText(*height_m)});
      return;
    }
    map.nodes[node].height_m = height_m;
  }
  if (num_without > 0 && num_without < line.points_deg.size()) {
    map.remarks.push_back({RemarkKind::kHeightsMissing, line.place, num_without});
  }
  map.ways.push_back(std::move(way));
}

/// About the first of some points, in metres: good enough for some 100 m.
class NearbyMetres {
 public:
  explicit NearbyMetres(const Eigen::Vector2d& about_deg)
      : scale_m_(kPerDegree_m * std::cos(about_deg.y() * std::numbers::pi / 180.0), kPerDegree_m) {}

  [[nodiscard]] Eigen::Vector2d Step_m(const Eigen::Vector2d& from_deg,
                                       const Eigen::Vector2d& to_deg) const {
    return (to_deg - from_deg).cwiseProduct(scale_m_);
  }

 private:
  static constexpr double kPerDegree_m = 111.3e3;
  Eigen::Vector2d scale_m_;
};

/// Leaves lines with two different points or more.
/// @throws InputError if there are none.
void EraseEmpty(std::vector<MapLine>& lines, RailMap& map) {
  ErrorList errors;
  std::erase_if(lines, [&](const MapLine& line) {
    const auto& points_deg = line.points_deg;
    if (std::ranges::adjacent_find(points_deg, std::not_equal_to{}) != points_deg.end())
      return false;
    const std::string num = points_deg.empty() ? "0" : "1";
    errors.Add({line.place, "must have two different points or more", num});
    TellLeftOut(line, "its different points are " + num, map);
    return true;
  });
  if (lines.empty()) errors.ThrowIfAny();
}

/// Where the run of fixes from one on ends that lie within so many metres of their mean.
std::size_t EndOfRun(const std::vector<Eigen::Vector2d>& points_deg, std::size_t begin) {
  constexpr double kFarthest_m = 20.0;
  const NearbyMetres metres(points_deg[begin]);
  Eigen::Vector2d sum_deg = points_deg[begin];
  std::size_t end = begin + 1;
  for (; end < points_deg.size(); ++end) {
    const Eigen::Vector2d mean_deg = sum_deg / static_cast<double>(end - begin);
    if (metres.Step_m(mean_deg, points_deg[end]).norm() > kFarthest_m) break;
    sum_deg += points_deg[end];
  }
  return end;
}

/// Whether fixes turn back within a run.
bool TurnsBack(const std::vector<Eigen::Vector2d>& points_deg, std::size_t begin, std::size_t end) {
  const NearbyMetres metres(points_deg[begin]);
  for (std::size_t i = begin + 1; i + 1 < end; ++i) {
    if (metres.Step_m(points_deg[i - 1], points_deg[i])
            .dot(metres.Step_m(points_deg[i], points_deg[i + 1])) < 0.0) {
      return true;
    }
  }
  return false;
}

/// Makes one point of equal neighbours, with the first height among them.
void JoinEqual(MapLine& line) {
  std::size_t num = 0;
  for (std::size_t i = 0; i < line.points_deg.size(); ++i) {
    const bool is_new = num == 0 || line.points_deg[i] != line.points_deg[num - 1];
    if (is_new) line.points_deg[num++] = line.points_deg[i];
    if (line.heights_m.empty()) continue;
    std::optional<double>& height_m = line.heights_m[num - 1];
    if (is_new || !height_m) height_m = line.heights_m[i];
  }
  line.points_deg.resize(num);
  if (!line.heights_m.empty()) line.heights_m.resize(num);
}

/// The fixes with each run that turns back as one.
MapLine OnceThinned(const MapLine& line) {
  MapLine thin = line;
  thin.points_deg.clear();
  thin.heights_m.clear();
  std::size_t first_unknown = 0;
  for (std::size_t i = 0; i < line.points_deg.size();) {
    std::size_t end = i + 1;
    if (i >= first_unknown) {
      const std::size_t end_of_run = EndOfRun(line.points_deg, i);
      if (TurnsBack(line.points_deg, i, end_of_run)) {
        end = end_of_run;
      } else {
        // The next run to begin is one in which the last of these may turn.
        first_unknown = std::max(i + 3, end_of_run) - 2;
      }
    }
    Eigen::Vector2d sum_deg = Eigen::Vector2d::Zero();
    double sum_m = 0.0;
    double num_heights = 0.0;
    for (std::size_t k = i; k < end; ++k) {
      sum_deg += line.points_deg[k];
      if (line.heights_m.empty() || !line.heights_m[k]) continue;
      sum_m += *line.heights_m[k];
      num_heights += 1.0;
    }
    const bool is_one = end == i + 1;  // It keeps its digits.
    thin.points_deg.emplace_back(is_one ? line.points_deg[i]
                                        : Eigen::Vector2d(sum_deg / static_cast<double>(end - i)));
    if (!line.heights_m.empty()) {
      thin.heights_m.push_back(num_heights > 0.0 ? std::optional(sum_m / num_heights)
                                                 : std::nullopt);
    }
    i = end;
  }
  return thin;
}

}  // namespace

std::size_t ThinFixes(MapLine& line) {
  JoinEqual(line);
  const std::size_t num_before = line.points_deg.size();
  // What is left of a long stop may turn back again.
  while (true) {
    MapLine thin = OnceThinned(line);
    if (thin.points_deg.size() == line.points_deg.size()) break;
    line = std::move(thin);
  }
  return num_before - line.points_deg.size();
}

RailMap MapOfLines(std::vector<MapLine> lines, std::vector<Remark> remarks) {
  RailMap map;
  map.remarks = std::move(remarks);
  TakeThings(lines, map);
  const std::size_t num_lines = lines.size();
  EraseOthers(lines, map);
  if (lines.empty()) {
    throw InputError("must have a line that is a track (got " +
                     (num_lines == 0 ? "no lines" : std::to_string(num_lines) + " other lines") +
                     ")");
  }
  for (MapLine& line : lines) {
    if (TagOf(line.tags, "railway").empty() && std::ranges::all_of(line.points_deg, IsDegrees)) {
      const std::size_t num_fewer = ThinFixes(line);
      if (num_fewer > 0) {
        map.remarks.push_back({RemarkKind::kFixesThinned, line.place, num_fewer});
      }
    }
  }
  EraseEmpty(lines, map);
  NodeIndex nodes(map);
  ErrorList errors;
  for (const MapLine& line : lines) AddLine(line, nodes, map, errors);
  errors.ThrowIfAny();
  return map;
}

}  // namespace railcast
