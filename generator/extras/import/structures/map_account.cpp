#include "generator/extras/import/structures/map_account.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <variant>

#include "generator/extras/import/network/turnout_search.h"
#include "generator/extras/import/structures/line_structures.h"

namespace railcast {
namespace {

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

}  // namespace

double AccountRow::out() const {
  double sum = 0.0;
  for (const auto& [reason, amount] : left_out) sum += amount;
  return sum;
}

std::vector<AccountRow> AccountOf(const RailMap& map, const WorldsOfMap& made) {
  const std::vector<WayAccount> ways = AccountOfWays(map, made);
  const PiecesAccount pieces(made.worlds);
  std::vector<AccountRow> rows;
  for (std::size_t i = 0; i < map.ways.size(); ++i) {
    const MapTags& tags = map.ways[i].tags;
    rows.push_back(RowOf(ways[i].track, map, i, KindOf(TagOf(tags, "service")) + " track"));
    if (IsTunnel(tags)) rows.push_back(RowOf(ways[i].structure, map, i, "tunnel"));
    if (IsBridge(tags)) rows.push_back(RowOf(ways[i].structure, map, i, "bridge"));
  }
  for (AccountRow& row : PlatformRows(map, made, ways)) rows.push_back(std::move(row));
  rows.push_back(SwitchesRow(map, pieces));
  for (AccountRow& row : PieceRows(map, pieces)) rows.push_back(std::move(row));
  return rows;
}

std::string ReasonAt(const LineWorld& world,
                     const std::string& what,
                     double s_m,
                     std::size_t source) {
  constexpr double kOff_m = 1.0;
  std::string reason = kNoReason;
  for (const LeftOut& thing : world.left_out) {
    if (thing.what != what || s_m < thing.begin_s_m - kOff_m || s_m > thing.end_s_m + kOff_m) {
      continue;
    }
    if (thing.source == source) return thing.reason;
    if (thing.source == kUnknownSource) reason = thing.reason;
  }
  return reason;
}

}  // namespace railcast
