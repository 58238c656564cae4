#include "generator/randomize/random_weather.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace railcast {
namespace {

using enum WeatherFamily;

const std::vector<WeatherFamily> kAll = {kSunny, kFoggy, kRainy, kSnowy};

std::vector<double> AmountsOf(WeatherFamily family, const std::string& key) {
  std::vector<double> amounts;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    amounts.push_back(DrawWeather(1, i, {family}).section.at(key).get<double>());
  }
  return amounts;
}

TEST(RandomWeather, IsOfEachFamilyEquallyOften) {
  std::map<WeatherFamily, int> counts;
  for (std::uint32_t i = 0; i < 4000; ++i) ++counts[DrawWeather(1, i, kAll).family];
  for (const WeatherFamily family : kAll) {
    EXPECT_NEAR(counts[family], 1000, 4 * std::sqrt(4000 * 0.25 * 0.75)) << NameOf(family);
  }
}

TEST(RandomWeather, IsTheSameForTheSameSeedAndAnotherForAnother) {
  EXPECT_EQ(DrawWeather(3, 5, kAll).section, DrawWeather(3, 5, kAll).section);
  EXPECT_NE(DrawWeather(3, 5, {kFoggy}).section, DrawWeather(4, 5, {kFoggy}).section);
  EXPECT_NE(DrawWeather(3, 5, {kFoggy}).section, DrawWeather(3, 6, {kFoggy}).section);
}

TEST(RandomWeather, OfAFamilyDoesNotDependOnTheOthersToDrawFrom) {
  for (std::uint32_t i = 0; i < 100; ++i) {
    const RandomWeather of_all = DrawWeather(1, i, kAll);
    EXPECT_EQ(of_all.section, DrawWeather(1, i, {of_all.family}).section);
  }
}

// The logarithm of a log-uniform amount is uniform: its mean is the middle, with the standard error
// span / sqrt(12 N).
TEST(RandomWeather, SpreadsItsAmountsEvenlyOverTheirLogarithms) {
  const auto expect_even = [](WeatherFamily family, const std::string& key, double from,
                              double to) {
    const std::vector<double> amounts = AmountsOf(family, key);
    double sum = 0.0;
    for (const double amount : amounts) sum += std::log(amount);
    const auto [least, most] = std::ranges::minmax(amounts);
    EXPECT_GE(least, from);
    EXPECT_LE(most, to);
    const double n = static_cast<double>(amounts.size());
    EXPECT_NEAR(sum / n, 0.5 * std::log(from * to), 4.0 * std::log(to / from) / std::sqrt(12.0 * n))
        << key;
  };
  expect_even(kFoggy, "visibility_m", 30.0, 1000.0);
  expect_even(kRainy, "rain_rate_mmph", 0.5, 50.0);
  expect_even(kSnowy, "snow_rate_mmph", 0.1, 5.0);
}

TEST(RandomWeather, HasASunAsBrightAsItIsHigh) {
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Json sun = DrawWeather(1, i, {kSunny}).section.at("sun");
    const double elevation_rad = sun.at("elevation_deg").get<double>() * M_PI / 180.0;
    EXPECT_NEAR(sun.at("illuminance_klx").get<double>(), 120.0 * std::sin(elevation_rad), 0.5);
  }
}

}  // namespace
}  // namespace railcast
