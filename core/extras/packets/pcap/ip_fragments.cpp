#include <algorithm>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/packets/pcap/pcap_reader.h"

namespace railcast {
namespace {

constexpr std::size_t kMostUnfinished = 64;
constexpr std::size_t kMostBytes = 65535;

std::string SpanOf(std::size_t begin, std::size_t end) {
  return NumberText(begin) + " to " + NumberText(end);
}

}  // namespace

IpFragments::Packet& IpFragments::PacketOf(const IpFragment& fragment) {
  // Identifications are used again, on busy networks after some seconds.
  std::erase_if(unfinished_, [&](const Packet& packet) {
    const bool is_old = fragment.time_ns - packet.time_ns > kNsPerS;
    if (is_old) GiveUp(packet);
    return is_old;
  });
  std::erase_if(finished_,
                [&](const Packet& packet) { return fragment.time_ns - packet.time_ns > kNsPerS; });
  const auto found = std::ranges::find(unfinished_, fragment.packet, &Packet::name);
  if (found != unfinished_.end()) return *found;
  if (unfinished_.size() == kMostUnfinished) {
    GiveUp(unfinished_.front());
    unfinished_.pop_front();
  }
  return unfinished_.emplace_back(Packet{.name = fragment.packet,
                                         .time_ns = fragment.time_ns,
                                         .number = fragment.number,
                                         .bytes = {},
                                         .parts = {},
                                         .end = {},
                                         .is_copy = true});
}

void IpFragments::GiveUp(const Packet& packet) {
  if (packet.is_copy) return;
  if (num_given_up_++ == 0) first_given_up_ = packet.number;
}

bool IpFragments::IsOfFinished(const IpFragment& fragment) const {
  return std::ranges::any_of(finished_, [&](const Packet& packet) {
    return packet.name == fragment.packet &&
           fragment.offset + fragment.bytes.size() <= packet.bytes.size() &&
           std::ranges::equal(
               fragment.bytes,
               std::span(packet.bytes).subspan(fragment.offset, fragment.bytes.size()));
  });
}

std::size_t IpFragments::num_torn() const {
  const auto num = std::ranges::count(unfinished_, false, &Packet::is_copy);
  return num_given_up_ + static_cast<std::size_t>(num);
}

std::size_t IpFragments::first_torn() const {
  if (num_given_up_ > 0) return first_given_up_;
  return std::ranges::find(unfinished_, false, &Packet::is_copy)->number;
}

std::optional<std::span<const char>> IpFragments::Add(const IpFragment& fragment) {
  const std::size_t begin = fragment.offset;
  const std::size_t end = begin + fragment.bytes.size();
  if (end > kMostBytes) {
    throw InputError("an IP fragment must end within 65535 bytes" + Got(end));
  }
  Packet& packet = PacketOf(fragment);
  packet.is_copy = packet.is_copy && IsOfFinished(fragment);
  const std::size_t last = packet.parts.empty() ? 0 : packet.parts.rbegin()->second.end;
  if ((packet.end && end > *packet.end) || (fragment.is_last && end < last)) {
    throw InputError("an IP fragment must lie before the end of its packet (got bytes " +
                     SpanOf(begin, end) + ", the end at " +
                     NumberText(packet.end ? *packet.end : end) + ")");
  }
  // The first part that ends behind this one's begin is the only one that may be the same.
  const auto after =
      std::ranges::find_if(packet.parts, [&](const auto& part) { return part.second.end > begin; });
  if (after != packet.parts.end() && after->first < end) {
    const bool is_same =
        after->first == begin && after->second.end == end &&
        std::ranges::equal(fragment.bytes,
                           std::span(packet.bytes).subspan(begin, fragment.bytes.size()));
    if (is_same) return std::nullopt;
    throw InputError("an IP fragment must not overlap another (got bytes " + SpanOf(begin, end) +
                     " beside " + SpanOf(after->first, after->second.end) + ")");
  }
  if (packet.bytes.size() < end) packet.bytes.resize(end);
  std::ranges::copy(fragment.bytes, packet.bytes.begin() + static_cast<std::ptrdiff_t>(begin));
  if (begin < end) packet.parts.emplace(begin, Part{end, fragment.place});
  if (fragment.is_last) packet.end = end;
  std::size_t reached = 0;
  for (const auto& [part_begin, part] : packet.parts) {
    if (part_begin == reached) reached = part.end;
  }
  if (packet.end != reached) return std::nullopt;
  pieces_.clear();
  for (const auto& [part_begin, part] : packet.parts) {
    pieces_.push_back({part.place, part.end - part_begin});
  }
  const auto place = std::ranges::find(unfinished_, &packet, [](Packet& each) { return &each; });
  finished_.splice(finished_.end(), unfinished_, place);
  if (finished_.size() > kMostUnfinished) finished_.pop_front();
  return finished_.back().bytes;
}

}  // namespace railcast
