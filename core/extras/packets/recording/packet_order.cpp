#include "core/extras/packets/recording/packet_order.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <string_view>
#include <utility>

#include "core/base/units.h"
#include "core/extras/packets/spinning/scan_fit.h"

namespace railcast {
namespace {

/// A difference of numbers that begin anew after a period: the one nearest to 0.
std::int64_t NearestTo0(std::int64_t difference, std::int64_t period) {
  if (period == 0) return difference;
  difference %= period;
  if (2 * difference > period) return difference - period;
  return 2 * difference <= -period ? difference + period : difference;
}

std::size_t PacketHash(const std::vector<char>& bytes) {
  return std::hash<std::string_view>{}({bytes.data(), bytes.size()});
}

/// Whether the azimuths go on where those of another packet end, a few packets being lost between.
bool GoesOn(const PacketMark& before, const PacketMark& mark) {
  constexpr std::int64_t kEighthOfTurn = kAzimuthUnitsPerTurn / 8;
  const std::int64_t step = StepTo(mark.first_azimuth, before.last_azimuth);
  return mark.azimuth_step > 0 && step > 0 && step < kEighthOfTurn;
}

constexpr std::int64_t kLessThanTurn_ns = kNsPerS / 40;

constexpr std::int64_t kLeastWindow = 2000;  // In 0.01 deg.
constexpr std::int64_t kBin = 10;            // In the same unit.

void AddTally(PacketTally& sum, const PacketTally& tally) {
  if (tally.number == 0) return;
  sum.first = sum.number == 0 ? tally.first : std::min(sum.first, tally.first);
  sum.number += tally.number;
}

using ArcParts = std::vector<std::pair<std::int64_t, std::int64_t>>;

/// The azimuths of a packet's blocks: from, to.
ArcParts PartsOf(const PacketMark& mark) {
  if (mark.silent_from != mark.silent_to) {
    return {{mark.first_azimuth, mark.silent_from}, {mark.silent_to, mark.last_azimuth}};
  }
  const std::int64_t span = StepTo(mark.last_azimuth, mark.first_azimuth);
  if (span >= kAzimuthUnitsPerTurn / 2) return {};
  return {{mark.first_azimuth, mark.last_azimuth}};
}

/// The least number that this share of them does not exceed; 0 of none.
std::int64_t Quantile(const std::map<std::int64_t, std::size_t>& numbers, double share) {
  std::size_t total = 0;
  for (const auto& [number, count] : numbers) total += count;
  std::size_t below = 0;
  for (const auto& [number, count] : numbers) {
    below += count;
    if (static_cast<double>(below) >= share * static_cast<double>(total)) return number;
  }
  return 0;
}

}  // namespace

bool PacketOrder::JoinSame(const Held& held, std::deque<Held>& others) {
  for (Held& other : others) {
    if (other.order != held.order) continue;
    // Sensors that do not count have 0.
    const bool has_both = held.mark.is_counted && held.mark.number != 0 && held.mark.time_ns != 0 &&
                          other.mark.time_ns == held.mark.time_ns;
    if (!has_both && other.packet.bytes != held.packet.bytes) continue;
    const auto& places = held.packet.places;
    other.packet.places.insert(other.packet.places.end(), places.begin(), places.end());
    doubled_.Count(held.packet.number);
    return true;
  }
  return false;
}

bool PacketOrder::IsKnown(const Held& held) const {
  if (released_.empty() || held.order > released_.back().order) return false;
  const std::size_t hash = PacketHash(held.packet.bytes);
  return std::ranges::any_of(released_, [&](const Released& released) {
    return released.order == held.order && released.hash == hash;
  });
}

bool PacketOrder::MayBeSetBack(const Held& held) const {
  if (held.mark.is_counted || !newest_) return false;
  if (set_back_.empty()) {
    return held.order < newest_->first && GoesOn(newest_->second, held.mark);
  }
  const std::int64_t step = held.order - set_back_.back().order;
  return step > 0 && step < kLessThanTurn_ns && GoesOn(set_back_.back().mark, held.mark);
}

void PacketOrder::AddSetBack(Held held) {
  set_back_.push_back(std::move(held));
  // A packet that is late by nearly a turn goes on, too, but none after it.
  constexpr std::size_t kSurePackets = 3;
  if (set_back_.size() < kSurePackets) return;
  std::deque<Held> packets = std::exchange(set_back_, {});
  BeginAnew();
  for (Held& packet : packets) Add(std::move(packet.packet), packet.mark);
}

void PacketOrder::CheckNumber(PacketMark& mark) {
  const bool is_zero = mark.is_counted && mark.number == 0 && mark.azimuth_step > 0;
  if (is_zero && !ignores_numbers_ && zero_ns_ && *zero_ns_ != mark.time_ns) {
    ignores_numbers_ = true;
    BeginAnew();
  }
  zero_ns_ = is_zero ? std::optional(mark.time_ns) : std::nullopt;
  if (!ignores_numbers_ || !mark.is_counted) return;
  mark.is_counted = false;
  mark.number = mark.time_ns;
  mark.period = mark.time_period_ns;
}

void PacketOrder::Add(OrderedPacket packet, PacketMark mark) {
  CheckNumber(mark);
  if (!mark.has_number && !newest_) return ready_.push_back(std::move(packet));
  const auto order_of = [&] {
    if (!newest_) return mark.number;
    if (!mark.has_number) return newest_->first + 1;
    return newest_->first + NearestTo0(mark.number - newest_->first, mark.period);
  };
  Held held{std::move(packet), mark, order_of()};
  if (JoinSame(held, held_) || JoinSame(held, behind_) || JoinSame(held, set_back_)) return;
  if (IsKnown(held)) return doubled_.Count(held.packet.number);
  if (MayBeSetBack(held)) return AddSetBack(std::move(held));
  for (Held& late : std::exchange(set_back_, {})) Place(std::move(late));
  Place(std::move(held));
}

void PacketOrder::Place(Held held) {
  // Where a clock stands still, packets come in their order.
  const auto is_late = [&](std::int64_t last) {
    return held.mark.is_counted ? held.order <= last : held.order < last;
  };
  if (!released_.empty() && is_late(released_.back().order)) {
    behind_.push_back(std::move(held));
    if (behind_.size() == kWindow) BeginAnew();
    return;
  }
  const bool is_after_newest = !newest_ || held.order >= newest_->first;
  if (!is_after_newest) reordered_.Count(held.packet.number);
  for (const Held& late : std::exchange(behind_, {})) late_.Count(late.packet.number);
  if (is_after_newest) newest_ = {held.order, held.mark};
  const auto place = std::ranges::upper_bound(held_, held.order, {}, &Held::order);
  held_.insert(place, std::move(held));
  if (held_.size() > kWindow) ReleaseFirst();
}

void PacketOrder::BeginAnew() {
  while (!held_.empty()) ReleaseFirst();
  released_.clear();
  newest_.reset();
  for (Held& held : std::exchange(behind_, {})) Add(std::move(held.packet), held.mark);
}

void PacketOrder::End() {
  ReleaseAll();
  if (behind_.empty()) return;
  // Whether the few that are left are late, or the first after the numbers began anew.
  constexpr std::int64_t kFarPackets = 1000;
  const std::int64_t far = behind_.front().mark.is_counted ? kFarPackets : kNsPerS;
  if (newest_->first - behind_.back().order > far) {
    BeginAnew();
    ReleaseAll();
  }
  for (const Held& late : std::exchange(behind_, {})) late_.Count(late.packet.number);
}

void PacketOrder::ReleaseAll() {
  while (!set_back_.empty()) {
    for (Held& held : std::exchange(set_back_, {})) Place(std::move(held));
  }
  while (!held_.empty()) ReleaseFirst();
}

void PacketOrder::ReleaseFirst() {
  Held& first = held_.front();
  if (!released_.empty()) CountLost(first);
  released_.push_back(
      {first.order, first.packet.captured_ns, PacketHash(first.packet.bytes), first.mark});
  constexpr std::size_t kMostReleased = 1024;
  if (released_.size() > kMostReleased) released_.pop_front();
  ready_.push_back(std::move(first.packet));
  held_.pop_front();
}

void PacketOrder::CountLost(const Held& next) {
  const Released& last = released_.back();
  const std::int64_t gap = next.order - last.order;
  if (next.mark.is_counted) {
    // No sensor sends a packet each microsecond: its numbers have begun anew.
    const bool can_be = gap < 1000 || gap < (next.mark.time_ns - last.mark.time_ns) / kNsPerUs;
    if (gap > 1 && can_be) lost_.Count(next.packet.number, static_cast<std::size_t>(gap - 1));
    return;
  }
  missing_.Look(last.mark, next.mark, gap, next.packet.captured_ns - last.captured_ns,
                next.packet.number);
}

PacketTally PacketOrder::lost() const {
  PacketTally lost = missing_.lost();
  AddTally(lost, lost_);
  return lost;
}

std::optional<OrderedPacket> PacketOrder::Next() {
  if (ready_.empty()) return std::nullopt;
  OrderedPacket packet = std::move(ready_.front());
  ready_.pop_front();
  return packet;
}

std::optional<std::uint64_t> PacketOrder::first_held_datagram() const {
  std::optional<std::uint64_t> first;
  const auto look = [&](const OrderedPacket& packet) {
    for (const PacketPlace& place : packet.places) {
      first = std::min(first.value_or(place.datagram), place.datagram);
    }
  };
  for (const OrderedPacket& packet : ready_) look(packet);
  for (const Held& held : held_) look(held.packet);
  for (const Held& held : behind_) look(held.packet);
  for (const Held& held : set_back_) look(held.packet);
  return first;
}

std::int64_t MissingPackets::Arc::width() const {
  return StepTo(to, from);
}

std::int64_t MissingPackets::Arc::middle() const {
  return (from + width() / 2) % kAzimuthUnitsPerTurn;
}

bool MissingPackets::Arc::Holds(std::int64_t azimuth) const {
  return StepTo(azimuth, from) <= width();
}

bool MissingPackets::Arc::IsAllOf(const Arc& other, std::int64_t most) const {
  return StepTo(from, other.from) <= most && StepTo(other.to, to) <= most;
}

double MissingPackets::Gap::NumPasses(const Arc& window) const {
  const auto to_middle = static_cast<double>(StepTo(window.middle(), begin));
  return std::max(std::floor(turns - to_middle / kAzimuthUnitsPerTurn) + 1.0, 0.0);
}

double MissingPackets::TurnNs(const PacketMark& mark) const {
  return turned_ > 0.0 ? turned_ns_ / turned_ : static_cast<double>(mark.turn_ns);
}

void MissingPackets::Look(const PacketMark& last,
                          const PacketMark& next,
                          std::int64_t gap_ns,
                          std::int64_t captured_ns,
                          std::size_t number) {
  if (std::exchange(has_begun_, true)) {
    EndWindows(next);
  } else {
    Cover(last);
  }
  Turn(last, next, gap_ns);
  Cover(next);
  // More are not needed to know a window, and no more are kept.
  constexpr std::size_t kMostTurns = 32;
  constexpr std::size_t kMostGaps = 4096;
  if (num_turns_ >= kMostTurns || gaps_.size() >= kMostGaps) Settle();
  if (last.packet_ns == 0) return;
  const double turn_ns = TurnNs(last);
  const auto elapsed_ns = static_cast<double>(gap_ns);
  // A clock that jumps ahead loses nothing.
  const bool has_jumped = gap_ns > kNsPerS && captured_ns < gap_ns / 2;
  // Nor does what comes late, but goes on where the last one ends.
  constexpr std::int64_t kLongestTurn_ns = kNsPerS / 5;
  const std::int64_t turned = StepTo(next.first_azimuth, last.last_azimuth);
  const bool goes_on = gap_ns < kLongestTurn_ns && (turn_ns == 0.0 || elapsed_ns < turn_ns) &&
                       2 * turned <= 5 * last.azimuth_step;
  if (2 * gap_ns < 3 * last.packet_ns || has_jumped || goes_on) {
    ++num_missing_[0];
    return;
  }
  const auto packet_ns = static_cast<double>(last.packet_ns);
  const Gap gap{.begin = last.first_azimuth,
                .arc = {last.last_azimuth, next.first_azimuth},
                .turns = turn_ns > 0.0 ? elapsed_ns / turn_ns : 0.0,
                .packets = elapsed_ns / packet_ns - 1.0,
                .number = number};
  const double silent_turns = gap.turns * gap.packets / (gap.packets + 1.0);
  if (silent_turns * kAzimuthUnitsPerTurn >= kLeastWindow) return gaps_.push_back(gap);
  const auto num = std::max<std::int64_t>(std::llround(gap.packets), 1);
  ++num_missing_[num];
  lost_.Count(number, static_cast<std::size_t>(num));
}

void MissingPackets::Turn(const PacketMark& last, const PacketMark& next, std::int64_t gap_ns) {
  if (next.first_azimuth < last.first_azimuth) ++num_turns_;
  // By then, it cannot have made a whole turn.
  if (gap_ns <= 0 || 4 * gap_ns >= last.turn_ns) return;
  turned_ +=
      static_cast<double>(StepTo(next.first_azimuth, last.first_azimuth)) / kAzimuthUnitsPerTurn;
  turned_ns_ += static_cast<double>(gap_ns);
  constexpr double kOfLate = 16.0;
  if (turned_ < kOfLate) return;
  turned_ /= 2.0;
  turned_ns_ /= 2.0;
}

void MissingPackets::Cover(const PacketMark& mark) {
  if (mark.silent_from != mark.silent_to) AddWindow({mark.silent_from, mark.silent_to}, mark);
  for (const auto& [from, to] : PartsOf(mark)) {
    const std::int64_t num = (from % kBin + StepTo(to, from)) / kBin;
    for (std::int64_t i = 0; i <= num; ++i) {
      is_covered_[(static_cast<std::size_t>(from / kBin + i)) % kNumBins] = true;
    }
  }
}

void MissingPackets::EndWindows(const PacketMark& mark) {
  const ArcParts parts = PartsOf(mark);
  const auto has_ended = [&](const Window& window) {
    return std::ranges::any_of(parts, [&](const auto& part) {
      return Arc{part.first, part.second}.Holds(window.arc.middle());
    });
  };
  if (std::ranges::none_of(windows_, has_ended)) return;
  Settle();
  std::erase_if(windows_, has_ended);
}

void MissingPackets::AddWindow(const Arc& arc, const PacketMark& mark) {
  const double turns = static_cast<double>(arc.width() - mark.azimuth_step) / kAzimuthUnitsPerTurn;
  // A wrong azimuth makes a gap within a packet, too, but once, and where others have blocks.
  Window window{.arc = arc,
                .packets = turns * TurnNs(mark) / static_cast<double>(mark.packet_ns),
                .is_certain = !IsCovered(arc)};
  const auto known = std::ranges::find_if(
      windows_, [&](const Window& other) { return other.arc.Holds(arc.middle()); });
  if (known == windows_.end()) return windows_.push_back(window);
  constexpr std::int64_t kMostApart = 600;
  const Arc before = known->arc;
  window.is_certain = true;
  const bool is_same = known->is_certain && std::abs(before.width() - arc.width()) < kMostApart;
  if (!is_same) Settle();
  for (Window& other : windows_) {
    if (other.arc.Holds(arc.middle())) other = window;
  }
}

void MissingPackets::Settle() {
  const std::vector<Window> windows = Windows();
  AddTally(lost_, CountLost(windows));
  std::erase_if(windows_, [](const Window& window) { return window.is_certain; });
  windows_.insert(windows_.end(), windows.begin(), windows.end());
  gaps_.clear();
  is_covered_.assign(kNumBins, false);
  num_turns_ = 0;
}

bool MissingPackets::IsCovered(const Arc& arc) const {
  return is_covered_[static_cast<std::size_t>(arc.middle() / kBin)];
}

PacketTally MissingPackets::CountLost(const std::vector<Window>& windows) const {
  PacketTally lost;
  for (const Gap& gap : gaps_) {
    double packets = gap.packets;
    bool is_window = false;
    for (const Window& window : windows) {
      packets -= gap.NumPasses(window.arc) * window.packets;
      is_window = is_window || (gap.turns < 1.0 && window.arc.IsAllOf(gap.arc, window.slack));
    }
    const std::int64_t num = is_window ? 0 : std::max<std::int64_t>(std::llround(packets), 0);
    lost.Count(gap.number, static_cast<std::size_t>(num));
  }
  return lost;
}

std::vector<MissingPackets::Arc> MissingPackets::SilentArcs() const {
  std::vector<Arc> arcs;
  const auto first =
      static_cast<std::size_t>(std::ranges::find(is_covered_, true) - is_covered_.begin());
  std::size_t begin = first;
  for (std::size_t bin = first + 1; bin <= first + kNumBins && first < kNumBins; ++bin) {
    if (!is_covered_[bin % kNumBins]) continue;
    if (static_cast<std::int64_t>(bin - begin - 1) * kBin >= kLeastWindow) {
      arcs.push_back({static_cast<std::int64_t>((begin + 1) % kNumBins) * kBin,
                      static_cast<std::int64_t>(bin % kNumBins) * kBin});
    }
    begin = bin;
  }
  return arcs;
}

std::vector<MissingPackets::Window> MissingPackets::Windows() const {
  std::vector<Window> windows;
  std::ranges::copy_if(windows_, std::back_inserter(windows), &Window::is_certain);
  const std::vector<Arc> arcs = SilentArcs();
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    const bool is_apart = StepTo(arcs[(i + 1) % arcs.size()].from, arcs[i].to) >= kLeastWindow;
    if (arcs.size() > 2 || !is_apart) return windows;
  }
  for (const Arc& arc : arcs) {
    const bool is_known = std::ranges::any_of(
        windows_, [&](const Window& window) { return arc.Holds(window.arc.middle()); });
    const auto window = is_known ? std::nullopt : WindowAt(arc);
    if (window) windows.push_back(*window);
  }
  return windows;
}

