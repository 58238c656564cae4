#include "core/simulate/returns.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "railcast/outcome.h"

namespace railcast {
namespace {

using TilePlace = EchoTiles::Place;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Outcome OutcomeOf(const TilePlace& echo) {
  return static_cast<Outcome>(echo.tile.outcome[echo.lane]);
}
float PowerOf(const TilePlace& echo) {
  return echo.tile.power_ratio[echo.lane];
}
float RangeOf(const TilePlace& echo) {
  return echo.tile.range_m[echo.lane];
}

void StoreEcho(const TilePlace& echo,
               const std::vector<Surface>& surfaces,
               bool has_shares,
               std::size_t slot,
               Frame& frame) {
  const auto& [tile, lane] = echo;
  const Surface& surface = surfaces[tile.surface[lane]];
  const bool is_clutter = tile.clutter[lane] != kNoClutter;
  frame.x[slot] = tile.x[lane];
  frame.y[slot] = tile.y[lane];
  frame.z[slot] = tile.z[lane];
  frame.intensity[slot] = tile.intensity[lane];
  frame.power_ratio[slot] = tile.power_ratio[lane];
  frame.range_m[slot] = tile.range_m[lane];
  frame.true_range_m[slot] = tile.true_range_m[lane];
  frame.outcome[slot] = OutcomeOf(echo);
  frame.label[slot] = is_clutter ? tile.clutter[lane] : surface.label;
  // Among clutter, only the physical rungs' mirror images have a surface: the one that is mirrored.
  const bool has_surface = !is_clutter || has_shares;
  frame.instance[slot] = has_surface ? surface.instance : 0;
  frame.material[slot] = has_surface ? surface.material : std::uint16_t{0};
  frame.incidence_rad[slot] = is_clutter ? kNaN : tile.incidence_rad[lane];
  // Neither a firing without a hit nor clutter has a footprint share.
  if (has_shares) {
    frame.footprint_share[slot] = tile.surface[lane] != 0 ? tile.share[lane] : kNaN;
  }
}

void StoreMixedShares(const EchoTiles& echoes, const SlotRange& slots, Frame& frame) {
  const std::size_t num_returns = frame.returns;
  for (std::size_t i = 0; i < slots.num_firings; ++i) {
    const std::size_t first_slot = slots.slots[i] * num_returns;
    std::fill_n(frame.mixed_share.begin() + static_cast<std::ptrdiff_t>(first_slot), num_returns,
                echoes.mixed_share[i]);
  }
}

/// One echo of a firing.
struct Candidate {
  DetectTile* tile{};
  std::size_t lane{};

