#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/text.h"
#include "generator/extras/import/lines/line_places.h"
#include "generator/extras/import/structures/line_structures.h"
#include "generator/extras/import/structures/map_account.h"

namespace railcast {
namespace {

/// A segment of a way.
struct Segment {
  std::size_t way{};
  double along_m{};  ///< Where it begins.
  Eigen::Vector2d from_m;
  Eigen::Vector2d step_m;
};

/// Where a track of the map passes a place of a platform.
struct Passing {
  Segment segment;
  double share{};
  Eigen::Vector2d foot_m;
  double distance_m{};
};

constexpr double kFarthest_m = 4.5;

/// The segments of all ways, by the squares in which the middles of their parts lie.
class SegmentGrid {
 public:
  explicit SegmentGrid(const RailMap& map) {
    for (std::size_t way = 0; way < map.ways.size(); ++way) {
      const std::vector<std::size_t>& nodes = map.ways[way].nodes;
      double along_m = 0.0;
      for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
        const Eigen::Vector2d& from_m = map.nodes[nodes[k]].place_m;
        const Eigen::Vector2d step_m = map.nodes[nodes[k + 1]].place_m - from_m;
        const double num_parts = std::ceil(step_m.norm() / kSquare_m);
        for (double part = 0.5; part < num_parts; ++part) {
          const Eigen::Vector2d middle_m = from_m + part / num_parts * step_m;
          squares_[SquareOf(middle_m)].push_back({way, along_m, from_m, step_m});
        }
        along_m += step_m.norm();
      }
    }
  }

  /// The segments within kFarthest_m of a place, and others; long ones several times.
  [[nodiscard]] std::vector<Segment> About(const Eigen::Vector2d& place_m) const {
    static_assert(0.5 * kSquare_m + kFarthest_m <= kSquare_m);
    std::vector<Segment> segments;
    const auto [column, row] = SquareOf(place_m);
    for (int i = column - 1; i <= column + 1; ++i) {
      for (int k = row - 1; k <= row + 1; ++k) {
        const auto square = squares_.find({i, k});
        if (square == squares_.end()) continue;
        segments.insert(segments.end(), square->second.begin(), square->second.end());
      }
    }
    return segments;
  }

 private:
  static constexpr double kSquare_m = 20.0;

  static std::pair<int, int> SquareOf(const Eigen::Vector2d& place_m) {
    const Eigen::Vector2d square = (place_m / kSquare_m).array().floor();
    return {static_cast<int>(square.x()), static_cast<int>(square.y())};
  }

  std::map<std::pair<int, int>, std::vector<Segment>> squares_;
};

class PlatformAccount {
 public:
  PlatformAccount(const RailMap& map, const WorldsOfMap& made, const std::vector<WayAccount>& ways)
      : map_(map), made_(made), ways_(ways), segments_(map), worlds_of_(map.ways.size()) {
    for (std::size_t i = 0; i < made.worlds.size(); ++i) {
      places_.emplace_back(map, made.tracks[i], made.lines[i]);
      for (const WorldTrack& track : made.worlds[i].tracks) {
        for (const LineStretch& stretch : track.ways) worlds_of_[stretch.way].insert(i);
      }
    }
  }

  [[nodiscard]] AccountRow RowOf(std::size_t number) const {
    const MapThing& thing = map_.things[number];
    AccountRow row{"platform", ""};
    if (!thing.geographic_deg.empty()) {
      row.place = NumberText(RoundedTo(thing.geographic_deg.front().x(), 1e6)) + " " +
                  NumberText(RoundedTo(thing.geographic_deg.front().y(), 1e6));
    }
    const std::vector<Eigen::Vector2d>& points_m = thing.places_m;
    double twice_area_m2 = 0.0;
    for (std::size_t i = 0; i + 1 < points_m.size(); ++i) {
      twice_area_m2 +=
          points_m[i].x() * points_m[i + 1].y() - points_m[i].y() * points_m[i + 1].x();
    }
    for (std::size_t i = 0; i + 1 < points_m.size(); ++i) {
      const Eigen::Vector2d step_m = points_m[i + 1] - points_m[i];
      const double num_steps = std::ceil(step_m.norm());
      for (double k = 0.0; k < num_steps; ++k) {
        const Eigen::Vector2d at_m = points_m[i] + (k + 0.5) / num_steps * step_m;
        const std::vector<Segment> segments = segments_.About(at_m);
        // An outline has tracks on its outer side only, a line on both.
        for (const double side : {1.0, -1.0}) {
          if (IsOutline(thing) && side * twice_area_m2 > 0.0) continue;
          const auto passing = PassingOf(at_m, side, step_m, segments);
          if (!passing) continue;
          const double length_m = step_m.norm() / num_steps;
          const std::optional<std::string> reason = ReasonAgainst(number, at_m, *passing);
          row.on_map += length_m;
          (reason ? row.left_out[*reason] : row.in_worlds) += length_m;
        }
      }
    }
    return row;
  }

 private:
  static constexpr const char* kNoTrackNear = "no track of the world is 0.3 to 4.5 m from it there";

