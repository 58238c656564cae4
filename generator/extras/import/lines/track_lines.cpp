#include "generator/extras/import/lines/track_lines.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>

#include "generator/extras/import/lines/divided_line.h"

namespace railcast {
namespace {

constexpr double kSharpestTurn_rad = 20.0 * std::numbers::pi / 180.0;
constexpr double kOtherRef_rad = 6.0 * std::numbers::pi / 180.0;
/// The line through nearer points has any direction.
constexpr double kForDirection_m = 5.0;

/// The direction in which a track leaves the first of its nodes: to the first one that is far
/// enough, or to the last one.
Eigen::Vector2d DirectionOf(const RailMap& map, std::span<const std::size_t> nodes) {
  const Eigen::Vector2d& from_m = map.nodes[nodes.front()].place_m;
  Eigen::Vector2d to_m = Eigen::Vector2d::Zero();
  for (const std::size_t node : nodes) {
    to_m = map.nodes[node].place_m - from_m;
    if (to_m.norm() >= kForDirection_m) break;
  }
  return to_m.normalized();
}

/// The same backwards: the direction in which a track reaches the last of its nodes.
Eigen::Vector2d ArrivalOf(const RailMap& map, std::span<const std::size_t> nodes) {
  const Eigen::Vector2d& to_m = map.nodes[nodes.back()].place_m;
  Eigen::Vector2d along_m = Eigen::Vector2d::Zero();
  for (std::size_t i = nodes.size(); i-- > 0;) {
    along_m = to_m - map.nodes[nodes[i]].place_m;
    if (along_m.norm() >= kForDirection_m) break;
  }
  return along_m.normalized();
}

/// Follows tracks from way to way, each way once.
class LineWalk {
 public:
  explicit LineWalk(const RailMap& map) : map_(map), is_used_(map.ways.size()) {
    for (std::size_t i = 0; i < map.ways.size(); ++i) {
      if (!IsRunning(i)) continue;
      ways_at_[map.ways[i].nodes.front()].push_back(i);
      ways_at_[map.ways[i].nodes.back()].push_back(i);
    }
  }

  [[nodiscard]] bool IsRunning(std::size_t way) const {
    return TagOf(map_.ways[way].tags, "service").empty();
  }
  [[nodiscard]] bool IsUsed(std::size_t way) const { return is_used_[way]; }

  [[nodiscard]] TrackLine From(std::size_t way) {
    TrackLine line;
    line.nodes = map_.ways[way].nodes;
    line.ways.assign(line.nodes.size() - 1, way);
    is_used_[way] = true;
    for (int end = 0; end < 2; ++end) {
      while (const auto next = Next(line)) Append(*next, line);
      std::ranges::reverse(line.nodes);
      std::ranges::reverse(line.ways);
    }
    return line;
  }

 private:
  [[nodiscard]] std::vector<std::size_t> NodesFrom(std::size_t node, std::size_t way) const {
    std::vector<std::size_t> nodes = map_.ways[way].nodes;
    if (nodes.front() != node) std::ranges::reverse(nodes);
    return nodes;
  }

  /// The way by which a line goes on at its last node.
  [[nodiscard]] std::optional<std::size_t> Next(const TrackLine& line) const {
    const std::size_t node = line.nodes.back();
    const auto found = ways_at_.find(node);
    if (found == ways_at_.end()) return std::nullopt;
    const Eigen::Vector2d ahead = ArrivalOf(map_, line.nodes);
    std::optional<std::size_t> best;
    double least_rad = kSharpestTurn_rad + kOtherRef_rad;
    for (const std::size_t way : found->second) {
      if (is_used_[way]) continue;
      const double turn_rad =
          std::acos(std::clamp(ahead.dot(DirectionOf(map_, NodesFrom(node, way))), -1.0, 1.0));
      if (turn_rad > kSharpestTurn_rad) continue;
      const bool is_other =
          TagOf(map_.ways[way].tags, "ref") != TagOf(map_.ways[line.ways.back()].tags, "ref");
      const double cost_rad = turn_rad + (is_other ? kOtherRef_rad : 0.0);
      if (cost_rad >= least_rad) continue;
      least_rad = cost_rad;
      best = way;
    }
    return best;
  }

  void Append(std::size_t way, TrackLine& line) {
    const std::vector<std::size_t> nodes = NodesFrom(line.nodes.back(), way);
    line.nodes.insert(line.nodes.end(), nodes.begin() + 1, nodes.end());
    line.ways.insert(line.ways.end(), nodes.size() - 1, way);
    is_used_[way] = true;
  }

