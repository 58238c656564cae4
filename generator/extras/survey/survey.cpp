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
#include "core/points/level_areas.h"
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

[[noreturn]] void AskForHeight(const std::string& why) {
  throw InputError("--sensor-height: must be given, since " + why + " (got none)");
}

bool HasStood(const DrivenWay& way) {
  constexpr double kMost_m = 0.5;
  const Vector3 first_m = way.world_from_body.front().translation();
  return std::ranges::all_of(way.world_from_body, [&](const Transform& world_from_body) {
    return (world_from_body.translation() - first_m).norm() < kMost_m;
  });
}

/// The height above the largest level area that a sensor sees which stands. What is right below it
/// may be its vehicle.
/// @throws InputError if there is none, or if two could be the ground.
double HeightWhereItStands_m(const Vector3& place_m, const std::vector<MadeSurfel>& surfels) {
  constexpr float kLevel = 0.9F;
  std::vector<Eigen::Vector3f> points_m;
  for (const MadeSurfel& surfel : surfels) {
    if (std::abs(surfel.Normal().z()) < kLevel) continue;
    points_m.emplace_back((surfel.center_m - place_m).cast<float>());
  }
  const GroundBelow ground = FindGroundBelow(points_m);
  const auto text = [](const LevelArea& area) {
    return ShortText(area.below_m) + " m below the sensor (" + ShortText(area.area_m2) +
           " m2 of it seen)";
  };
  if (!ground.rivals.empty()) {
    AskForHeight("two level areas could be that of the track: one " + text(ground.rivals[0]) +
                 " and one " + text(ground.rivals[1]));
  }
  if (!ground.is_found) {
    AskForHeight("no level area was seen below the sensor by which to tell the top of rail");
  }
  return ground.below_m;
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
    AskForHeight("no ground was seen below the sensor's way by which to tell the top of rail");
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
    const Vector3 first_m = survey.way.world_from_body.front().translation();
    survey.way.above_rail_m = options.sensor_height_m ? *options.sensor_height_m
                              : HasStood(survey.way)  ? HeightWhereItStands_m(first_m, surfels)
                                                      : HeightAboveGround_m(survey.way, tiles);
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
