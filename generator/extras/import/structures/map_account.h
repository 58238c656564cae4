#pragma once

#include <map>
#include <string>
#include <vector>

#include "generator/extras/import/lines/imported_line.h"
#include "generator/extras/import/lines/track_lines.h"
#include "generator/extras/import/map/rail_map.h"
#include "generator/extras/import/network/line_world.h"
#include "generator/extras/import/structures/way_ledger.h"

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

/// The rows of all platforms.
/// @param tracks What became of each way (WayLedger::Of).
[[nodiscard]] std::vector<AccountRow> PlatformRows(
    const RailMap& map,
    const WorldsOfMap& made,
    const std::vector<std::vector<LedgerEntry>>& tracks);

/// All rows of a kind as one; its reasons are without the names of tracks.
[[nodiscard]] AccountRow SumOf(const std::vector<AccountRow>& rows, const std::string& what);

/// The rows as CSV.
[[nodiscard]] std::string AccountCsv(const std::vector<AccountRow>& rows);
/// The sums of all kinds as a table to be read, and the greatest losses.
[[nodiscard]] std::string AccountTable(const std::vector<AccountRow>& rows);

}  // namespace railcast
