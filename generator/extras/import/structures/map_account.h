#pragma once

#include <map>
#include <string>
#include <vector>

#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/rail_map.h"
#include "generator/extras/import/network/line_world.h"

namespace railcast {

/// How much of something on a map is in worlds, and how much is not: metres, or pieces.
struct AccountRow {
  std::string what;   ///< "running track", "yard track", "tunnel", "platform", "switch", ...
  std::string place;  ///< On the map: "way 7"; empty for all pieces of a kind together.
  double on_map{};
  double in_worlds{};
  std::map<std::string, double> left_out{};  ///< By the reason.

  /// What was left out for any reason.
  [[nodiscard]] double out() const;
};

/// Lines with their worlds: lists of one order, and what is in none of them.
struct WorldsOfMap {
  const std::vector<TrackLine>& tracks;
  const std::vector<ImportedLine>& lines;
  const std::vector<LineWorld>& worlds;
  const std::vector<LeftOutLine>& left_out;
  std::string otherwise;  ///< Why a track is in no world if nothing else says so.
};

/// Why a track that no line comes near is in no world.
inline constexpr const char* kNearNoLine =
    "it is in no line of at least --min-length, and none runs within 60 m of it";

/// Says of all that a map has whether it is in a world or why not.
///
/// There is a row for each way, one more if it is in a tunnel or on a bridge, one for each
/// platform, and one for all switches, signals and so on. What several worlds have counts once, and
/// `on_map` is always `in_worlds` and `left_out` together. A platform's edges are those of its
/// sides that a track of the map passes at 4.5 m at most.
[[nodiscard]] std::vector<AccountRow> AccountOf(const RailMap& map, const WorldsOfMap& made);

// The parts of which the account is made.

/// From the weakest to the strongest: of what is said of a stretch of a way, the strongest holds.
enum class LedgerRank {
  kOfLine,       ///< Its line cannot stand.
  kUnused,       ///< It is beside a line, but does not run along it.
  kOfRun,        ///< It runs along a line, but no track can be there.
  kOfStructure,  ///< Its track is there, its tunnel or bridge is not.
  kMade,
};

/// A stretch of a way and what became of it.
struct LedgerEntry {
  double from_m{};  ///< Along the way.
  double to_m{};
  LedgerRank rank{};
  std::string reason{};

  [[nodiscard]] double length_m() const { return to_m - from_m; }
};

/// What became of a way, stretch by stretch in its order, every part of it once.
struct WayAccount {
  std::vector<LedgerEntry> track{};
  std::vector<LedgerEntry> structure{};  ///< Its tunnel or bridge; empty if it has neither.
};

/// What became of each way of a map.
[[nodiscard]] std::vector<WayAccount> AccountOfWays(const RailMap& map, const WorldsOfMap& made);

/// The rows of all platforms.
/// @param ways What became of each way.
[[nodiscard]] std::vector<AccountRow> PlatformRows(const RailMap& map,
                                                   const WorldsOfMap& made,
                                                   const std::vector<WayAccount>& ways);

/// Why something is left out at a chainage, or within a metre of it: that which came from a source,
/// or else one of which nobody knows where from.
[[nodiscard]] std::string ReasonAt(const LineWorld& world,
                                   const std::string& what,
                                   double s_m,
                                   std::size_t source);

/// What ReasonAt says where nothing was left out; there is no such place.
inline constexpr const char* kNoReason = "nothing says why";

}  // namespace railcast
