#include "viewer/color/palette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace railcast {
namespace {

std::vector<Rgb> AllColors() {
  std::vector<Rgb> colors;
  for (std::size_t i = 0; i < kOutcomeNames.size(); ++i) {
    colors.push_back(OutcomeRgb(static_cast<Outcome>(i)));
  }
  return colors;
}

/// Which cones a dichromat lacks.
enum class Missing { kRed, kGreen };

std::array<double, 3> Seen(const Rgb& rgb, Missing missing) {
  // Simulated in linear sRGB as in F. Vienot, H. Brettel, J. Mollon: Digital video colourmaps for
  // checking the legibility of displays by dichromats, Color Research and Application 24 (1999).
  std::array<double, 3> linear{};
  for (std::size_t i = 0; i < 3; ++i) linear[i] = std::pow(rgb[i] / 255.0, 2.2);
  const auto& [r, g, b] = linear;
  if (missing == Missing::kRed) {
    const double yellow = 0.11238 * r + 0.88762 * g;
    return {yellow, yellow, 0.00401 * r - 0.00401 * g + b};
  }
  const double yellow = 0.29275 * r + 0.70725 * g;
  return {yellow, yellow, -0.02234 * r + 0.02234 * g + b};
}

double Difference(const Rgb& a, const Rgb& b, Missing missing) {
  const auto seen_a = Seen(a, missing);
  const auto seen_b = Seen(b, missing);
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto displayed = [](double linear) { return std::pow(std::max(linear, 0.0), 1.0 / 2.2); };
    sum += std::pow(displayed(seen_a[i]) - displayed(seen_b[i]), 2);
  }
  return std::sqrt(sum) * 255.0;
}

TEST(OutcomeColors, DifferAlsoWithoutRedOrGreenCones) {
  // Distance of the colours as displayed; black and white are 442 apart, Okabe and Ito's blue and
  // purple 37.
  constexpr double kLeastDifference = 35.0;
  const std::vector<Rgb> colors = AllColors();
  for (std::size_t i = 0; i < colors.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      for (const Missing missing : {Missing::kRed, Missing::kGreen}) {
        EXPECT_GT(Difference(colors[i], colors[k], missing), kLeastDifference)
            << i << " " << k << (missing == Missing::kRed ? " red" : " green");
      }
    }
  }
}

TEST(OutcomeColors, HaveTitlesForLegends) {
  EXPECT_EQ(OutcomeTitle(Outcome::kBelowThreshold), "below threshold");
  EXPECT_EQ(OutcomeTitle(Outcome::kEgo), "ego");
}

}  // namespace
}  // namespace railcast
