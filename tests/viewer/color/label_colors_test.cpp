#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "railcast/scenario.h"

namespace railcast {
namespace {

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
  static const std::set<std::string> kNames = {
      "rail",         "sleeper",        "ballast", "ground", "grass",      "tree",
      "contact_wire", "messenger_wire", "dropper", "mast",   "cantilever", "wagon",
      "person",       "pole",           "object",  "signal"};
  return kNames.contains(label.name);
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
