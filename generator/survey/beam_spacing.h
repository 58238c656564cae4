#pragma once

#include <vector>

#include "generator/survey/survey_beams.h"

namespace railcast {

/// How far the neighbours of each beam are from it, as angles: the greater of the distances along
/// and across the horizon. Where beams without a point lie between, at most kMostOfTypical times
/// the median of the frame. Empty if the beams' origins are not known.
[[nodiscard]] std::vector<float> SpacingsOf_rad(const SurveyFrame& frame);

inline constexpr float kMostOfTypical = 2.0F;

}  // namespace railcast
