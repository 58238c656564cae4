#include "generator/extras/import/structures/map_account.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <regex>
#include <sstream>
#include <string_view>
#include <utility>
#include <variant>

#include "core/base/text.h"
#include "core/rail/clearance/tunnel_shape.h"
#include "core/rail/network/world_tracks.h"
#include "core/rail/structures/structure_track.h"
#include "generator/extras/import/network/turnout_search.h"
#include "generator/extras/import/structures/line_structures.h"
#include "generator/extras/import/structures/way_ledger.h"

namespace railcast {
namespace {

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

/// What became of all ways, and of their tunnels and bridges.
class WaysAccount {
 public:
  WaysAccount(const RailMap& map, const WorldsOfMap& made)
      : map_(map), tracks_(map), tunnels_(map), bridges_(map) {
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
  [[nodiscard]] const WayLedger& tunnels() const { return tunnels_; }
  [[nodiscard]] const WayLedger& bridges() const { return bridges_; }

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
    for (WayLedger* ledger : {&tracks_, &tunnels_, &bridges_}) {
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
    WayLedger& ledger = is_tunnel ? tunnels_ : bridges_;
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
      ledger.Book(step, shares.begin_s_m + first * share, shares.begin_s_m + i * share, entry);
      first = i;
      entry = std::move(next);
    }
  }

  const RailMap& map_;
  WayLedger tracks_;
  WayLedger tunnels_;
  WayLedger bridges_;
};

/// @param parts Of the whole way.
AccountRow RowOf(const std::vector<LedgerEntry>& parts,
                 const RailMap& map,
                 std::size_t way,
                 const std::string& what) {
  AccountRow row{what, map.ways[way].place, LengthOf_m(map, map.ways[way])};
  for (const LedgerEntry& part : parts) {
    (part.rank == LedgerRank::kMade ? row.in_worlds : row.left_out[part.reason]) += part.length_m();
  }
  return row;
}

/// Whether a world has a structure, whatever its name.
bool HasStructure(const LineWorld& world, StructureSpec structure) {
  return std::ranges::any_of(world.structures, [&](const StructureSpec& other) {
    if (other.index() != structure.index()) return false;
    const std::string name = std::visit([](const auto& spec) { return spec.name; }, other);
    std::visit([&](auto& spec) { spec.name = name; }, structure);
    return structure == other;
  });
}

/// What became of the pieces of a map: the strongest of what its worlds say, as of ways.
class PiecesAccount {
 public:
  explicit PiecesAccount(const std::vector<LineWorld>& worlds) {
    for (const LineWorld& world : worlds) {
      for (const LeftOut& one : world.left_out) {
        const LedgerRank rank = one.reason == kOnNoTrack    ? LedgerRank::kOfLine
                                : one.reason == kAtLinesEnd ? LedgerRank::kUnused
                                                            : LedgerRank::kOfRun;
        Note({one.what, one.source}, rank, one.reason);
      }
      for (const MadeSwitch& one : world.switches) {
        Note({"switch", one.node}, LedgerRank::kMade, "");
      }
      for (const MadeThing& one : world.placed) {
        const LeftOut at = LeftOutOf(one.structure, "");
        const bool is_made = HasStructure(world, one.structure);
        Note({at.what, one.thing}, is_made ? LedgerRank::kMade : LedgerRank::kOfStructure,
             is_made ? "" : ReasonAt(world, at.what, at.begin_s_m, one.thing));
      }
    }
  }

  /// Adds a piece to the row of its kind.
  /// @param otherwise The reason where no world says anything of it.
  void Add(std::size_t source, const char* otherwise, AccountRow& row) const {
    ++row.on_map;
    const auto found = pieces_.find({row.what, source});
    const bool is_known = found != pieces_.end();
    const bool is_made = is_known && found->second.rank == LedgerRank::kMade;
    ++(is_made ? row.in_worlds : row.left_out[is_known ? found->second.reason : otherwise]);
  }

 private:
  using Piece = std::pair<std::string, std::size_t>;  // Its kind and its source, as of LeftOut.
  void Note(const Piece& piece, LedgerRank rank, const std::string& reason) {
    LedgerEntry& known = pieces_[piece];
    if (rank >= known.rank) known = {0.0, 0.0, rank, reason};
  }