  const RailMap& map_;
  std::vector<bool> is_used_;
  std::unordered_map<std::size_t, std::vector<std::size_t>> ways_at_;  ///< By node.
};

/// The parts of a line between the points at which it turns back, that is by more than 90 degrees.
std::vector<TrackLine> DividedWhereItTurnsBack(const RailMap& map, TrackLine line) {
  std::vector<TrackLine> parts(1);
  const std::span<const std::size_t> nodes = line.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    parts.back().nodes.push_back(nodes[i]);
    if (i + 1 == nodes.size()) break;
    if (i > 0 && ArrivalOf(map, nodes.first(i + 1)).dot(DirectionOf(map, nodes.subspan(i))) < 0.0) {
      parts.push_back({{}, {nodes[i]}, {}});
    }
    parts.back().ways.push_back(line.ways[i]);
  }
  return parts;
}

/// Leaves out points that are too near to the one before.
TrackLine Thinned(const RailMap& map, const TrackLine& line) {
  TrackLine thin;
  for (std::size_t i = 0; i < line.nodes.size(); ++i) {
    const Eigen::Vector2d& place_m = map.nodes[line.nodes[i]].place_m;
    if (i > 0 && (place_m - map.nodes[thin.nodes.back()].place_m).norm() < kNearestNodes_m) {
      continue;
    }
    thin.nodes.push_back(line.nodes[i]);
    if (i > 0) thin.ways.push_back(line.ways[i - 1]);
  }
  return thin;
}

/// The most frequent value of a key along a line, by length.
std::string MainTag(const RailMap& map, const TrackLine& line, std::string_view key) {
  std::map<std::string_view, double> lengths_m;
  for (std::size_t i = 0; i < line.ways.size(); ++i) {
    lengths_m[TagOf(map.ways[line.ways[i]].tags, key)] += StepLength_m(map, line, i);
  }
  const auto longest =
      std::ranges::max_element(lengths_m, {}, [](const auto& entry) { return entry.second; });
  return std::string(longest->first);
}

/// Long enough to tell lines apart; file systems take 255 bytes, with all that is appended.
constexpr std::size_t kLongestName = 100;

/// Lower-case letters and digits, joined by hyphens; other characters are left out.
std::string FileNameOf(const std::string& text) {
  std::string name;
  for (const char character : text) {
    const auto byte = static_cast<unsigned char>(character);
    if (byte < 0x80 && std::isalnum(byte) != 0) {
      name += static_cast<char>(std::tolower(byte));
    } else if (byte < 0x80 && !name.empty() && name.back() != '-') {
      name += '-';
    }
  }
  name.resize(std::min(name.size(), kLongestName));
  while (!name.empty() && name.back() == '-') name.pop_back();
  return name;
}

void NameLines(const RailMap& map, std::vector<TrackLine>& lines) {
  std::set<std::string> taken;
  for (TrackLine& line : lines) {
    std::string name = FileNameOf(MainTag(map, line, "name") + " " + MainTag(map, line, "ref"));
    if (name.empty()) name = "line";
    std::string unique = name;
    for (int number = 2; !taken.insert(unique).second; ++number) {
      const std::string digits = std::to_string(number);
      unique = name.substr(0, kLongestName - 1 - digits.size());
      unique += '-';
      unique += digits;
    }
    line.name = std::move(unique);
  }
}

}  // namespace

double LengthOf_m(const RailMap& map, const MapWay& way) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < way.nodes.size(); ++i) {
    length_m += (map.nodes[way.nodes[i]].place_m - map.nodes[way.nodes[i - 1]].place_m).norm();
  }
  return length_m;
}

std::vector<TrackLine> FindLines(const RailMap& map, double shortest_m) {
  LineWalk walk(map);
  std::vector<std::size_t> order(map.ways.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater{},
                           [&](std::size_t way) { return LengthOf_m(map, map.ways[way]); });
  std::vector<TrackLine> lines;
  for (const std::size_t way : order) {
    if (!walk.IsRunning(way) || walk.IsUsed(way)) continue;
    for (const TrackLine& part : DividedWhereItTurnsBack(map, walk.From(way))) {
      const TrackLine thin = Thinned(map, part);
      if (thin.ways.empty()) continue;
      for (TrackLine& line : DividedWhereItMeetsItself(map, thin)) {
        if (LengthOf_m(map, line) >= shortest_m) lines.push_back(std::move(line));
      }
    }
  }
  std::ranges::stable_sort(lines, std::ranges::greater{},
                           [&](const TrackLine& line) { return LengthOf_m(map, line); });
  NameLines(map, lines);
  return lines;
}

double StepLength_m(const RailMap& map, const TrackLine& line, std::size_t node) {
  return (map.nodes[line.nodes[node + 1]].place_m - map.nodes[line.nodes[node]].place_m).norm();
}

double LengthOf_m(const RailMap& map, const TrackLine& line) {
  double length_m = 0.0;
  for (std::size_t i = 0; i + 1 < line.nodes.size(); ++i) length_m += StepLength_m(map, line, i);
  return length_m;
}

}  // namespace railcast