  /// The nearest track on one side of a platform's edge that runs along it.
  /// @param side 1 on the left of the edge, -1 on its right.
  [[nodiscard]] static std::optional<Passing> PassingOf(const Eigen::Vector2d& at_m,
                                                        double side,
                                                        const Eigen::Vector2d& edge_m,
                                                        const std::vector<Segment>& segments) {
    const double least_along = std::sqrt(0.5);  // 45 degrees.
    std::optional<Passing> nearest;
    for (const Segment& segment : segments) {
      const double share = std::clamp(
          (at_m - segment.from_m).dot(segment.step_m) / segment.step_m.squaredNorm(), 0.0, 1.0);
      const Eigen::Vector2d foot_m = segment.from_m + share * segment.step_m;
      const Eigen::Vector2d aside_m = foot_m - at_m;
      const double distance_m = aside_m.norm();
      if (distance_m > kFarthest_m || (nearest && distance_m >= nearest->distance_m)) continue;
      if (side * (edge_m.x() * aside_m.y() - edge_m.y() * aside_m.x()) <= 0.0) continue;
      const double along = std::abs(edge_m.normalized().dot(segment.step_m.normalized()));
      if (along < least_along) continue;
      nearest = {segment, share, foot_m, distance_m};
    }
    return nearest;
  }

  /// Why an edge is in no world; absent if it is in one.
  [[nodiscard]] std::optional<std::string> ReasonAgainst(std::size_t number,
                                                         const Eigen::Vector2d& at_m,
                                                         const Passing& passing) const {
    constexpr double kReach_m = 65.0;
    std::optional<std::string> reason;
    for (const std::size_t i : worlds_of_[passing.segment.way]) {
      const auto edge = places_[i].Of(at_m, kReach_m);
      const auto foot = places_[i].Of(passing.foot_m, kReach_m);
      if (!edge || !foot) continue;
      const LineWorld& world = made_.worlds[i];
      const WorldTrack* track = TrackOf(world, passing.segment.way, foot->s_m);
      if (track == nullptr) continue;
      if (HasPlatform(world, *track, foot->s_m, edge->d_m > foot->d_m)) return std::nullopt;
      // What a world says of the platform itself counts more.
      if (reason && *reason != kNoTrackNear) continue;
      reason = ReasonAt(world, "platform", foot->s_m, number);
      if (*reason == kNoReason) reason = kNoTrackNear;
    }
    if (reason) return reason;
    const std::vector<LedgerEntry>& parts = ways_[passing.segment.way].track;
    const double along_m = passing.segment.along_m + passing.share * passing.segment.step_m.norm();
    const auto part = std::ranges::lower_bound(parts, along_m, {}, &LedgerEntry::to_m);
    if (part == parts.end()) return "its track is in no world: " + made_.otherwise;
    return part->rank == LedgerRank::kMade ? kNoTrackNear
                                           : "its track is in no world: " + part->reason;
  }

  /// The track of a world that is made of a way; null if there is none at a chainage.
  [[nodiscard]] static const WorldTrack* TrackOf(const LineWorld& world,
                                                 std::size_t way,
                                                 double s_m) {
    constexpr double kOff_m = 2.0;
    for (const WorldTrack& track : world.tracks) {
      if (!track.draft.Has(s_m)) continue;
      const bool is_of_way = std::ranges::any_of(track.ways, [&](const LineStretch& stretch) {
        return stretch.way == way && s_m > stretch.begin_s_m - kOff_m &&
               s_m < stretch.end_s_m + kOff_m;
      });
      if (is_of_way) return &track;
    }
    return nullptr;
  }

  [[nodiscard]] static bool HasPlatform(const LineWorld& world,
                                        const WorldTrack& track,
                                        double s_m,
                                        bool is_left) {
    constexpr double kOff_m = 1.0;
    return std::ranges::any_of(world.structures, [&](const StructureSpec& structure) {
      const auto* platform = std::get_if<PlatformSpec>(&structure);
      return platform != nullptr && platform->track == track.draft.spec.name &&
             (platform->side == TrackSide::kLeft) == is_left &&
             s_m > platform->begin_s_m - kOff_m && s_m < platform->end_s_m + kOff_m;
    });
  }

  const RailMap& map_;
  const WorldsOfMap& made_;
  const std::vector<WayAccount>& ways_;
  SegmentGrid segments_;
  std::vector<std::set<std::size_t>> worlds_of_;  ///< For each way, the worlds with tracks of it.
  std::deque<LinePlaces> places_;
};

}  // namespace

std::vector<AccountRow> PlatformRows(const RailMap& map,
                                     const WorldsOfMap& made,
                                     const std::vector<WayAccount>& ways) {
  const PlatformAccount account(map, made, ways);
  std::vector<AccountRow> rows;
  for (std::size_t i = 0; i < map.things.size(); ++i) {
    if (IsPlatform(map.things[i].tags)) rows.push_back(account.RowOf(i));
  }
  return rows;
}

}  // namespace railcast
