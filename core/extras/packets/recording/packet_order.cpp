#include "core/extras/packets/recording/packet_order.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string_view>

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

bool AreNear(std::int64_t azimuth, std::int64_t other) {
  constexpr std::int64_t kNear = 600;  // What a packet spans.
  return std::min(StepTo(azimuth, other), StepTo(other, azimuth)) < kNear;
}

void AddTally(PacketTally& sum, const PacketTally& tally) {
  if (tally.number == 0) return;
  sum.first = sum.number == 0 ? tally.first : std::min(sum.first, tally.first);
  sum.number += tally.number;
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
  EndSilences(next);
  const std::int64_t packet_ns = last.mark.packet_ns;
  if (packet_ns == 0 || 2 * gap < 3 * packet_ns) return;
  // A clock that jumps ahead loses nothing.
  if (gap > kNsPerS && next.packet.captured_ns - last.captured_ns < gap / 2) return;
  // Nor does what comes late, but goes on where the last one ends.
  constexpr std::int64_t kLongestTurn_ns = kNsPerS / 5;
  const std::int64_t turned = StepTo(next.mark.first_azimuth, last.mark.last_azimuth);
  if (gap < kLongestTurn_ns && 2 * turned <= 5 * last.mark.azimuth_step) return;
  Silence silence{
      .from = last.mark.last_azimuth, .to = next.mark.first_azimuth, .order = next.order};
  const double packets =
      static_cast<double>(gap - SilentNs(last.mark, gap, silence)) / static_cast<double>(packet_ns);
  const auto num_packets = std::max<std::int64_t>(std::llround(packets), 2);
  silence.lost.Count(next.packet.number, static_cast<std::size_t>(num_packets - 1));
  AddSilence(std::move(silence));
}

std::int64_t PacketOrder::SilentNs(const PacketMark& last,
                                   std::int64_t gap_ns,
                                   const Silence& within) const {
  double silent_ns = 0.0;
  for (const Silence& silence : silences_) {
    if (!silence.is_window() || last.turn_ns == 0 || silence.IsNear(within)) continue;
    const double turned = static_cast<double>(gap_ns) / static_cast<double>(last.turn_ns);
    const auto to_middle = static_cast<double>(StepTo(silence.middle(), last.first_azimuth));
    const double passes = std::floor(turned - to_middle / kAzimuthUnitsPerTurn) + 1.0;
    const auto width = static_cast<double>(StepTo(silence.to, silence.from));
    silent_ns +=
        std::max(passes, 0.0) * width / kAzimuthUnitsPerTurn * static_cast<double>(last.turn_ns);
  }
  return std::llround(silent_ns);
}

std::int64_t PacketOrder::Silence::middle() const {
  return (from + StepTo(to, from) / 2) % kAzimuthUnitsPerTurn;
}

bool PacketOrder::Silence::IsNear(const Silence& other) const {
  return AreNear(from, other.from) && AreNear(to, other.to);
}

void PacketOrder::EndSilences(const Held& next) {
  const PacketMark& mark = next.mark;
  if (mark.silent_from != mark.silent_to) {
    return AddSilence({.from = mark.silent_from, .to = mark.silent_to, .order = next.order});
  }
  const std::int64_t span = StepTo(mark.last_azimuth, mark.first_azimuth);
  if (span >= kAzimuthUnitsPerTurn / 2) return;
  std::erase_if(silences_, [&](Silence& silence) {
    const bool is_within = StepTo(silence.middle(), mark.first_azimuth) <= span;
    if (!is_within || --silence.num_turns > 0) return false;
    AddTally(lost_, silence.lost);
    return true;
  });
}

void PacketOrder::AddSilence(Silence silence) {
  const auto known =
      std::ranges::find_if(silences_, [&](const Silence& other) { return other.IsNear(silence); });
  if (known == silences_.end()) return silences_.push_back(std::move(silence));
  AddTally(known->lost, silence.lost);
  if (std::abs(silence.order - known->order) < kLessThanTurn_ns) return;
  known->order = silence.order;
  // By then, it is a window even if something is sent there afterwards.
  constexpr std::int64_t kSureTurns = 16;
  if (++known->num_turns >= kSureTurns) known->lost = {};
}

PacketTally PacketOrder::lost() const {
  PacketTally lost = lost_;
  for (const Silence& silence : silences_) {
    if (!silence.is_window()) AddTally(lost, silence.lost);
  }
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

}  // namespace railcast
