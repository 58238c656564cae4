#include "core/io/recording/packet_order.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>

#include "core/base/units.h"
#include "core/io/scan_fit.h"

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

bool AreNear(std::int64_t azimuth, std::int64_t other) {
  constexpr std::int64_t kNear = 600;  // What a packet spans.
  return std::min(StepTo(azimuth, other), StepTo(other, azimuth)) < kNear;
}

}  // namespace

bool PacketOrder::JoinSame(const Held& held, std::deque<Held>& others) {
  for (Held& other : others) {
    if (other.order != held.order) continue;
    // Sensors that do not count have 0.
    const bool has_both =
        held.mark.is_counted && held.mark.number != 0 && other.mark.time_ns == held.mark.time_ns;
    if (!has_both && other.packet.bytes != held.packet.bytes) continue;
    const auto& places = held.packet.places;
    other.packet.places.insert(other.packet.places.end(), places.begin(), places.end());
    doubled_.Count(held.packet.number);
    return true;
  }
  return false;
}

void PacketOrder::Add(OrderedPacket packet, const PacketMark& mark) {
  const auto order_of = [&] {
    if (!newest_) return mark.number;
    return newest_->first + NearestTo0(mark.number - newest_->first, mark.period);
  };
  Held held{std::move(packet), mark, order_of()};
  if (JoinSame(held, held_) || JoinSame(held, behind_)) return;
  const bool is_after_newest = !newest_ || held.order >= newest_->first;
  if (!is_after_newest && !mark.is_counted && GoesOn(newest_->second, mark)) {
    // The sensor's clock was set back.
    BeginAnew();
    held.order = mark.number;
  } else if (!released_.empty() && held.order < released_.back().order) {
    return AddBehind(std::move(held));
  } else if (!is_after_newest) {
    reordered_.Count(held.packet.number);
  }
  for (const Held& late : std::exchange(behind_, {})) late_.Count(late.packet.number);
  has_window_ = has_window_ || mark.has_window;
  if (!newest_ || held.order >= newest_->first) newest_ = {held.order, mark};
  const auto place = std::ranges::upper_bound(held_, held.order, {}, &Held::order);
  held_.insert(place, std::move(held));
  if (held_.size() > kWindow) ReleaseFirst();
}

void PacketOrder::AddBehind(Held held) {
  const std::size_t hash = PacketHash(held.packet.bytes);
  const bool is_known = std::ranges::any_of(released_, [&](const Released& released) {
    return released.order == held.order && released.hash == hash;
  });
  if (is_known) return doubled_.Count(held.packet.number);
  behind_.push_back(std::move(held));
  if (behind_.size() == kWindow) BeginAnew();
}

void PacketOrder::BeginAnew() {
  while (!held_.empty()) ReleaseFirst();
  released_.clear();
  newest_.reset();
  for (Held& held : std::exchange(behind_, {})) Add(std::move(held.packet), held.mark);
}

void PacketOrder::End() {
  while (!held_.empty()) ReleaseFirst();
  if (behind_.empty()) return;
  // Whether the few that are left are late, or the first after the numbers began anew.
  constexpr std::int64_t kFarPackets = 1000;
  const std::int64_t far = behind_.front().mark.is_counted ? kFarPackets : kNsPerS;
  if (newest_->first - behind_.back().order > far) {
    BeginAnew();
    while (!held_.empty()) ReleaseFirst();
  }
  for (const Held& late : std::exchange(behind_, {})) late_.Count(late.packet.number);
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
  const std::int64_t packet_ns = last.mark.packet_ns;
  if (packet_ns == 0 || 2 * gap < 3 * packet_ns || has_window_) return;
  // A clock that jumps ahead loses nothing.
  if (gap > kNsPerS && next.packet.captured_ns - last.captured_ns < gap / 2) return;
  // Nor does what comes late, but goes on where the last one ends.
  constexpr std::int64_t kLongestTurn_ns = kNsPerS / 5;
  const std::int64_t turned = StepTo(next.mark.first_azimuth, last.mark.last_azimuth);
  if (gap < kLongestTurn_ns && 2 * turned <= 5 * last.mark.azimuth_step) return;
  const std::pair gap_azimuths{last.mark.last_azimuth, next.mark.first_azimuth};
  const auto before = std::exchange(gap_, gap_azimuths);
  if (before && AreNear(before->first, gap_azimuths.first) &&
      AreNear(before->second, gap_azimuths.second)) {
    // Turn by turn, nothing is sent there.
    has_window_ = true;
    lost_ = {};
    return;
  }
  const double packets = static_cast<double>(gap) / static_cast<double>(packet_ns);
  lost_.Count(next.packet.number, static_cast<std::size_t>(std::llround(packets)) - 1);
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
  return first;
}

}  // namespace railcast
