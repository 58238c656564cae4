#pragma once

#include <string>
#include <vector>

#include "generator/extras/import/lines/line_places.h"
#include "generator/extras/import/map/rail_map.h"

namespace railcast {

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

}  // namespace railcast
