#pragma once

#include <cstdint>
#include <vector>

#include "core/detect/effects/spray.h"
#include "railcast/effects.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// The span of time from a frame's first firing to its last.
struct ScanSpan {
  std::int64_t stamp_ns{};
  std::uint32_t duration_ns{};
};

/// The clouds of spray during a scan: one for every moving wagon, with which it moves. They reach
/// 0.5 m beyond its sides and 3 m up, and behind it thin out over the distance that it travels
/// within a second.
[[nodiscard]] std::vector<SprayCloud> SprayCloudsOf(const World& world,
                                                    const WeatherSpec& weather,
                                                    const ScanSpan& span,
                                                    const Transform& window_from_world);

}  // namespace railcast
