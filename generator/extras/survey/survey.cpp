#include "generator/extras/survey/survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/median.h"
#include "core/base/text.h"
#include "generator/extras/survey/moving_things.h"
#include "generator/extras/survey/survey_voxels.h"
#include "generator/extras/survey/wire_finder.h"

namespace railcast {
namespace {

using TilesByCell = std::map<std::array<std::int32_t, 2>, SurveyTile>;

/// Leaves out the surfels of what moved, and shrinks those that let beams pass.
void CheckByBeams(const FramesOfSurvey& frames,
                  const SurveyVoxels& cloud,
                  bool keeps_moving,
                  std::vector<MadeSurfel>& surfels) {
  MovingThings moving(surfels, cloud);
  std::uint32_t frame_index = 0;
  frames([&](const SurveyFrame& frame) { moving.Add(frame, frame_index++); });
  std::vector<MadeSurfel> kept;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    if (moving.HasMoved(i) && !keeps_moving) continue;
    MadeSurfel& surfel = kept.emplace_back(surfels[i]);
    const auto factor = static_cast<float>(std::sqrt(moving.ShareStopped(i)));
    surfel.half_u_m *= factor;
    surfel.half_v_m *= factor;
  }
  surfels = std::move(kept);
}

/// The median height of the body's places above the ground below them.
/// @throws InputError if none of them is above surveyed ground.
double HeightAboveGround_m(const DrivenWay& way, const TilesByCell& tiles) {
  std::vector<double> heights_m;
  for (const Transform& world_from_body : way.world_from_body) {
    const Vector3 place_m = world_from_body.translation();
    const auto found = tiles.find(SurveyCellAt(place_m.head<2>()));
    if (found == tiles.end()) continue;
    const auto ground_m = GroundHeight_m(found->second, place_m.head<2>());
    if (ground_m) heights_m.push_back(place_m.z() - *ground_m);
  }
  if (heights_m.empty()) {
    throw InputError(
        "--sensor-height: must be given, since no ground was seen below the sensor's way by which "
        "to tell the top of rail (got none)");
  }
  return MedianOf(heights_m);
}

}  // namespace

Survey MakeSurvey(const FramesOfSurvey& frames,
                  const SurveyLabels& labels,
                  const SurveyOptions& options) {
  Survey survey;
  SurveyVoxels cloud(options.voxel_m);
  frames([&](const SurveyFrame& frame) {
    cloud.Add(frame, static_cast<std::uint32_t>(survey.num_frames++));
    survey.num_points += frame.beams.size();
    if (frame.has_origins) survey.way.world_from_body.push_back(frame.world_from_body);
    survey.is_way_of_vehicle = frame.has_vehicle;
  });
  if (survey.is_way_of_vehicle && options.sensor_height_m) {
    throw InputError(
        "--sensor-height: must be left out for recordings that know it by their sensor's mount "
        "(got " +
        ShortText(*options.sensor_height_m) + ")");
  }
  survey.num_voxels = cloud.voxels().size();
  std::vector<MadeSurfel> surfels = MakeSurfels(cloud, options.surfels);
  survey.num_alone = survey.num_voxels - surfels.size();
  const std::size_t num_before = surfels.size();
  if (!survey.way.world_from_body.empty()) {
    CheckByBeams(frames, cloud, options.keeps_moving, surfels);
  }
  survey.num_moving = num_before - surfels.size();
  const auto count = [&](SurfelKind kind) {
    return static_cast<std::size_t>(std::ranges::count(surfels, kind, &MadeSurfel::kind));
  };
  survey.num_linear = count(SurfelKind::kLinear);
  survey.num_scattered = count(SurfelKind::kOther);
  if (surfels.empty()) {
    throw InputError("the survey: must have surfaces (got " +
                     Amount(survey.num_points, "points of ") +
                     Amount(survey.num_frames, "frames and no surface)"));
  }
  survey.labels = labels.names();
  TilesByCell tiles = TilesOf(surfels);
  if (!survey.is_way_of_vehicle && !survey.way.world_from_body.empty()) {
    survey.way.above_rail_m =
        options.sensor_height_m ? *options.sensor_height_m : HeightAboveGround_m(survey.way, tiles);
  }
  const std::vector<FoundWire> wires = TakeWires(survey.way, surfels);
  tiles = TilesOf(surfels);
  AddWires(wires, tiles);
  survey.num_surfels = surfels.size();
  survey.num_wires = wires.size();
  for (auto& [cell, tile] : tiles) survey.tiles.push_back(std::move(tile));
  return survey;
}

}  // namespace railcast
