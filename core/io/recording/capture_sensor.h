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

#include "core/io/hesai/at128_decoder.h"
#include "core/io/hesai/hesai_decoder.h"
#include "core/io/sensor_turn.h"
#include "core/io/velodyne/velodyne_decoder.h"
#include "railcast/io/recording.h"
#include "railcast/lidar.h"

namespace railcast {

/// The meaning of a spinning sensor's intensity bytes.
enum class IntensityBytes {
  kVelodyne,  ///< Reflectivity as defined in velodyne_packet.h.
  kPercent
};

/// The rows of a sensor's frames.
struct TurnShape {
  std::vector<std::int64_t> row_time_ns;  ///< Firing time of each row since its cycle began.
  IntensityBytes intensity{};
};

/// Gives the rows by rising elevation.
[[nodiscard]] TurnShape ShapeOfTurns(const std::vector<ChannelSpec>& channels,
                                     IntensityBytes intensity);

/// Makes a grid of a turn: one column for each firing cycle that the turn holds, two slots per
/// firing if the turn is dual, and a slot without a point where a laser's distance was 0. Times are
/// known unless the sensor's clock jumped during the turn.
[[nodiscard]] RecordedFrame MakeTurnFrame(const SensorTurn& turn,
                                          const TurnShape& shape,
                                          const std::string& name);

/// A sensor whose packets can be decoded.
struct CaptureSensor {
  std::string_view name;
  std::size_t packet_size{};  ///< Payload size of its data packets.
  TurnShape shape;
  std::variant<VelodyneDecoder, HesaiDecoder, At128Decoder> decoder;
};

/// Returns the angles of the AT128 that was captured, or null if they are not at hand.
/// @throws InputError if they cannot be read.
using LoadAt128Correction = std::function<std::shared_ptr<const At128Correction>()>;

/// Finds out from datagrams which sensor sent them.
class SensorFinder {
 public:
  /// @param load_correction Called if a packet of an AT128 is seen.
  explicit SensorFinder(LoadAt128Correction load_correction);

  /// Returns the sensor once a datagram is, or begins with, one of its packets.
  /// @throws InputError as `load_correction` does.
  [[nodiscard]] std::optional<CaptureSensor> Look(std::span<const char> payload);

  /// Describes what was found if no sensor was: "got VLS-128", "got no UDP datagram", ...
  /// @param num_torn Number of datagrams of which IP fragments are missing.
  [[nodiscard]] std::string Findings(std::size_t num_torn) const;

 private:
  /// Of a datagram that they refuse they use nothing, so that each can look at all of them.
  std::vector<CaptureSensor> probes_;
  std::size_t num_datagrams_{};
  std::size_t first_size_{};
  LoadAt128Correction load_correction_;
  std::string stranger_;  ///< The first sensor that was recognised but cannot be decoded.
};

}  // namespace railcast
