#include "viewer/color/palette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace railcast {
namespace {

using Anchors = std::array<Rgb, 17>;

// Each map is sampled at 0, 1/16, ..., 1.
constexpr Anchors kViridis = {{{68, 1, 84},
                               {72, 24, 106},
                               {71, 45, 123},
                               {66, 64, 134},
                               {59, 82, 139},
                               {51, 99, 141},
                               {44, 114, 142},
                               {38, 129, 142},
                               {33, 144, 140},
                               {31, 159, 136},
                               {40, 174, 128},
                               {62, 188, 116},
                               {93, 201, 99},
                               {130, 211, 76},
                               {171, 220, 50},
                               {213, 226, 26},
                               {253, 231, 37}}};
constexpr Anchors kCividis = {{{0, 34, 78},
                               {0, 46, 106},
                               {26, 56, 111},
                               {50, 67, 109},
                               {67, 78, 108},
                               {82, 89, 109},
                               {97, 101, 111},
                               {111, 112, 115},
                               {124, 123, 120},
                               {139, 135, 120},
                               {155, 147, 118},
                               {171, 160, 114},
                               {187, 173, 108},
                               {204, 186, 100},
                               {221, 201, 88},
                               {239, 215, 72},
                               {254, 232, 56}}};
constexpr Anchors kMagma = {{{0, 0, 4},
                             {10, 8, 34},
                             {29, 17, 70},
                             {54, 16, 106},
                             {80, 18, 124},
                             {105, 28, 129},
                             {130, 38, 129},
                             {156, 46, 127},
                             {182, 55, 121},
                             {207, 65, 112},
                             {230, 81, 99},
                             {245, 105, 92},
                             {251, 135, 97},
                             {254, 165, 113},
                             {254, 195, 135},
                             {253, 224, 162},
                             {252, 253, 191}}};
constexpr Anchors kCoolwarm = {{{59, 76, 192},
                                {77, 104, 215},
                                {98, 130, 234},
                                {119, 154, 247},
                                {141, 176, 254},
                                {163, 194, 254},
                                {184, 208, 249},
                                {204, 217, 238},
                                {221, 221, 221},
                                {236, 211, 197},
                                {244, 196, 173},
                                {247, 177, 148},
                                {244, 154, 123},
                                {236, 127, 99},
                                {222, 96, 77},
                                {203, 62, 56},
                                {180, 4, 38}}};

const Anchors& AnchorsOf(ColorMap map) {
  switch (map) {
    case ColorMap::kViridis:
      return kViridis;
    case ColorMap::kCividis:
      return kCividis;
    case ColorMap::kMagma:
      return kMagma;
    case ColorMap::kCoolwarm:
      break;
  }
  return kCoolwarm;
}

constexpr double kDarkestUsed = 0.2;

constexpr std::array<Rgb, kOutcomeNames.size()> kOutcomeRgb = {{
    kBluishGreen,     // returned
    kSkyBlue,         // no_surface: mostly the sky
    kBlue,            // out_of_range
    kOrange,          // below_threshold
    kReddishPurple,   // rain_absorbed
    kYellow,          // clutter
    kVermillion,      // near_range
    {90, 90, 90},     // ego
    {225, 225, 225},  // sensor_dropout
    {50, 50, 50},     // no_further_echo
    {120, 75, 0},     // cover_blocked: mud
}};

}  // namespace

Rgb MapColor(ColorMap map, double place) {
  const Anchors& anchors = AnchorsOf(map);
  const double start = map == ColorMap::kCoolwarm ? 0.0 : kDarkestUsed;
  const double used = start + (1.0 - start) * std::clamp(place, 0.0, 1.0);
  const double scaled = used * static_cast<double>(anchors.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(scaled), anchors.size() - 2);
  const double share = scaled - static_cast<double>(below);
  Rgb rgb;
  for (std::size_t i = 0; i < 3; ++i) {
    rgb[i] = static_cast<std::uint8_t>(
        std::lround((1.0 - share) * anchors[below][i] + share * anchors[below + 1][i]));
  }
  return rgb;
}

Rgb OutcomeRgb(Outcome outcome) {
  return kOutcomeRgb.at(static_cast<std::size_t>(outcome));
}

std::string OutcomeTitle(Outcome outcome) {
  std::string title(OutcomeName(outcome));
  std::ranges::replace(title, '_', ' ');
  return title;
}

}  // namespace railcast
