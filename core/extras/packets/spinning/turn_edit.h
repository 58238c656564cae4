#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/extras/packets/spinning/sensor_turn.h"

namespace railcast {

/// A return that a packet shall state in place of what was recorded.
struct EditedReturn {
  /// Index of the recorded return whose distance it has; absent: it is a new one.
  std::optional<std::uint8_t> from{};
  float range_m{};  ///< Range of a new one.
  /// As TurnPoint::intensity; absent: that of the recorded return.
  std::optional<std::uint8_t> intensity{};
  /// Photons, where packets state them; absent: in proportion to the recorded return's.
  std::optional<float> signal{};
};

/// The returns of a firing by their index.
using EditedReturns = std::array<std::optional<EditedReturn>, 2>;

/// What returns { u16 distance, u8 intensity } mean in a packet.
struct ReturnCode {
  double unit_m{};         ///< Unit of distances.
  std::uint16_t least{1};  ///< The least distance that is one.
  std::uint16_t none{};    ///< What stands for no return.
  bool has_last = true;    ///< In dual modes: whether the return of index 0 is the last.
};

/// Why a packet cannot state a range: "range must be 0.002 to 131.07 m in packets (got 150)".
[[nodiscard]] std::string RefuseRange(double range_m, double least_m, double most_m);

/// Stores the returns of a firing as packets { u16 distance, u8 intensity } state them. In dual
/// modes a lone return stands in both places, and the last is the farther one.
/// @returns Why the packet cannot state them; it is then unchanged.
[[nodiscard]] std::optional<std::string> StoreReturns(const EditedReturns& returns,
                                                      const FiringPlace& place,
                                                      const ReturnCode& code,
                                                      std::span<char> packet);

}  // namespace railcast
