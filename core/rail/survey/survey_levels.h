#pragma once

#include <cstdint>
#include <string>

#include "railcast/material.h"

namespace railcast {

/// Surveyed surfaces have one of so many reflectivities, each a tenth greater than the one before,
/// so that none is more than 5 % off.
inline constexpr std::uint8_t kNumSurveyLevels = 50;

/// How a surveyed surface reflects, and what it is called.
struct SurveySurface {
  std::uint8_t level{};   ///< Below kNumSurveyLevels.
  std::uint16_t label{};  ///< Index into the survey's labels.

  auto operator<=>(const SurveySurface&) const = default;
};

/// The level nearest to a reflectivity. Those beyond the first and the last, 0.01 and 1.07, have
/// these.
[[nodiscard]] std::uint8_t SurveyLevelOf(double reflectivity);

/// The material of a level, "surveyed_00" for the first: Lambertian, alike at all wavelengths.
[[nodiscard]] Material MaterialOfLevel(std::uint8_t level);

}  // namespace railcast
