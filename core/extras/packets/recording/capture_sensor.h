#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/extras/packets/ouster/ouster_decoder.h"
#include "core/extras/packets/recording/capture_metadata.h"
#include "core/extras/packets/spinning/sensor_turn.h"
#include "core/extras/packets/spinning/spinning_decoder.h"
#include "railcast/io/endpoint.h"
#include "railcast/io/recording.h"
#include "railcast/lidar.h"

namespace railcast {

/// Gives the beam of a row, 0 the lowest, from the aims of a firing cycle's loops. What has a point
/// has it on this beam: the decoders compute the same.
using BeamOfAims = std::function<RecordedBeam(std::span<const TurnAim> loops, std::uint32_t row)>;

[[nodiscard]] BeamOfAims BeamsOfSpinning(const SpinningModel& model);
[[nodiscard]] BeamOfAims BeamsOfOuster(const OusterMetadata& metadata);

/// Gives the beams of a turn's frame: RecordedFrame::beam_of.
[[nodiscard]] std::function<RecordedBeam(std::uint32_t row, std::uint32_t column)> BeamsOfTurn(
    const SensorTurn& turn, const BeamOfAims& beam_of);

/// The rows of a sensor's frames.
struct TurnShape {
  std::vector<std::int64_t> row_time_ns;  ///< Firing time of each row since its cycle began.
  IntensityBytes intensity{};
  BeamOfAims beam_of;  ///< The beams of a firing cycle.
};

/// Gives the rows by rising elevation.
[[nodiscard]] TurnShape ShapeOfTurns(const std::vector<ChannelSpec>& channels,
                                     IntensityBytes intensity,
                                     BeamOfAims beam_of);

/// Makes a grid of a turn: one column for each firing cycle that the turn holds, two slots per
/// firing if the turn is dual, and a slot without a point where a laser's distance was 0. Times are
/// known unless the sensor's clock jumped during the turn.
[[nodiscard]] RecordedFrame MakeTurnFrame(const SensorTurn& turn,
                                          const TurnShape& shape,
                                          const std::string& name);

/// The byte of a frame's intensity; nothing if it is not known what bytes mean.
[[nodiscard]] std::optional<std::uint8_t> ByteOfIntensity(float intensity, IntensityBytes bytes);

using TurnDecoder = std::variant<SpinningDecoder, OusterDecoder>;

struct CapturedDatagram;

/// Datagrams from one port to another.
struct SenderStream {
  Endpoint from;
  Endpoint to;

  bool operator==(const SenderStream&) const = default;
};

[[nodiscard]] SenderStream StreamOf(const CapturedDatagram& datagram);

/// A sensor whose packets can be decoded.
struct CaptureSensor {
  std::string name;
  std::size_t packet_size{};  ///< Payload size of its data packets.
  TurnShape shape;
  TurnDecoder decoder;
  /// The streams that its packets come in; empty: any.
  std::vector<SenderStream> streams{};
  /// Where it sends from, as `--sensor` takes it: "192.168.1.201", with a port where other sensors
  /// have that address, too.
  std::string address{};
  /// Whether most packets of one of its streams do not agree with their checksums of UDP.
  bool ignores_checksums{};
};

/// Finds out from datagrams which sensor sent them.
class SensorFinder {
 public:
  /// @param beside What is known of an Ouster sensor or an AT128, whose packets cannot be decoded
  ///   without.
  explicit SensorFinder(const CaptureMetadata& beside = {});

  /// Returns the sensor once a datagram is, or begins with, one of its packets.
  /// @throws InputError as CaptureMetadata::load_correction does.
  [[nodiscard]] std::optional<CaptureSensor> Look(std::span<const char> payload);

  /// Describes what was found if no sensor was: "got VLS-128", "got no UDP datagram", ...
  /// @param left_out As DatagramSource::remarks().
  [[nodiscard]] std::string Findings(const std::vector<Remark>& left_out) const;
  /// Why the first datagram that looks like an Ouster sensor's is none of the metadata's: "must be
  /// 8448 bytes (got 24832)". Empty if there was no such datagram or if there are no metadata.
  [[nodiscard]] const std::string& ouster_refusal() const { return ouster_refusal_; }
  /// Whether a datagram looked like an Ouster sensor's.
  [[nodiscard]] bool has_seen_ouster() const { return has_seen_ouster_; }

 private:
  std::optional<OusterMetadata> metadata_;
  LoadAt128Correction load_correction_;
  /// They use nothing of a datagram that they refuse, so that each can look at all of them.
  std::vector<CaptureSensor> probes_;
  std::size_t num_datagrams_{};
  std::size_t first_size_{};
  bool has_seen_ouster_ = false;
  std::string ouster_refusal_;
  std::string stranger_;  ///< The first sensor that was recognised but cannot be decoded.
};

struct DatagramPlace;

/// Returns the sensors whose packets can be decoded, in the order of their first packets.
///
/// A sensor is known by where its packets come from. Those that one address sends from several
/// ports, or to several, are one sensor's if they are the same packets or follow each other in
/// time.
/// @throws InputError with one line that says what was found if there is none.
[[nodiscard]] std::vector<CaptureSensor> FindSensors(const DatagramPlace& place);

/// Returns the only one of these sensors, or the one that DatagramPlace::sensor chooses.
/// @throws InputError as above, or with one line that names them.
[[nodiscard]] CaptureSensor FindSensor(const DatagramPlace& place);

}  // namespace railcast
