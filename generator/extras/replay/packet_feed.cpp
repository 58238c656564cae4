#include "generator/extras/replay/packet_feed.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {

PacketFeed::PacketFeed(PacketRecording recording,
                       std::vector<Endpoint> to,
                       double pace,
                       const ReplayedFrames& frames)
    : recording_(std::move(recording)), to_(std::move(to)), times_(pace), frames_(frames) {
  for (std::uint64_t i = 0; i < frames.start; ++i) {
    if (recording_.NextTurn().empty()) break;
  }
  LoadTurn();
  if (turn_.empty()) throw NoSuchFrame(recording_.source(), frames.start);
  first_port_ = recording_.port();
  static_cast<void>(SenderTo(first_port_));
}

std::vector<Endpoint> PacketFeed::ReceiversOf(std::uint16_t port) const {
  std::vector<Endpoint> receivers = to_;
  for (Endpoint& to : receivers) {
    if (to.port == 0 || port != first_port_) to.port = port;
  }
  return receivers;
}

std::string PacketFeed::Description() const {
  std::string text = name() + ": packets to";
  for (const Endpoint& to : ReceiversOf(first_port_)) text.append(" ").append(EndpointText(to));
  return text;
}

void PacketFeed::LoadTurn() {
  if (frames_.count == 0U) return;
  if (frames_.count) --*frames_.count;
  turn_ = recording_.NextTurn();
  for (RecordedDatagram& datagram : turn_) datagram.time_ns = times_.Of(datagram.time_ns);
}

bool PacketFeed::Load() {
  if (turn_.empty()) LoadTurn();
  if (turn_.empty()) return false;
  begin_ns_ = turn_.front().time_ns;
  return true;
}

void PacketFeed::Take(Datagrams& datagrams) {
  std::int64_t last_ns = begin_ns_;
  while (!turn_.empty() && turn_.front().time_ns - last_ns <= kPause_ns) {
    const RecordedDatagram& datagram = turn_.front();
    last_ns = datagram.time_ns;
    datagrams.Append(
        datagram.bytes,
        {.port = DatagramPort::kData, .due_ns = datagram.time_ns, .topic = datagram.port});
    turn_.pop_front();
  }
}

UdpSender& PacketFeed::SenderTo(std::uint16_t port) {
  std::unique_ptr<UdpSender>& sender = senders_[port];
  if (!sender) {
    sender = AtPlace("--to: ", [&] { return std::make_unique<UdpSender>(ReceiversOf(port), 0); });
  }
  return *sender;
}

void PacketFeed::Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items) {
  while (!items.empty()) {
    const std::uint16_t port = items.front().topic;
    const auto others =
        std::ranges::find_if(items, [&](const auto& item) { return item.topic != port; });
    const auto count = static_cast<std::size_t>(others - items.begin());
    SenderTo(port).Send(datagrams, items.first(count));
    items = items.subspan(count);
  }
}

UdpSender::Counts PacketFeed::delivered() const {
  UdpSender::Counts sum;
  for (const auto& [port, sender] : senders_) {
    sum.sent += sender->counts().sent;
    sum.refused += sender->counts().refused;
  }
  return sum;
}

std::string PacketFeed::LeftOut() const {
  const std::size_t num = recording_.num_left_out();
  return num == 0
             ? ""
             : NumberText(num) + " datagrams that were not sent by the sensors that are replayed";
}

}  // namespace railcast
