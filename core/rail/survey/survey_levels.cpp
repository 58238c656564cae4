#include "core/rail/survey/survey_levels.h"

#include <algorithm>
#include <cmath>

namespace railcast {
namespace {

constexpr double kLeastReflectivity = 0.01;
constexpr double kLevelRatio = 1.1;

}  // namespace

std::uint8_t SurveyLevelOf(double reflectivity) {
  if (!(reflectivity > kLeastReflectivity)) return 0;
  const double level = std::log(reflectivity / kLeastReflectivity) / std::log(kLevelRatio);
  return static_cast<std::uint8_t>(std::min(std::round(level), kNumSurveyLevels - 1.0));
}

Material MaterialOfLevel(std::uint8_t level) {
  const std::string number = std::to_string(level);
  return {.name = "surveyed_" + std::string(2 - number.size(), '0') + number,
          .reflectivity = kLeastReflectivity * std::pow(kLevelRatio, level)};
}

}  // namespace railcast
