#pragma once

#include <cstdint>
#include <vector>

#include "core/scenario/json_text.h"
#include "railcast/enum_names.h"

namespace railcast {

/// The families of weather that the published system (Vir2Rail) draws from. It names them only; the
/// distributions are ours (docs/dataset.md, "Random weather").
enum class WeatherFamily { kSunny, kFoggy, kRainy, kSnowy };
template <>
inline constexpr auto kEnumNames<WeatherFamily> =
    std::to_array<EnumName<WeatherFamily>>({{WeatherFamily::kSunny, "sunny"},
                                            {WeatherFamily::kFoggy, "foggy"},
                                            {WeatherFamily::kRainy, "rainy"},
                                            {WeatherFamily::kSnowy, "snowy"}});

/// A weather and its family.
struct RandomWeather {
  WeatherFamily family{};
  Json section;  ///< Section `weather` of a scenario, with three significant digits a value.
};

/// Draws a weather: each of the families is equally probable. It depends on the arguments alone,
/// and within a family on `seed` and `index` alone.
///
///   DrawWeather(7, 0, {WeatherFamily::kRainy}).section.dump();  // {"rain_rate_mmph":1.61,...}
///
/// @pre `families` is not empty.
[[nodiscard]] RandomWeather DrawWeather(std::uint64_t seed,
                                        std::uint32_t index,
                                        const std::vector<WeatherFamily>& families);

}  // namespace railcast
