#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "core/rail/clearance/tunnel_shape.h"
#include "core/rail/network/world_tracks.h"
#include "core/rail/structures/structure_track.h"
#include "generator/extras/import/lines/line_places.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/structures/line_structures.h"
#include "generator/extras/import/structures/map_account.h"

namespace railcast {
namespace {

/// What became of a map's ways, stretch by stretch.
class WayLedger {
 public:
  explicit WayLedger(const RailMap& map);

  /// Books a step's stretch between two shares of its length.
  void Book(const WayStep& step, double from_share, double to_share, LedgerEntry entry);

  /// A whole way in order, every part of it once, with the strongest of its entries, of equal ones
  /// the last. Gaps of kNearestNodes_m at most belong to what is beside them.
  /// @param otherwise The reason where there is no entry.
  [[nodiscard]] std::vector<LedgerEntry> Of(std::size_t way, const std::string& otherwise) const;

 private:
  std::vector<WayPlaces> places_;  ///< For each way.
  std::vector<std::vector<LedgerEntry>> entries_;
};

WayLedger::WayLedger(const RailMap& map) : entries_(map.ways.size()) {
  for (const MapWay& way : map.ways) places_.emplace_back(map, way);
}

void WayLedger::Book(const WayStep& step, double from_share, double to_share, LedgerEntry entry) {
  const double from_m = places_[step.way].Of_m(step.from, step.to);
  const double to_m = places_[step.way].Of_m(step.to, step.from);
  std::tie(entry.from_m, entry.to_m) =
      std::minmax({std::lerp(from_m, to_m, from_share), std::lerp(from_m, to_m, to_share)});
  entries_[step.way].push_back(std::move(entry));
}

std::vector<LedgerEntry> WayLedger::Of(std::size_t way, const std::string& otherwise) const {
  const std::vector<LedgerEntry>& entries = entries_[way];
  // Which of them begin or end at a place.
  std::map<double, std::vector<std::size_t>> turns{{0.0, {}}, {places_[way].length_m(), {}}};
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].from_m >= entries[i].to_m) continue;
    turns[entries[i].from_m].push_back(i);
    turns[entries[i].to_m].push_back(i);
  }
  std::vector<LedgerEntry> parts;
  std::vector<const LedgerEntry*> strongest;
  std::set<std::pair<LedgerRank, std::size_t>> open;
  for (auto turn = turns.begin(); std::next(turn) != turns.end(); ++turn) {
    for (const std::size_t i : turn->second) {
      const std::pair key(entries[i].rank, i);
      if (open.erase(key) == 0) open.insert(key);
    }
    parts.push_back({turn->first, std::next(turn)->first, LedgerRank::kOfLine, otherwise});
    strongest.push_back(open.empty() ? nullptr : &entries[open.rbegin()->second]);
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const LedgerEntry* entry = strongest[i];
    if (entry == nullptr && parts[i].length_m() <= kNearestNodes_m) {
      entry = i > 0 ? strongest[i - 1] : nullptr;
      if (entry == nullptr && i + 1 < parts.size()) entry = strongest[i + 1];
    }
    if (entry == nullptr) continue;
    parts[i].rank = entry->rank;
    parts[i].reason = entry->reason;
  }
  return parts;
}

/// A structure about a track: what lies between two offsets from its axis.
struct Cover {
  std::size_t track{};
  double begin_s_m{};
  double end_s_m{};
  double right_m{};
  double left_m{};
};