  [[nodiscard]] TilePlace place() const { return {*tile, lane}; }
};

bool IsStronger(const Candidate& a, const Candidate& b) {
  return PowerOf(a.place()) > PowerOf(b.place());
}
bool IsNearerCandidate(const Candidate& a, const Candidate& b) {
  return RangeOf(a.place()) < RangeOf(b.place());
}
bool IsFarther(const Candidate& a, const Candidate& b) {
  return IsNearerCandidate(b, a);
}

// Moves the best of candidates [first, end) to `first`; earlier ones win ties.
template <typename IsBetter>
void BringFirst(std::vector<Candidate>& echoes, std::size_t first, const IsBetter& is_better) {
  if (first >= echoes.size()) return;
  const auto from = echoes.begin() + static_cast<std::ptrdiff_t>(first);
  // max_element returns the first of equal elements.
  const auto best = std::max_element(
      from, echoes.end(), [&](const Candidate& a, const Candidate& b) { return is_better(b, a); });
  std::iter_swap(from, best);
}

float BusyOf(const Candidate& echo) {
  return echo.tile->busy_m[echo.lane];
}

// Replaces echoes that are above the threshold without a gap by the strongest of them where one of
// them is saturated. That one is above the threshold for longest; the powers of saturated echoes
// are equal.
void JoinSaturated(float saturation_ratio, std::vector<Candidate>& detected) {
  if (!(saturation_ratio > 0.0F) || detected.size() < 2) return;
  const auto begin_m = [](const Candidate& echo) { return RangeOf(echo.place()) - BusyOf(echo); };
  std::stable_sort(detected.begin(), detected.end(),
                   [&](const Candidate& a, const Candidate& b) { return begin_m(a) < begin_m(b); });
  std::vector<Candidate> kept;
  for (std::size_t first = 0; first < detected.size();) {
    std::size_t end = first;
    std::size_t longest = first;
    bool is_saturated = false;
    float end_m = begin_m(detected[first]);
    do {
      const Candidate& echo = detected[end];
      is_saturated = is_saturated || PowerOf(echo.place()) >= saturation_ratio;
      if (BusyOf(echo) > BusyOf(detected[longest])) longest = end;
      end_m = std::max(end_m, RangeOf(echo.place()) + BusyOf(echo));
      ++end;
    } while (end < detected.size() && begin_m(detected[end]) <= end_m);
    if (is_saturated) {
      kept.push_back(detected[longest]);
    } else {
      kept.insert(kept.end(), detected.begin() + static_cast<std::ptrdiff_t>(first),
                  detected.begin() + static_cast<std::ptrdiff_t>(end));
    }
    first = end;
  }
  detected = std::move(kept);
}

// Removes the echoes that arrive while the receiver is blind after an earlier one, and sorts the
// others by range.
void PassOverBlindTime(float dead_length_m, std::vector<Candidate>& detected) {
  if (!(dead_length_m > 0.0F) || detected.size() < 2) return;
  std::stable_sort(detected.begin(), detected.end(), &IsNearerCandidate);
  float seen_m = RangeOf(detected.front().place());
  const auto is_unseen = [&](const Candidate& echo) {
    const float range_m = RangeOf(echo.place());
    if (range_m - seen_m < dead_length_m) return true;
    seen_m = range_m;
    return false;
  };
  detected.erase(std::remove_if(detected.begin() + 1, detected.end(), is_unseen), detected.end());
}

// Moves the echoes that the mode reports to the front, in slot order.
void Choose(ReturnMode mode, std::vector<Candidate>& detected) {
  switch (mode) {
    case ReturnMode::kStrongest:
      BringFirst(detected, 0, &IsStronger);
      return;
    case ReturnMode::kFirst:
      BringFirst(detected, 0, &IsNearerCandidate);
      return;
    case ReturnMode::kLast:
      BringFirst(detected, 0, &IsFarther);
      return;
    case ReturnMode::kDual:
    case ReturnMode::kTriple:
      break;
  }
  if (detected.empty()) return;
  BringFirst(detected, 0, &IsStronger);
  // Prefer the echo nearer or farther than all chosen before; otherwise take the next strongest.
  const auto is_beyond = [&](std::size_t slot, const auto& is_further) {
    return slot < detected.size() &&
           std::all_of(detected.begin(), detected.begin() + static_cast<std::ptrdiff_t>(slot),
                       [&](const Candidate& chosen) { return is_further(detected[slot], chosen); });
  };
  BringFirst(detected, 1, &IsFarther);
  if (!is_beyond(1, IsFarther)) BringFirst(detected, 1, &IsStronger);
  if (mode == ReturnMode::kDual) return;
  BringFirst(detected, 2, &IsNearerCandidate);
  if (!is_beyond(2, IsNearerCandidate)) BringFirst(detected, 2, &IsStronger);
}

// Whether the echo is that of a surface that was too weak.
bool IsLostSurface(const Candidate& echo) {
  const Outcome outcome = OutcomeOf(echo.place());
  return echo.tile->clutter[echo.lane] == kNoClutter &&
         (outcome == Outcome::kBelowThreshold || outcome == Outcome::kCoverBlocked);
}

// The share of the beam that an echo's surfaces fill; less than 0 if no surface sends it.
float FilledShare(const Candidate& echo) {
  const DetectTile& tile = *echo.tile;
  const bool has_surface = tile.surface[echo.lane] != 0 && tile.clutter[echo.lane] == kNoClutter;
  return has_surface ? tile.share[echo.lane] : -1.0F;
}

// The echo that represents a firing without returns: the strongest surface echo that was too weak
// or, if there is none, that whose surfaces fill most of the beam, the first of several.
TilePlace Missed(const std::vector<Candidate>& all) {
  const auto best =
      std::max_element(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
        const bool a_lost = IsLostSurface(a);
        const bool b_lost = IsLostSurface(b);
        return a_lost == b_lost ? PowerOf(a.place()) < PowerOf(b.place()) : b_lost;
      });
  if (IsLostSurface(*best)) return best->place();
  return std::ranges::max_element(all, {}, &FilledShare)->place();
}

}  // namespace

void ClearSlot(std::size_t slot, Frame& frame) {
  for (auto* values :
       {&frame.x, &frame.y, &frame.z, &frame.intensity, &frame.power_ratio, &frame.range_m,
        &frame.true_range_m, &frame.incidence_rad, &frame.footprint_share}) {
    (*values)[slot] = kNaN;
  }
  if (frame.has_velocity) {
    frame.radial_velocity_mps[slot] = frame.true_radial_velocity_mps[slot] = kNaN;
  }
  frame.outcome[slot] = Outcome::kNoFurtherEcho;
  frame.label[slot] = 0;
  frame.instance[slot] = 0;
  frame.material[slot] = 0;
}

