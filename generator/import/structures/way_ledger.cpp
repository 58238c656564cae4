#include "generator/import/structures/way_ledger.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "generator/import/lines/track_lines.h"

namespace railcast {

WayLedger::WayLedger(const RailMap& map) : map_(map), entries_(map.ways.size()) {
  for (const MapWay& way : map.ways) {
    std::vector<double> along_m{0.0};
    for (std::size_t i = 1; i < way.nodes.size(); ++i) {
      along_m.push_back(
          along_m.back() +
          (map.nodes[way.nodes[i]].place_m - map.nodes[way.nodes[i - 1]].place_m).norm());
    }
    along_m_.push_back(std::move(along_m));
  }
}

double WayLedger::PlaceOn_m(std::size_t way, std::size_t node, std::size_t other) const {
  const std::vector<std::size_t>& nodes = map_.ways[way].nodes;
  const auto apart = [&](std::size_t i) {
    std::size_t least = nodes.size();
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (nodes[k] == other) least = std::min(least, k > i ? k - i : i - k);
    }
    return least;
  };
  // Of a node that the way passes twice, the place next to the other node counts.
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i] == node && (!found || apart(i) < apart(*found))) found = i;
  }
  if (found) return along_m_[way][*found];
  const auto off_m = [&](std::size_t end) {
    return (map_.nodes[end].place_m - map_.nodes[node].place_m).norm();
  };
  return off_m(nodes.front()) <= off_m(nodes.back()) ? 0.0 : along_m_[way].back();
}

void WayLedger::Book(const WayStep& step, double from_share, double to_share, LedgerEntry entry) {
  const double from_m = PlaceOn_m(step.way, step.from, step.to);
  const double to_m = PlaceOn_m(step.way, step.to, step.from);
  std::tie(entry.from_m, entry.to_m) =
      std::minmax({std::lerp(from_m, to_m, from_share), std::lerp(from_m, to_m, to_share)});
  entries_[step.way].push_back(std::move(entry));
}

std::vector<LedgerEntry> WayLedger::Of(std::size_t way, const std::string& otherwise) const {
  const std::vector<LedgerEntry>& entries = entries_[way];
  std::vector<double> places_m{0.0, along_m_[way].back()};
  for (const LedgerEntry& entry : entries) {
    places_m.insert(places_m.end(), {entry.from_m, entry.to_m});
  }
  std::ranges::sort(places_m);
  std::vector<LedgerEntry> parts;
  std::vector<const LedgerEntry*> strongest;
  for (std::size_t i = 0; i + 1 < places_m.size(); ++i) {
    if (places_m[i + 1] <= places_m[i]) continue;
    const double middle_m = 0.5 * (places_m[i] + places_m[i + 1]);
    const LedgerEntry* best = nullptr;
    for (const LedgerEntry& entry : entries) {
      if (middle_m < entry.from_m || middle_m > entry.to_m) continue;
      if (best == nullptr || entry.rank >= best->rank) best = &entry;
    }
    parts.push_back({places_m[i], places_m[i + 1], LedgerRank::kOfLine, otherwise});
    strongest.push_back(best);
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