/// The tunnels and bridges of a world.
class WorldCovers {
 public:
  explicit WorldCovers(const LineWorld& world) : world_(world) {
    const TracksOfLine core(world);
    for (const StructureSpec& structure : world.structures) {
      if (const auto* tunnel = std::get_if<TunnelSpec>(&structure)) {
        const TunnelShape shape = TunnelShapeOf(core.tracks(), *tunnel);
        const double middle_m = shape.spread.middle_m();
        tunnels_.push_back({*TrackIndex(core.tracks().world, tunnel->track), tunnel->begin_s_m,
                            tunnel->end_s_m, middle_m - shape.radius_m, middle_m + shape.radius_m});
      } else if (const auto* bridge = std::get_if<BridgeSpec>(&structure)) {
        const TrackSpread spread = SpreadOf(core.tracks(), *bridge, kSharedBridge_m);
        bridges_.push_back({*TrackIndex(core.tracks().world, bridge->track), bridge->begin_s_m,
                            bridge->end_s_m, spread.right_m - bridge->edge_distance_m,
                            spread.left_m + bridge->edge_distance_m});
      }
    }
  }

  [[nodiscard]] bool HasTunnel(std::size_t track, double s_m) const {
    return IsIn(tunnels_, track, s_m);
  }
  [[nodiscard]] bool HasBridge(std::size_t track, double s_m) const {
    return IsIn(bridges_, track, s_m);
  }

 private:
  [[nodiscard]] bool IsIn(const std::vector<Cover>& covers, std::size_t track, double s_m) const {
    const double d_m = world_.tracks[track].draft.OffsetNear_m(s_m);
    return std::ranges::any_of(covers, [&](const Cover& cover) {
      if (s_m < cover.begin_s_m || s_m > cover.end_s_m) return false;
      const double from_axis_m = d_m - world_.tracks[cover.track].draft.OffsetNear_m(s_m);
      return from_axis_m > cover.right_m && from_axis_m < cover.left_m;
    });
  }

  const LineWorld& world_;
  std::vector<Cover> tunnels_;
  std::vector<Cover> bridges_;
};

/// What became of all ways' tracks, and of their tunnels or bridges.
class WayBooks {
 public:
  WayBooks(const RailMap& map, const WorldsOfMap& made)
      : map_(map), tracks_(map), structures_(map) {
    for (const LeftOutLine& line : made.left_out) {
      for (std::size_t i = 0; i < line.track.ways.size(); ++i) {
        const WayStep step{line.track.ways[i], line.track.nodes[i], line.track.nodes[i + 1]};
        LeaveOut(step, {0.0, 1.0}, LedgerRank::kOfLine, line.reason);
      }
    }
    for (std::size_t i = 0; i < made.worlds.size(); ++i) {
      BookWorld(made.tracks[i], made.lines[i], made.worlds[i]);
    }
  }

  [[nodiscard]] const WayLedger& tracks() const { return tracks_; }
  [[nodiscard]] const WayLedger& structures() const { return structures_; }

 private:
  void BookWorld(const TrackLine& track, const ImportedLine& line, const LineWorld& world) {
    const WorldCovers covers(world);
    for (const UnusedStep& unused : world.beside.unused) {
      LeaveOut(unused.step, {0.0, 1.0}, LedgerRank::kUnused, unused.reason);
    }
    for (std::size_t i = 0; i < track.ways.size(); ++i) {
      const WayStep step{track.ways[i], track.nodes[i], track.nodes[i + 1]};
      Make(step, {line.chainages_m[i], line.chainages_m[i + 1]}, {0.0, 1.0}, 0, world, covers);
    }
    for (std::size_t i = 0; i < world.beside.runs.size(); ++i) BookRun(i, world, covers);
  }

