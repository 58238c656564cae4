#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/io/hesai/hesai_decoder.h"
#include "core/io/recording/turn_frame.h"
#include "core/io/velodyne/velodyne_decoder.h"

namespace railcast {

/// A sensor whose packets can be decoded.
struct CaptureSensor {
  std::string_view name;
  std::size_t packet_size{};  ///< Payload size of its data packets.
  TurnShape shape;
  std::variant<VelodyneDecoder, HesaiDecoder> decoder;
};

/// Finds out from datagrams which sensor sent them.
class SensorFinder {
 public:
  SensorFinder();

  /// Returns the sensor once a datagram is, or begins with, one of its packets.
  [[nodiscard]] std::optional<CaptureSensor> Look(std::span<const char> payload);

  /// Describes what was found if no sensor was: "got VLS-128", "got no UDP datagram", ...
  /// @param num_torn Number of datagrams of which IP fragments are missing.
  [[nodiscard]] std::string Findings(std::size_t num_torn) const;

 private:
  /// Of a datagram that they refuse they use nothing, so that each can look at all of them.
  std::vector<CaptureSensor> probes_;
  std::size_t num_datagrams_{};
  std::size_t first_size_{};
  std::string stranger_;  ///< The first sensor that was recognised but cannot be decoded.
};

}  // namespace railcast
