#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "railcast/scenario.h"
#include "viewer/color/palette.h"

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

// Machado, Oliveira and Fernandes, "A physiologically-based model for simulation of color vision
// deficiency", IEEE TVCG 15(6), 2009, severity 1.0; they apply to linear RGB.
const Eigen::Matrix3d kProtan{{0.152286, 1.052583, -0.204868},
                              {0.114503, 0.786281, 0.099216},
                              {-0.003882, -0.048116, 1.051998}};
const Eigen::Matrix3d kDeutan{{0.367322, 0.860646, -0.227968},
                              {0.280085, 0.672501, 0.047413},
                              {-0.011820, 0.042940, 0.968881}};
// Linear sRGB to XYZ at D65, IEC 61966-2-1.
const Eigen::Matrix3d kXyzFromRgb{{0.4124564, 0.3575761, 0.1804375},
                                  {0.2126729, 0.7151522, 0.0721750},
                                  {0.0193339, 0.1191920, 0.9503041}};

double Linear(std::uint8_t value) {
  const double share = value / 255.0;
  return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}

/// Returns CIELAB 1976 (L*, a*, b*) of a colour relative to white, seen with the colour vision
/// `sight`.
Eigen::Vector3d Lab(const std::array<std::uint8_t, 3>& rgb, const Eigen::Matrix3d& sight) {
  const Eigen::Vector3d linear(Linear(rgb[0]), Linear(rgb[1]), Linear(rgb[2]));
  const Eigen::Vector3d seen = (sight * linear).cwiseMax(0.0).cwiseMin(1.0);
  const Eigen::Vector3d xyz =
      (kXyzFromRgb * seen).cwiseQuotient(kXyzFromRgb * Eigen::Vector3d::Ones());
  const auto f = [](double t) {
    return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
  };
  const Eigen::Vector3d part(f(xyz.x()), f(xyz.y()), f(xyz.z()));
  return {116.0 * part.y() - 16.0, 500.0 * (part.x() - part.y()), 200.0 * (part.y() - part.z())};
}

std::vector<Label> Labels() {
  return ReadLabelTable(RAILCAST_SOURCE_DIR "/scenarios/labels.json").labels();
}

/// Returns the least distance in CIELAB between the colours of two labels under normal, protan and
/// deutan vision.
double Apart(const Label& a, const Label& b) {
  double least = 1e9;
  for (const Eigen::Matrix3d& sight :
       {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), kProtan, kDeutan}) {
    least = std::min(least, (Lab(a.rgb, sight) - Lab(b.rgb, sight)).norm());
  }
  return least;
}

/// Returns whether a label is of something found along an ordinary line, so that such labels are
/// often in one picture.
bool IsAlongTheLine(const Label& label) {
  static const std::set<std::string> names = {
      "rail",         "sleeper",        "ballast", "ground", "grass",      "tree",
      "contact_wire", "messenger_wire", "dropper", "mast",   "cantilever", "wagon",
      "person",       "pole",           "object",  "signal"};
  return names.contains(label.name);
}

TEST(LabelColors, AreMeasuredAsPublished) {
  // Reference: Lindbloom's calculator gives L* 53.24, a* 80.09, b* 67.20 at D65 for sRGB 255, 0, 0.
  const Eigen::Vector3d red = Lab({255, 0, 0}, Eigen::Matrix3d::Identity());
  EXPECT_NEAR(red.x(), 53.24, 0.01);
  EXPECT_NEAR(red.y(), 80.09, 0.01);
  EXPECT_NEAR(red.z(), 67.20, 0.01);
  // Greys look the same with any colour vision, because the rows of the matrices add up to 1.
  const Eigen::Vector3d grey = Lab({128, 128, 128}, Eigen::Matrix3d::Identity());
  for (const Eigen::Matrix3d& sight : {kProtan, kDeutan}) {
    EXPECT_LT((Lab({128, 128, 128}, sight) - grey).norm(), 1e-3);
  }
}

TEST(LabelColors, AreFarApartAlongTheLineForEverySight) {
  const std::vector<Label> labels = Labels();
  EXPECT_EQ(std::ranges::count_if(labels, IsAlongTheLine), 16);
  for (const Label& a : labels) {
    for (const Label& b : labels) {
      if (a.id >= b.id || !IsAlongTheLine(a) || !IsAlongTheLine(b)) continue;
      EXPECT_GE(Apart(a, b), 16.0) << a.name << " and " << b.name;
    }
  }
}

TEST(LabelColors, AreApartForEverySight) {
  const std::vector<Label> labels = Labels();
  for (const Label& a : labels) {
    for (const Label& b : labels) {
      if (a.id < b.id) {
        EXPECT_GE(Apart(a, b), 8.0) << a.name << " and " << b.name;
      }
    }
  }
}

TEST(LabelColors, StandOutFromADarkGround) {
  for (const Label& label : Labels()) {
    const double lightness = Lab(label.rgb, Eigen::Matrix3d::Identity()).x();
    EXPECT_GE(lightness, 35.0) << label.name;
    EXPECT_LE(lightness, 92.0) << label.name << " is nearly white";
  }
}

}  // namespace
}  // namespace railcast
