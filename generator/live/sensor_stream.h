#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/frame/frame.h"
#include "core/io/datagrams.h"
#include "core/io/field_selection.h"
#include "core/io/net/endpoint.h"
#include "core/io/net/udp_sender.h"
#include "core/io/pcap/pcap_writer.h"
#include "core/scan/scan_pattern.h"
#include "core/scenario/scenario_spec.h"

namespace railcast {

/// How a sensor's frames leave.
struct SensorStreamSpec {
  std::string name;
  std::uint16_t sensor{};  ///< Its number on the vehicle.
  std::string protocol = "railcast";
  std::vector<Endpoint> to;
  bool has_offload = true;  ///< As UdpSender takes it.
  std::optional<std::filesystem::path> pcap;
  FieldSelection fields;  ///< Of protocol railcast, like the next.
  bool has_all_slots{};
};

/// Encodes one sensor's frames and hands them to its receivers and to a capture file. A capture
/// that the system refuses, as on a full disk, ends; the receivers go on getting all.
class SensorStream {
 public:
  /// @param scenario With this sensor as its only one.
  /// @param pattern Of its frames; must outlive the stream.
  /// @param run Tells this start of the sensor from others in protocol railcast.
  /// @throws InputError if the sensor does not speak the protocol, a receiver cannot be sent to or
  ///   the file cannot be made.
  SensorStream(SensorStreamSpec spec,
               const ScenarioSpec& scenario,
               const ScanPattern& pattern,
               std::uint32_t run);

  [[nodiscard]] const SensorStreamSpec& spec() const { return spec_; }

  void Encode(const Frame& frame, Datagrams& datagrams) { encoder_->Encode(frame, datagrams); }
  /// Begins anew with frame 0.
  void Restart(std::uint32_t run);

  /// May be called from another thread than the others.
  void Send(const Datagrams& datagrams, std::span<const Datagrams::Item> items);

  /// Completes the capture file.
  void Finish();
  /// Why the capture ended early, and what there is of it; nothing if it did not. Thread-safe.
  [[nodiscard]] std::optional<std::string> capture_fault() const;
  /// What its receivers got.
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
  std::unique_ptr<UdpSender> sender_;    ///< Null if nobody receives.
  std::unique_ptr<PcapWriter> capture_;  ///< Null if nothing is written.
  std::uint64_t num_captured_{};         ///< Datagrams.
  mutable std::mutex mutex_;             ///< Of what follows.
  std::optional<std::string> capture_fault_;
};

}  // namespace railcast
