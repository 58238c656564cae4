#include "viewer/color/palette.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace railcast {

namespace {

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

Rgb OutcomeRgb(Outcome outcome) {
  return kOutcomeRgb.at(static_cast<std::size_t>(outcome));
}

std::string OutcomeTitle(Outcome outcome) {
  std::string title(OutcomeName(outcome));
  std::ranges::replace(title, '_', ' ');
  return title;
}

}  // namespace railcast
