#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/io/datagrams.h"
#include "core/io/net/udp.h"
#include "core/io/pcap/pcap_writer.h"
#include "railcast/frame.h"
#include "railcast/io/cloud_files.h"
#include "railcast/io/stream.h"
#include "railcast/lidar.h"
#include "railcast/scenario.h"

namespace railcast {

/// How a sensor's frames are sent.
struct SensorStreamSpec {
  std::string name;
  std::uint16_t sensor{};  ///< Its number on the vehicle.
  Protocol protocol = Protocol::kRailcast;
  std::vector<Endpoint> to;
  bool has_offload = true;  ///< As UdpSender takes it.
  std::optional<std::filesystem::path> pcap;
  FieldSelection fields;  ///< For protocol railcast only, as is the next member.
  bool has_all_slots{};
};

/// Encodes one sensor's frames and hands them to its receivers and to a capture file. If the system
/// refuses to write the capture, as on a full disk, the capture ends, but receivers continue to get
/// all frames.
class SensorStream {
 public:
  /// @param scenario The scenario with this sensor as its only one.
  /// @param pattern Scan pattern of the frames; must outlive the stream.
  /// @param run Distinguishes this start of the sensor from others in protocol railcast.
  /// @throws InputError if the sensor does not fit the protocol, a receiver cannot be sent to or
  ///   the file cannot be created.
  SensorStream(SensorStreamSpec spec,
               const ScenarioSpec& scenario,
               const ScanPattern& pattern,
               std::uint32_t run);

  [[nodiscard]] const SensorStreamSpec& spec() const { return spec_; }

  void Encode(const Frame& frame, Datagrams& datagrams) { encoder_->Encode(frame, datagrams); }
  /// Restarts with frame 0.
  void Restart(std::uint32_t run);

  /// May be called from another thread than the other functions.
  void Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items);

  /// Completes the capture file.
  void Finish();
  /// Returns why the capture ended early and how much of it there is, or nothing if it did not end
  /// early. Thread-safe.
  [[nodiscard]] std::optional<std::string> capture_fault() const;
  /// Returns the numbers of datagrams delivered to receivers.
  [[nodiscard]] UdpSender::Counts delivered() const;

 private:
  [[nodiscard]] std::unique_ptr<FrameEncoder> MakeEncoder(std::uint32_t run) const;
  /// Calls `work(capture)`; if that throws, the capture ends.
  template <typename Work>
  void UseCapture(const Work& work);

  SensorStreamSpec spec_;
  LidarSpec lidar_;
  OutputSpec output_;
  const ScanPattern& pattern_;
  std::unique_ptr<FrameEncoder> encoder_;
  std::unique_ptr<UdpSender> sender_;    ///< Null if there are no receivers.
  std::unique_ptr<PcapWriter> capture_;  ///< Null if there is no capture.
  std::uint64_t num_captured_{};         ///< Datagrams captured.
  mutable std::mutex mutex_;             ///< Guards capture_fault_.
  std::optional<std::string> capture_fault_;
};

}  // namespace railcast
