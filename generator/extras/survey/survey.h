#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/survey/survey_file.h"
#include "generator/extras/survey/driven_axis.h"
#include "generator/extras/survey/surfel_maker.h"
#include "generator/extras/survey/survey_beams.h"

namespace railcast {

/// How a survey is made.
struct SurveyOptions {
  double voxel_m = 0.04;  ///< Edge of the cubes of which each keeps one point.
  SurfelRules surfels;
  bool keeps_moving = false;  ///< Whether things that moved stay.
  /// Height above top of rail of a sensor whose mount is not known; absent: above the ground below
  /// its way.
  std::optional<double> sensor_height_m{};
};

/// A survey, and how it came about.
struct Survey {
  std::vector<std::string> labels;
  std::vector<SurveyTile> tiles;
  DrivenWay way;  ///< Empty if the places of the sensor are not known.
  bool is_way_of_vehicle = false;
  std::size_t num_frames = 0;
  std::size_t num_points = 0;
  std::size_t num_voxels = 0;
  std::size_t num_alone = 0;   ///< Voxels without neighbours, left out.
  std::size_t num_moving = 0;  ///< Surfels of things that moved, left out.
  std::size_t num_linear = 0;  ///< Linear surfels that stay.
  std::size_t num_scattered = 0;
  std::size_t num_surfels = 0;
  std::size_t num_wires = 0;
};

/// Visits all frames of a survey, calling its argument with each; called twice.
using FramesOfSurvey = std::function<void(const std::function<void(const SurveyFrame& frame)>&)>;

/// Makes a survey of frames.
/// @param labels Those of the frames, complete once they were visited.
/// @throws InputError as the frames' reader does, if no surface was found, or if nothing tells the
///   sensor's height above top of rail.
[[nodiscard]] Survey MakeSurvey(const FramesOfSurvey& frames,
                                const SurveyLabels& labels,
                                const SurveyOptions& options);

}  // namespace railcast