  std::map<Piece, LedgerEntry> pieces_;
};

AccountRow SwitchesRow(const RailMap& map, const PiecesAccount& pieces) {
  AccountRow row{"switch", ""};
  for (const SwitchNode& node : SwitchesOf(map)) {
    pieces.Add(node.node, "it lies on no track of a world", row);
  }
  return row;
}

/// What becomes of a point on the map, by its key `railway`.
constexpr auto kPieces =
    std::to_array<std::pair<std::string_view, const char*>>({{"level_crossing", "level_crossing"},
                                                             {"crossing", "level_crossing"},
                                                             {"signal", "signal"},
                                                             {"milestone", "board"},
                                                             {"derail", "derailer"},
                                                             {"buffer_stop", "buffer_stop"}});

std::vector<AccountRow> PieceRows(const RailMap& map, const PiecesAccount& pieces) {
  std::map<std::string, AccountRow> rows;
  for (std::size_t i = 0; i < map.things.size(); ++i) {
    if (IsPlatform(map.things[i].tags)) continue;
    const auto* piece = std::ranges::find(kPieces, TagOf(map.things[i].tags, "railway"),
                                          &std::pair<std::string_view, const char*>::first);
    if (piece == kPieces.end()) continue;
    AccountRow& row = rows.try_emplace(piece->second, AccountRow{piece->second, ""}).first->second;
    pieces.Add(i, "it is within 2 m of no track of a world", row);
  }
  std::vector<AccountRow> all;
  for (auto& [what, row] : rows) all.push_back(std::move(row));
  return all;
}

bool IsInPieces(const std::string& what) {
  constexpr auto kInMetres = std::to_array<std::string_view>({"tunnel", "bridge", "platform"});
  return !what.ends_with("track") && std::ranges::find(kInMetres, what) == kInMetres.end();
}

/// Kinds of rows in their order.
std::vector<std::string> KindsOf(const std::vector<AccountRow>& rows) {
  std::vector<std::string> kinds;
  for (const AccountRow& row : rows) {
    if (std::ranges::count(kinds, row.what) == 0) kinds.push_back(row.what);
  }
  return kinds;
}

/// A reason without the names of tracks, which differ from world to world.
std::string WithoutNames(const std::string& reason) {
  static const std::regex name("track [a-z]+_[0-9]+");
  return std::regex_replace(reason, name, "another track");
}

}  // namespace

double AccountRow::out() const {
  double sum = 0.0;
  for (const auto& [reason, amount] : left_out) sum += amount;
  return sum;
}

std::vector<AccountRow> AccountOf(const RailMap& map, const WorldsOfMap& made) {
  const WaysAccount ways(map, made);
  const PiecesAccount pieces(made.worlds);
  std::vector<AccountRow> rows;
  std::vector<std::vector<LedgerEntry>> tracks;
  for (std::size_t i = 0; i < map.ways.size(); ++i) {
    const MapTags& tags = map.ways[i].tags;
    const auto parts = [&](const WayLedger& ledger) { return ledger.Of(i, made.otherwise); };
    tracks.push_back(parts(ways.tracks()));
    rows.push_back(RowOf(tracks.back(), map, i, KindOf(TagOf(tags, "service")) + " track"));
    if (IsTunnel(tags)) rows.push_back(RowOf(parts(ways.tunnels()), map, i, "tunnel"));
    if (IsBridge(tags)) rows.push_back(RowOf(parts(ways.bridges()), map, i, "bridge"));
  }
  for (AccountRow& row : PlatformRows(map, made, tracks)) rows.push_back(std::move(row));
  rows.push_back(SwitchesRow(map, pieces));
  for (AccountRow& row : PieceRows(map, pieces)) rows.push_back(std::move(row));
  return rows;
}

AccountRow SumOf(const std::vector<AccountRow>& rows, const std::string& what) {
  AccountRow sum{what, ""};
  for (const AccountRow& row : rows) {
    if (row.what != what) continue;
    sum.on_map += row.on_map;
    sum.in_worlds += row.in_worlds;
    for (const auto& [reason, amount] : row.left_out) sum.left_out[WithoutNames(reason)] += amount;
  }
  return sum;
}

std::string AccountCsv(const std::vector<AccountRow>& rows) {
  std::ostringstream csv;
  csv << "what,place,unit,on_map,in_worlds,left_out,reasons\n" << std::fixed;
  for (const AccountRow& row : rows) {
    const bool is_pieces = IsInPieces(row.what);
    csv << std::setprecision(is_pieces ? 0 : 2) << row.what << ',' << QuotedField(row.place) << ','
        << (is_pieces ? "pieces" : "m") << ',' << row.on_map << ',' << row.in_worlds << ','
        << row.out() << ',';
    std::ostringstream reasons;
    reasons << std::fixed << std::setprecision(is_pieces ? 0 : 2);
    const char* separator = "";
    for (const auto& [reason, amount] : row.left_out) {
      reasons << std::exchange(separator, "; ") << amount << ": " << reason;
    }
    csv << QuotedField(reasons.str()) << '\n';
  }
  return csv.str();
}

std::string AccountTable(const std::vector<AccountRow>& rows) {
  std::ostringstream table;
  std::ostringstream losses;
  table << "| account.csv | on the map | in worlds | % |\n|---|---|---|---|\n";
  for (const std::string& kind : KindsOf(rows)) {
    const AccountRow sum = SumOf(rows, kind);
    const bool is_pieces = IsInPieces(kind);
    const double scale = is_pieces ? 1.0 : 1e-3;
    const char* unit = is_pieces ? "" : " km";
    for (std::ostringstream* text : {&table, &losses}) {
      *text << std::fixed << std::setprecision(is_pieces ? 0 : 2);
    }
    const int percent =
        sum.on_map > 0.0 ? static_cast<int>(std::floor(100.0 * sum.in_worlds / sum.on_map)) : 100;
    table << "| " << kind << " | " << scale * sum.on_map << unit << " | " << scale * sum.in_worlds
          << unit << " | " << percent << " |\n";
    std::vector<std::pair<double, std::string>> reasons;
    for (const auto& [reason, amount] : sum.left_out) reasons.emplace_back(amount, reason);
    std::ranges::sort(reasons, std::ranges::greater{});
    constexpr std::size_t kShown = 4;
    for (std::size_t i = 0; i < std::min(kShown, reasons.size()); ++i) {
      losses << "  " << kind << ", " << scale * reasons[i].first << unit << ": "
             << ShownLines(reasons[i].second) << '\n';
    }
  }
  if (losses.str().empty()) return table.str();
  return table.str() + "\ngreatest losses:\n" + losses.str();
}

}  // namespace railcast
