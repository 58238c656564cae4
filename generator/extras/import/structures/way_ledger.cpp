#include "generator/extras/import/structures/way_ledger.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "generator/extras/import/lines/track_lines.h"

namespace railcast {

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

}  // namespace railcast
