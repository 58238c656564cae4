#pragma once

#include "railcast/enum_names.h"

namespace railcast {

/// A side of a track, seen towards increasing chainage.
enum class TrackSide { kLeft, kRight };
template <>
inline constexpr auto kEnumNames<TrackSide> =
    std::to_array<EnumName<TrackSide>>({{TrackSide::kLeft, "left"}, {TrackSide::kRight, "right"}});

/// +1 for left, -1 for right: the sign of d.
[[nodiscard]] constexpr double SignOf(TrackSide side) {
  return side == TrackSide::kLeft ? 1.0 : -1.0;
}

}  // namespace railcast
