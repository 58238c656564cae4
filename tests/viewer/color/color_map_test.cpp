#include "viewer/color/palette.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace railcast {
namespace {

using testing::Each;
using testing::Gt;

constexpr std::array kSequential = {ColorMap::kViridis, ColorMap::kCividis, ColorMap::kMagma};

std::string_view NameOf(ColorMap map) {
  return kColorMapNames.at(static_cast<std::size_t>(map));
}

/// Returns CIE 1976 L* of an sRGB colour (IEC 61966-2-1; CIE 15:2004): 0 for black to 100 for
/// white.
double Lightness(const Rgb& rgb) {
  std::array<double, 3> linear{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = rgb[i] / 255.0;
    linear[i] = share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
  }
  const double luminance = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
  return luminance > 216.0 / 24389.0 ? 116.0 * std::cbrt(luminance) - 16.0
                                     : 24389.0 / 27.0 * luminance;
}

/// Returns by how much each of `num_steps` equal steps is lighter than the one before.
std::vector<double> LightnessSteps(ColorMap map, int num_steps) {
  std::vector<double> steps;
  for (int i = 0; i < num_steps; ++i) {
    steps.push_back(Lightness(MapColor(map, (i + 1.0) / num_steps)) -
                    Lightness(MapColor(map, i / (1.0 * num_steps))));
  }
  return steps;
}

/// Converts a place on the published map to the place here, where the darkest fifth is left out.
double PlaceOf(double published) {
  return (published - 0.2) / 0.8;
}

TEST(ColorMap, OfAmountsGrowsLighterAllTheWay) {
  // A step of 1/64 is about 1 of L*; rounding to 8 bits changes it by 0.2 at most.
  for (const ColorMap map : kSequential) {
    EXPECT_THAT(LightnessSteps(map, 64), Each(Gt(0.0))) << NameOf(map);
  }
}

TEST(ColorMap, OfAmountsHasEvenStepsToTheEye) {
  // The maps are uniform in CAM02-UCS, which is not quite L*.
  constexpr double kGreatestUnevenness = 0.25;
  for (const ColorMap map : kSequential) {
    const std::vector<double> steps = LightnessSteps(map, 16);
    const double mean = (Lightness(MapColor(map, 1.0)) - Lightness(MapColor(map, 0.0))) / 16.0;
    for (const double step : steps) {
      EXPECT_NEAR(step / mean, 1.0, kGreatestUnevenness) << NameOf(map);
    }
  }
}

TEST(ColorMap, OfDifferencesIsAsDarkOnBothSidesOfItsLightMiddle) {
  // Half a step of 8 bits is 0.2 of L* in each channel.
  constexpr double kRounding = 0.7;
  for (int i = 0; i < 32; ++i) {
    const double low = Lightness(MapColor(ColorMap::kCoolwarm, i / 64.0));
    EXPECT_NEAR(low, Lightness(MapColor(ColorMap::kCoolwarm, 1.0 - i / 64.0)), kRounding) << i;
    EXPECT_LT(low, Lightness(MapColor(ColorMap::kCoolwarm, (i + 1) / 64.0))) << i;
  }
}

TEST(ColorMap, OfDifferencesIsBlueBelowAndRedAboveAndGreyBetween) {
  // Moreland 2009, table of the diverging map: (59, 76, 192), (221, 221, 221), (180, 4, 38).
  EXPECT_EQ(MapColor(ColorMap::kCoolwarm, 0.0), (Rgb{59, 76, 192}));
  EXPECT_EQ(MapColor(ColorMap::kCoolwarm, 0.5), (Rgb{221, 221, 221}));
  EXPECT_EQ(MapColor(ColorMap::kCoolwarm, 1.0), (Rgb{180, 4, 38}));
}

TEST(ColorMap, IsThePublishedOneOfItsName) {
  // The colours of matplotlib 3 at 1/4, 1/2, 3/4 and 1 of its 256 entries, within 1 of 255.
  const auto expect_near = [](ColorMap map, double published, const Rgb& rgb) {
    const Rgb ours = MapColor(map, PlaceOf(published));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(ours[i], rgb[i], 1.0) << NameOf(map) << " " << published << " channel " << i;
    }
  };
  expect_near(ColorMap::kViridis, 0.25, {59, 82, 139});
  expect_near(ColorMap::kViridis, 0.5, {33, 144, 140});
  expect_near(ColorMap::kViridis, 0.75, {93, 200, 99});
  expect_near(ColorMap::kViridis, 1.0, {253, 231, 37});
  expect_near(ColorMap::kMagma, 0.25, {81, 18, 124});
  expect_near(ColorMap::kMagma, 0.5, {182, 54, 121});
  expect_near(ColorMap::kMagma, 0.75, {251, 136, 97});
  expect_near(ColorMap::kMagma, 1.0, {252, 253, 191});
  expect_near(ColorMap::kCividis, 0.5, {124, 123, 120});
  expect_near(ColorMap::kCividis, 1.0, {254, 232, 56});
}

TEST(ColorMap, KeepsItsEndsColourBeyondThem) {
  for (const ColorMap map : {kSequential[0], kSequential[1], kSequential[2], ColorMap::kCoolwarm}) {
    EXPECT_EQ(MapColor(map, -7.0), MapColor(map, 0.0)) << NameOf(map);
    EXPECT_EQ(MapColor(map, 1.5), MapColor(map, 1.0)) << NameOf(map);
    EXPECT_NE(MapColor(map, 0.0), MapColor(map, 1.0)) << NameOf(map);
  }
}

}  // namespace
}  // namespace railcast
