#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "core/base/random.h"
#include "generator/extras/survey/survey.h"
#include "generator/extras/survey/survey_beams.h"
#include "railcast/transform.h"

namespace railcast {

/// Frames that a test makes point by point.
class MadeFrames {
 public:
  SurveyFrame& Add(const Vector3& sensor_m) {
    SurveyFrame& frame = frames_.emplace_back();
    frame.world_from_body.translation() = sensor_m;
    frame.has_vehicle = true;
    frame.has_origins = true;
    return frame;
  }
  /// Frames as MakeSurvey() visits them.
  [[nodiscard]] FramesOfSurvey All() const {
    return [this](const std::function<void(const SurveyFrame&)>& visit) {
      for (const SurveyFrame& frame : frames_) visit(frame);
    };
  }

 private:
  std::vector<SurveyFrame> frames_;
};

inline void AddPoint(const Vector3& point_m, SurveyFrame& frame) {
  frame.beams.push_back({.origin_m = frame.world_from_body.translation(),
                         .point_m = point_m,
                         .reflectance = 0.4F,
                         .label = SurveyLabels::kUnknown});
}

/// A wall at x, 8 m wide and 4 m high, in a grid of points.
inline void AddWall(double x_m, double spacing_m, SurveyFrame& frame) {
  const auto num_steps = static_cast<int>(std::round(4.0 / spacing_m));
  for (int i = -num_steps; i <= num_steps; ++i) {
    for (int k = 0; k <= num_steps; ++k) AddPoint({x_m, spacing_m * i, spacing_m * k}, frame);
  }
}

}  // namespace railcast
