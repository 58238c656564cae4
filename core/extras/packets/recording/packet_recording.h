#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/extras/packets/recording/capture_recording.h"
#include "core/extras/packets/recording/capture_sensor.h"
#include "core/extras/packets/recording/turn_reader.h"
#include "railcast/io/endpoint.h"

namespace railcast {

/// A datagram as a sensor sent it.
struct RecordedDatagram {
  std::vector<char> bytes;
  /// The port that it was sent to. Bags do not say; theirs go to where such sensors send unless
  /// told otherwise.
  std::uint16_t port{};
  std::int64_t time_ns{};  ///< When it was captured, since 1970-01-01 00:00:00 UTC.
};

/// The datagrams of the sensors of a capture, or of a bag's topic of packets, byte for byte and in
/// their order.
///
/// All that comes from a sensor's address counts, such as reports of time and position; of sensors
/// other than the first one, from their first packet of points on. What others sent is left out.
/// Packets that were captured several times or in another order remain so. Packets that
/// segmentation offload merged are cut apart.
class PacketRecording {
 public:
  /// A turn with more datagrams is returned in parts, so that memory is bounded.
  static constexpr std::size_t kMostDatagrams = 65'536;

  /// @param place Its `sensor` is the only one that is wanted; absent = all sensors.
  /// @throws InputError as OpenDatagrams().
  explicit PacketRecording(DatagramPlace place);

  /// As messages name it.
  [[nodiscard]] std::string source() const { return ShownPath(place_.source); }
  /// Name of the first sensor: "VLP-16".
  [[nodiscard]] const std::string& name() const { return turn_reader_.sensor().name; }
  /// The port that the first sensor's packets went to.
  [[nodiscard]] std::uint16_t port() const { return port_; }

  /// Returns the datagrams up to the one that completes a turn of the first sensor, which belongs
  /// to the next turn already; nothing at the end.
  /// @throws InputError where the recording is damaged.
  [[nodiscard]] std::deque<RecordedDatagram> NextTurn();

  /// Number of datagrams so far that came from others.
  [[nodiscard]] std::size_t num_left_out() const { return num_left_out_; }

 private:
  void FindFirstSender();
  [[nodiscard]] bool IsWanted(const CapturedDatagram& datagram) const;
  /// Returns nothing at the end, and where the recording is damaged behind what was kept.
  [[nodiscard]] std::optional<CapturedDatagram> NextDatagram();
  /// Returns the size of the packets of the sensor that sent it; 0 if none did.
  [[nodiscard]] std::size_t PacketSizeOf(const CapturedDatagram& datagram);
  void Take(const CapturedDatagram& datagram, std::size_t packet_size);
  void PublishRemarks() const;

  DatagramPlace place_;
  std::vector<CaptureSensor> sensors_;
  TurnReader turn_reader_;  ///< Reads the first sensor, or the only one that is wanted.
  std::unique_ptr<DatagramSource> source_;
  SensorFinder finder_;
  struct Sender {
    IpAddress address{};
    std::size_t packet_size{};
  };
  std::vector<Sender> senders_;  ///< The sensors so far.
  std::uint16_t port_{};
  std::deque<RecordedDatagram> datagrams_;
  std::uint64_t first_datagram_{};  ///< Number of their first.
  std::deque<SensorTurn> turns_;    ///< Turns of which not all datagrams were returned.
  std::size_t num_left_out_{};
  bool is_at_end_ = false;
  std::exception_ptr fault_;  ///< Why there is no further datagram.
};

}  // namespace railcast
