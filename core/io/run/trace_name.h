#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace railcast {

/// What the name of an OSI trace says of it.
struct TraceNaming {
  std::string protobuf_version;  ///< "3.21.12"
  std::uint32_t num_frames{};
  std::string sensor;          ///< Other characters than letters, digits and _ become _; "" lidar.
  std::string_view extension;  ///< ".osi" or ".mcap"
};

/// The name that OSI 3.8 recommends for a trace of SensorView messages:
/// "19700101T000000Z_sv_380_32112_50_front.osi". Programs know the messages by `_sv_`. Its time is
/// that of time 0, as which simulations have the beginning of 1970.
[[nodiscard]] std::string TraceName(const TraceNaming& naming);

/// Whether TraceName() may have made the name.
[[nodiscard]] bool IsTraceName(std::string_view name);

}  // namespace railcast