std::optional<MissingPackets::Window> MissingPackets::WindowAt(const Arc& arc) const {
  std::vector<const Gap*> gaps;
  auto num_missing = num_missing_;
  for (const Gap& gap : gaps_) {
    if (!arc.Holds(gap.arc.middle())) ++num_missing[std::llround(gap.packets)];
    if (gap.turns < 1.0 && gap.NumPasses(arc) == 1.0) gaps.push_back(&gap);
  }
  const std::int64_t most_missing = Quantile(num_missing, 0.9);
  // Where nothing else is missing, edges that wander say that there is no window, but slowly.
  if (gaps.size() < (most_missing > 0 ? 4U : 5U)) return std::nullopt;
  const double packet = kAzimuthUnitsPerTurn * gaps[0]->turns / (gaps[0]->packets + 1.0);
  const auto slack = [&](std::int64_t num_packets) {
    return 2 * kBin + std::llround(packet * static_cast<double>(num_packets + 1));
  };
  const std::int64_t most = slack(most_missing);
  if (arc.width() < 2 * most) return std::nullopt;
  const auto apart =
      std::ranges::partition(gaps, [&](const Gap* gap) { return arc.IsAllOf(gap->arc, most); });
  if (2 * std::ranges::ssize(apart) > std::ranges::distance(gaps.begin(), apart.begin())) {
    return std::nullopt;
  }
  // What is missing regularly is missing there, too.
  const std::int64_t usual = Quantile(num_missing, 0.5);
  const auto middle = gaps.begin() + std::ranges::distance(gaps.begin(), apart.begin()) / 2;
  std::ranges::nth_element(gaps.begin(), middle, apart.begin(), {}, &Gap::packets);
  return Window{.arc = arc,
                .packets = (*middle)->packets - static_cast<double>(usual),
                .slack = usual == 0 ? slack(0) : 0};
}

PacketTally MissingPackets::lost() const {
  PacketTally lost = lost_;
  AddTally(lost, CountLost(Windows()));
  return lost;
}

}  // namespace railcast
