#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/io/hesai/pandar64_decoder.h"
#include "core/io/recording/turn_frame.h"
#include "core/io/velodyne/velodyne_decoder.h"

namespace railcast {

/// A sensor whose packets we can decode.
struct CaptureSensor {
  std::string_view name;
  std::size_t packet_size{};  ///< Of the payload of its data packets.
  TurnShape shape;
  std::variant<VelodyneDecoder, Pandar64Decoder> decoder;
};

/// Finds out from datagrams which sensor sent them.
class SensorFinder {
 public:
  /// The sensor, once a datagram is one of its packets, or begins with one.
  [[nodiscard]] std::optional<CaptureSensor> Look(std::span<const char> payload);

  /// What came if none did: "got VLS-128", "got no UDP datagram", ...
  [[nodiscard]] std::string Findings() const;

 private:
  std::size_t num_datagrams_{};
  std::size_t first_size_{};
  std::string stranger_;  ///< The first of a sensor that we know but cannot decode.
};

}  // namespace railcast
