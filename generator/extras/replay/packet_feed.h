#pragma once

#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "core/extras/packets/recording/packet_recording.h"
#include "generator/extras/replay/replay_feed.h"
#include "railcast/io/stream.h"

namespace railcast {

/// Sends the datagrams of recorded sensors as they are. A frame is a turn of the first sensor, or
/// the part of it before a pause of over a second.
class PacketFeed final : public ReplayFeed {
 public:
  static constexpr std::int64_t kPause_ns = 1'000'000'000;

  /// @param to Receivers. A port takes the place of the one that the first sensor's packets were
  ///   sent to; 0 = as recorded. All other ports are as recorded.
  /// @throws InputError if there is nothing to send, or a receiver cannot be sent to.
  PacketFeed(PacketRecording recording,
             std::vector<Endpoint> to,
             double pace,
             const ReplayedFrames& frames);

  [[nodiscard]] std::string name() const override { return recording_.name(); }
  [[nodiscard]] std::string Description() const override;
  [[nodiscard]] bool Load() override;
  [[nodiscard]] std::int64_t begin_ns() const override { return begin_ns_; }
  void Take(Datagrams& datagrams) override;
  void Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items) override;
  [[nodiscard]] UdpSender::Counts delivered() const override;
  [[nodiscard]] std::string LeftOut() const override;

 private:
  void LoadTurn();
  /// The receivers of what was sent to a port.
  [[nodiscard]] std::vector<Endpoint> ReceiversOf(std::uint16_t port) const;
  [[nodiscard]] UdpSender& SenderTo(std::uint16_t port);

  PacketRecording recording_;
  std::vector<Endpoint> to_;
  ReplayTimes times_;
  ReplayedFrames frames_;
  std::deque<RecordedDatagram> turn_;  ///< What is left of it, with the times of the replay.
  std::int64_t begin_ns_{};
  std::uint16_t first_port_{};  ///< As recorded, of the first sensor's packets.
  std::map<std::uint16_t, std::unique_ptr<UdpSender>> senders_;  ///< By recorded port.
};

}  // namespace railcast