std::uint32_t NumReturns(ReturnMode mode) {
  return mode == ReturnMode::kTriple ? 3 : mode == ReturnMode::kDual ? 2 : 1;
}

std::vector<TilePlace> EchoesOf(EchoTiles& echoes, std::size_t beam) {
  std::vector<TilePlace> all{{echoes.first, beam}};
  for (std::size_t i = 0; i < echoes.num_more(); ++i) {
    if (echoes.beam_of(i) == beam) all.push_back(echoes.more(i));
  }
  return all;
}

std::vector<TilePlace> ReturnsOf(const ReturnRule& rule, EchoTiles& echoes, std::size_t beam) {
  std::vector<Candidate> detected;
  for (const TilePlace& echo : EchoesOf(echoes, beam)) {
    if (HasPoint(OutcomeOf(echo))) detected.push_back({&echo.tile, echo.lane});
  }
  JoinSaturated(rule.saturation_ratio, detected);
  PassOverBlindTime(rule.dead_length_m, detected);
  Choose(rule.mode, detected);
  std::vector<TilePlace> returns;
  for (std::size_t r = 0; r < detected.size() && r < NumReturns(rule.mode); ++r) {
    returns.push_back(detected[r].place());
  }
  return returns;
}

// The return of a firing with one echo and one slot.
void ReturnStore::StoreOnlyEcho(const EchoTiles::Place& echo,
                                const std::vector<Surface>& surfaces,
                                std::size_t slot,
                                Frame& frame) const {
  StoreEcho(echo, surfaces, has_shares_, slot, frame);
  frame.return_count[slot] = HasPoint(frame.outcome[slot]) ? 1 : 0;
}

void ReturnStore::Store(EchoTiles& echoes,
                        const std::vector<Surface>& surfaces,
                        const SlotRange& slots,
                        Frame& frame,
                        const StoredEcho& stored) const {
  const std::uint32_t num_returns = frame.returns;
  if (has_shares_) StoreMixedShares(echoes, slots, frame);
  if (echoes.num_more() == 0 && num_returns == 1) {
    for (std::size_t i = 0; i < slots.num_firings; ++i) {
      StoreOnlyEcho({echoes.first, i}, surfaces, slots.slots[i], frame);
      if (stored) stored({echoes.first, i}, i, slots.slots[i]);
    }
    return;
  }
  // Link the further echoes of each firing into chains.
  constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  std::array<std::uint32_t, kTileSize> head;
  head.fill(kNone);
  std::vector<std::uint32_t> next(echoes.num_more());
  for (std::size_t i = echoes.num_more(); i-- > 0;) {
    next[i] = std::exchange(head[echoes.beam_of(i)], static_cast<std::uint32_t>(i));
  }
  std::vector<Candidate> all;
  std::vector<Candidate> detected;
  for (std::size_t i = 0; i < slots.num_firings; ++i) {
    if (head[i] == kNone && num_returns == 1) {
      StoreOnlyEcho({echoes.first, i}, surfaces, slots.slots[i], frame);
      if (stored) stored({echoes.first, i}, i, slots.slots[i]);
      continue;
    }
    all.assign(1, {&echoes.first, i});
    for (std::uint32_t k = head[i]; k != kNone; k = next[k]) {
      const TilePlace place = echoes.more(k);
      all.push_back({&place.tile, place.lane});
    }
    detected.clear();
    std::copy_if(all.begin(), all.end(), std::back_inserter(detected),
                 [](const Candidate& echo) { return HasPoint(OutcomeOf(echo.place())); });
    JoinSaturated(rule_.saturation_ratio, detected);
    PassOverBlindTime(rule_.dead_length_m, detected);
    Choose(rule_.mode, detected);
    const std::size_t first_slot = std::size_t{slots.slots[i]} * num_returns;
    const std::size_t count = std::min<std::size_t>(detected.size(), num_returns);
    for (std::size_t r = 0; r < num_returns; ++r) {
      const std::size_t slot = first_slot + r;
      frame.return_count[slot] = static_cast<std::uint8_t>(count);
      if (r > 0 && r >= count) {
        ClearSlot(slot, frame);
        continue;
      }
      const TilePlace echo = r < count ? detected[r].place() : Missed(all);
      StoreEcho(echo, surfaces, has_shares_, slot, frame);
      if (stored) stored(echo, i, slot);
    }
  }
}

}  // namespace railcast