  void BookRun(std::size_t number, const LineWorld& world, const WorldCovers& covers) {
    const TrackRun& run = world.beside.runs[number];
    // The shares are those of a step; they are empty if it does not meet the range.
    const auto book = [&](const ChainageRange& range, const auto& as) {
      for (std::size_t k = 0; k < run.ways.size(); ++k) {
        const ChainageRange s{run.points_m[k].x(), run.points_m[k + 1].x()};
        const auto share = [&](double s_m) {
          return std::clamp((s_m - s.begin_s_m) / (s.end_s_m - s.begin_s_m), 0.0, 1.0);
        };
        as(WayStep{run.ways[k].way, run.nodes[k], run.nodes[k + 1]}, s,
           ChainageRange{share(range.begin_s_m), share(range.end_s_m)});
      }
    };
    for (const LeftOut& thing : world.left_out) {
      if (thing.source != number || thing.what.find("track") == std::string::npos) continue;
      book({thing.begin_s_m, thing.end_s_m},
           [&](const WayStep& step, const ChainageRange& /*s*/, const ChainageRange& shares) {
             LeaveOut(step, shares, LedgerRank::kOfRun, thing.reason);
           });
    }
    for (std::size_t i = 0; i < world.tracks.size(); ++i) {
      if (world.tracks[i].run != number) continue;
      book(RangeInRun(world, world.tracks[i]),
           [&](const WayStep& step, const ChainageRange& s, const ChainageRange& shares) {
             Make(step, s, shares, i, world, covers);
           });
    }
  }

  void LeaveOut(const WayStep& step,
                const ChainageRange& shares,
                LedgerRank rank,
                const std::string& reason) {
    if (shares.begin_s_m >= shares.end_s_m) return;
    for (WayLedger* ledger : {&tracks_, &structures_}) {
      ledger->Book(step, shares.begin_s_m, shares.end_s_m, {0.0, 0.0, rank, reason});
    }
  }

  /// @param s Of the whole step.
  // NOLINTNEXTLINE(readability-function-size): a stretch of a way, and what is there
  void Make(const WayStep& step,
            const ChainageRange& s,
            const ChainageRange& shares,
            std::size_t track,
            const LineWorld& world,
            const WorldCovers& covers) {
    if (shares.begin_s_m >= shares.end_s_m) return;
    tracks_.Book(step, shares.begin_s_m, shares.end_s_m, {0.0, 0.0, LedgerRank::kMade});
    const MapTags& tags = map_.ways[step.way].tags;
    const bool is_tunnel = IsTunnel(tags);
    if (!is_tunnel && !IsBridge(tags)) return;
    // Metre by metre.
    const double length_m = std::abs(s.end_s_m - s.begin_s_m);
    const double num_steps =
        std::max(1.0, std::ceil((shares.end_s_m - shares.begin_s_m) * length_m));
    const double share = (shares.end_s_m - shares.begin_s_m) / num_steps;
    const auto outcome = [&](double i) -> LedgerEntry {
      const double s_m = std::lerp(s.begin_s_m, s.end_s_m, shares.begin_s_m + (i + 0.5) * share);
      if (is_tunnel ? covers.HasTunnel(track, s_m) : covers.HasBridge(track, s_m)) {
        return {0.0, 0.0, LedgerRank::kMade, ""};
      }
      return {0.0, 0.0, LedgerRank::kOfStructure,
              ReasonAt(world, is_tunnel ? "tunnel" : "bridge", s_m, kUnknownSource)};
    };
    double first = 0.0;
    LedgerEntry entry = outcome(0.0);
    for (double i = 1.0; i <= num_steps; ++i) {
      LedgerEntry next = i < num_steps ? outcome(i) : LedgerEntry{};
      if (i < num_steps && next.rank == entry.rank && next.reason == entry.reason) continue;
      structures_.Book(step, shares.begin_s_m + first * share, shares.begin_s_m + i * share, entry);
      first = i;
      entry = std::move(next);
    }
  }

  const RailMap& map_;
  WayLedger tracks_;
  WayLedger structures_;
};

}  // namespace

std::vector<WayAccount> AccountOfWays(const RailMap& map, const WorldsOfMap& made) {
  const WayBooks books(map, made);
  std::vector<WayAccount> ways(map.ways.size());
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const MapTags& tags = map.ways[i].tags;
    ways[i].track = books.tracks().Of(i, made.otherwise);
    if (IsTunnel(tags) || IsBridge(tags)) {
      ways[i].structure = books.structures().Of(i, made.otherwise);
    }
  }
  return ways;
}

}  // namespace railcast
