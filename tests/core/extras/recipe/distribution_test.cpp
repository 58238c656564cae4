#include "core/extras/recipe/distribution.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "core/extras/recipe/random_weather.h"
#include "core/extras/recipe/recipe.h"
#include "core/extras/recipe/scenario_draw.h"
#include "core/io/record/record_text.h"
#include "tests/core/extras/recipe/drawn_value.h"

namespace railcast {
namespace {

using testing::AllOf;
using testing::Each;
using testing::Ge;
using testing::Le;

constexpr std::uint32_t kNumDraws = 4000;

std::vector<double> DrawMany(const Distribution& distribution) {
  std::vector<double> values;
  for (std::uint32_t i = 0; i < kNumDraws; ++i) {
    values.push_back(DrawValue(distribution, KeyedDraws(3, i), "value").get<double>());
  }
  return values;
}

double ShareBelow(const std::vector<double>& values, double limit) {
  const auto num = std::count_if(values.begin(), values.end(), [&](double v) { return v < limit; });
  return static_cast<double>(num) / static_cast<double>(values.size());
}

// Five standard deviations of a share, at its widest.
const double kTolerance = 5.0 * 0.5 / std::sqrt(double{kNumDraws});

TEST(Distribution, UniformFillsItsIntervalEvenly) {
  const std::vector<double> values = DrawMany(UniformDraw{-2.0, 6.0});
  EXPECT_THAT(values, Each(AllOf(Ge(-2.0), Le(6.0))));
  EXPECT_NEAR(ShareBelow(values, 0.0), 0.25, kTolerance);
  EXPECT_NEAR(ShareBelow(values, 4.0), 0.75, kTolerance);
}

TEST(Distribution, LogUniformGivesEachDecadeAsMuch) {
  const std::vector<double> values = DrawMany(LogUniformDraw{0.1, 100.0});
  EXPECT_THAT(values, Each(AllOf(Ge(0.1), Le(100.0))));
  EXPECT_NEAR(ShareBelow(values, 1.0), 1.0 / 3.0, kTolerance);
  EXPECT_NEAR(ShareBelow(values, 10.0), 2.0 / 3.0, kTolerance);
}

TEST(Distribution, NormalHasTheSharesOfItsStandardDeviations) {
  const std::vector<double> values = DrawMany(NormalDraw{10.0, 2.0, {}, {}});
  EXPECT_NEAR(ShareBelow(values, 10.0), 0.5, kTolerance);
  EXPECT_NEAR(ShareBelow(values, 8.0), 0.158655, kTolerance);
  EXPECT_NEAR(ShareBelow(values, 14.0), 0.977250, kTolerance);
}

TEST(Distribution, TruncatedNormalKeepsItsShapeBetweenTheBounds) {
  const std::vector<double> values = DrawMany(NormalDraw{0.0, 1.0, 0.0, 2.0});
  EXPECT_THAT(values, Each(AllOf(Ge(0.0), Le(2.0))));
  // Of the standard normal distribution from 0 to 1 and from 0 to 2.
  EXPECT_NEAR(ShareBelow(values, 1.0), 0.341345 / 0.477250, kTolerance);
}

TEST(Distribution, IntegersReachBothEndsEquallyOften) {
  std::map<std::int64_t, int> counts;
  for (std::uint32_t i = 0; i < kNumDraws; ++i) {
    const Json value = DrawValue(IntegerDraw{-1.0, 2.0}, KeyedDraws(3, i), "value");
    ASSERT_TRUE(value.is_number_integer());
    ++counts[value.get<std::int64_t>()];
  }
  ASSERT_EQ(counts.size(), 4U);
  EXPECT_EQ(counts.begin()->first, -1);
  for (const auto& [value, count] : counts)
    EXPECT_NEAR(count / double{kNumDraws}, 0.25, kTolerance);
}

TEST(Distribution, ChoiceFollowsItsWeights) {
  const ChoiceDraw choice{{{"a", "b", 3}}, {{1.0, 0.0, 3.0}}};
  int num_a = 0;
  for (std::uint32_t i = 0; i < kNumDraws; ++i) {
    const Json value = DrawValue(choice, KeyedDraws(3, i), "value");
    EXPECT_NE(value, "b");
    if (value == "a") ++num_a;
  }
  EXPECT_NEAR(num_a / double{kNumDraws}, 0.25, kTolerance);
}

TEST(Distribution, DrawsOfOneNameDifferByScenarioSeedAndTurnOnly) {
  const UniformDraw uniform{0.0, 1.0};
  const Json first = DrawValue(uniform, KeyedDraws(3, 7), "value");
  EXPECT_EQ(DrawValue(uniform, KeyedDraws(3, 7), "value"), first);
  EXPECT_NE(DrawValue(uniform, KeyedDraws(4, 7), "value"), first);
  EXPECT_NE(DrawValue(uniform, KeyedDraws(3, 8), "value"), first);
  EXPECT_NE(DrawValue(uniform, KeyedDraws(3, 7), "other"), first);
  EXPECT_NE(DrawValue(uniform, KeyedDraws(3, 7), "value", 1), first);
}

TEST(Distribution, NumbersHaveNineDigits) {
  const double value = DrawValue(UniformDraw{0.0, 1.0}, KeyedDraws(1, 1), "x").get<double>();
  constexpr double kDigits = 1e9;
  EXPECT_NEAR(value * kDigits, std::round(value * kDigits), 1e-6);
}

using enum WeatherFamily;

const std::vector<WeatherFamily> kAllFamilies = {kSunny, kFoggy, kRainy, kSnowy};

std::vector<double> AmountsOf(WeatherFamily family, const std::string& key) {
  std::vector<double> amounts;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    amounts.push_back(DrawWeather(1, i, {family}).section.at(key).get<double>());
  }
  return amounts;
}

TEST(RandomWeather, IsOfEachFamilyEquallyOften) {
  std::map<WeatherFamily, int> counts;
  for (std::uint32_t i = 0; i < 4000; ++i) ++counts[DrawWeather(1, i, kAllFamilies).family];
  for (const WeatherFamily family : kAllFamilies) {
    EXPECT_NEAR(counts[family], 1000, 4 * std::sqrt(4000 * 0.25 * 0.75)) << NameOf(family);
  }
}

TEST(RandomWeather, IsTheSameForTheSameSeedAndAnotherForAnother) {
  EXPECT_EQ(DrawWeather(3, 5, kAllFamilies).section, DrawWeather(3, 5, kAllFamilies).section);
  EXPECT_NE(DrawWeather(3, 5, {kFoggy}).section, DrawWeather(4, 5, {kFoggy}).section);
  EXPECT_NE(DrawWeather(3, 5, {kFoggy}).section, DrawWeather(3, 6, {kFoggy}).section);
}

TEST(RandomWeather, OfAFamilyDoesNotDependOnTheOthersToDrawFrom) {
  for (std::uint32_t i = 0; i < 100; ++i) {
    const RandomWeather of_all = DrawWeather(1, i, kAllFamilies);
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

class RandomWeatherRecipe : public testing::Test {
 protected:
  /// Draws scenarios and counts them by family.
  void Draw(std::uint32_t num) {
    const ScenarioDrawer drawer(recipe_);
    for (std::uint32_t i = 0; i < num; ++i) {
      const DrawnScenario drawn = drawer.Draw(i);
      weathers_.emplace(DrawnOf(drawn.record, "weather"), drawn.scenario.weather);
    }
  }
  void ExpectWithin(const std::string& family, auto value, double from, double to) const {
    const auto [begin, end] = weathers_.equal_range(family);
    for (auto it = begin; it != end; ++it) {
      EXPECT_GE(value(it->second), from) << family;
      EXPECT_LE(value(it->second), to) << family;
    }
  }

  Recipe recipe_ = ReadRecipe(RAILCAST_SOURCE_DIR "/scenarios/recipes/random_weather.json");
  std::multimap<std::string, WeatherSpec> weathers_;
};

// The published RandomWeather names the four families; shares and ranges are those of
// docs/dataset.md.
TEST_F(RandomWeatherRecipe, DrawsTheFourPublishedFamiliesWithinTheirRanges) {
  constexpr std::uint32_t kNum = 200;
  Draw(kNum);
  for (const char* family : {"sunny", "foggy", "rainy", "snowy"}) {
    EXPECT_NEAR(static_cast<double>(weathers_.count(family)), 0.25 * kNum,
                4.0 * std::sqrt(kNum * 0.25 * 0.75))
        << family;
  }
  const auto sun_klx = [](const WeatherSpec& w) { return w.sun.illuminance_klx; };
  ExpectWithin(
      "sunny", [](const WeatherSpec& w) { return w.sun.elevation_deg; }, 5.0, 65.0);
  ExpectWithin("sunny", sun_klx, 10.0, 109.0);
  ExpectWithin(
      "foggy", [](const WeatherSpec& w) { return w.visibility_m.value(); }, 30.0, 1000.0);
  ExpectWithin(
      "foggy", [](const WeatherSpec& w) { return w.wetness.value(); }, 0.0, 0.5);
  ExpectWithin(
      "rainy", [](const WeatherSpec& w) { return w.rain_rate_mmph; }, 0.5, 50.0);
  ExpectWithin("rainy", sun_klx, 1.0, 20.0);
  ExpectWithin(
      "snowy", [](const WeatherSpec& w) { return w.snow_rate_mmph; }, 0.1, 5.0);
  ExpectWithin(
      "snowy", [](const WeatherSpec& w) { return w.snow_cover; }, 0.2, 1.0);
  const auto rain_and_snow_mmph = [](const WeatherSpec& w) {
    return w.rain_rate_mmph + w.snow_rate_mmph;
  };
  for (const char* dry : {"sunny", "foggy"}) ExpectWithin(dry, rain_and_snow_mmph, 0.0, 0.0);
}

}  // namespace
}  // namespace railcast
