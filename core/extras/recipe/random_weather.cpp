#include "core/extras/recipe/random_weather.h"

#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

#include "core/base/random.h"
#include "core/base/units.h"

namespace railcast {
namespace {

// The draws of one weather. Each has a number of its own, so that a new one moves no other.
class Draws {
 public:
  Draws(std::uint64_t seed, std::uint32_t index) : seed_(seed), index_(index) {}

  // Uniform in [0, 1).
  [[nodiscard]] double Unit(std::uint32_t number) const {
    return UnitFloat(RandomWords(seed_, RandomUse::kRandomWeather, index_, number)[0]);
  }
  [[nodiscard]] double Uniform(std::uint32_t number, double from, double to) const {
    return Rounded(std::lerp(from, to, Unit(number)));
  }
  // Uniform in the logarithm: as many between 1 and 10 as between 10 and 100.
  [[nodiscard]] double LogUniform(std::uint32_t number, double from, double to) const {
    return Rounded(from * std::pow(to / from, Unit(number)));
  }

 private:
  // Three significant digits: nobody needs more, and files do not depend on the mathematics
  // library.
  [[nodiscard]] static double Rounded(double value) {
    std::ostringstream text;
    text << std::setprecision(3) << value;
    return std::stod(text.str());
  }

  std::uint64_t seed_;
  std::uint32_t index_;
};

// Numbers of the draws.
enum : std::uint32_t { kFamily, kAzimuth, kElevation, kDaylight, kAmount, kKind, kCover };

// Outdoors under clouds or in fog it is bright without a sun to look into.
Json Overcast(const Draws& draws, double most_klx) {
  return {{"illuminance_klx", draws.Uniform(kDaylight, 1.0, most_klx)}};
}

Json Sunny(const Draws& draws) {
  constexpr double kIlluminanceAtZenith_klx = 120.0;  // With a clear sky and sun, on level ground.
  const double elevation_deg = draws.Uniform(kElevation, 5.0, 65.0);
  const double share = std::sin(RadFromDeg(elevation_deg));
  const double illuminance_klx = std::round(kIlluminanceAtZenith_klx * share);
  return {{"sun",
           {{"illuminance_klx", illuminance_klx},
            {"azimuth_deg", draws.Uniform(kAzimuth, -180.0, 180.0)},
            {"elevation_deg", elevation_deg}}}};
}

Json Foggy(const Draws& draws) {
  return {{"visibility_m", draws.LogUniform(kAmount, 30.0, 1000.0)},
          {"wetness", draws.Uniform(kCover, 0.0, 0.5)},
          {"sun", Overcast(draws, 20.0)}};
}

Json Rainy(const Draws& draws) {
  constexpr std::array kDropSizes = {"drizzle", "marshall_palmer", "thunderstorm"};
  const auto kind = static_cast<std::size_t>(3.0 * draws.Unit(kKind));
  return {{"rain_rate_mmph", draws.LogUniform(kAmount, 0.5, 50.0)},
          {"rain_drop_sizes", kDropSizes[kind]},
          {"sun", Overcast(draws, 20.0)}};
}

Json Snowy(const Draws& draws) {
  const bool is_wet = draws.Unit(kKind) < 0.5;
  return {{"snow_rate_mmph", draws.LogUniform(kAmount, 0.1, 5.0)},
          {"snow_type", is_wet ? "wet" : "dry"},
          {"snow_cover", draws.Uniform(kCover, 0.2, 1.0)},
          {"wetness", is_wet ? 0.5 : 0.0},
          {"sun", Overcast(draws, 40.0)}};
}

}  // namespace

RandomWeather DrawWeather(std::uint64_t seed,
                          std::uint32_t index,
                          const std::vector<WeatherFamily>& families) {
  const Draws draws(seed, index);
  const auto family =
      static_cast<std::size_t>(draws.Unit(kFamily) * static_cast<double>(families.size()));
  RandomWeather weather{.family = families[family], .section = {}};
  switch (weather.family) {
    case WeatherFamily::kSunny:
      weather.section = Sunny(draws);
      break;
    case WeatherFamily::kFoggy:
      weather.section = Foggy(draws);
      break;
    case WeatherFamily::kRainy:
      weather.section = Rainy(draws);
      break;
    case WeatherFamily::kSnowy:
      weather.section = Snowy(draws);
      break;
  }
  return weather;
}

}  // namespace railcast
