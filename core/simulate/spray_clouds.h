#pragma once

#include <cstdint>
#include <vector>

#include "core/detect/spray.h"
#include "railcast/effects.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// The clouds of spray at a time: one for every moving wagon. They reach 0.5 m beyond its sides and
/// 3 m up, and behind it thin out over the distance that it travels within a second.
[[nodiscard]] std::vector<SprayCloud> SprayCloudsOf(const World& world,
                                                    const WeatherSpec& weather,
                                                    std::int64_t time_ns,
                                                    const Transform& window_from_world);

}  // namespace railcast
