#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "analysis/extras/track/track_report.h"
#include "core/base/error.h"
#include "core/base/median.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/recording/found_sensor.h"
#include "core/scenario/descriptions.h"
#include "core/scenario/json_writer.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

Json MountJson(const MountSpec& mount) {
  return {{"position_m", mount.position_m},
          {"yaw_deg", mount.yaw_deg},
          {"pitch_deg", mount.pitch_deg},
          {"roll_deg", mount.roll_deg}};
}

/// The mount of a sensor that spins about another axis than the recording's z. Sensors of scenarios
/// spin about their own z.
MountSpec TurnedMount(MountSpec mount, const Eigen::Matrix3d& sensor_from_spin) {
  const Eigen::Matrix3d turn = VehicleFromSensor(mount).linear() * sensor_from_spin;
  const auto degrees = [](double y, double x) {
    return std::round(100.0 * DegFromRad(std::atan2(y, x))) / 100.0;
  };
  mount.yaw_deg = degrees(turn(1, 0), turn(0, 0));
  mount.pitch_deg = degrees(-turn(2, 0), std::hypot(turn(2, 1), turn(2, 2)));
  mount.roll_deg = degrees(turn(2, 1), turn(2, 2));
  return mount;
}

/// The recording's sensor where it is on the track.
Json LidarJson(const TrackSurvey& survey, const std::filesystem::path& source) {
  const auto recording = OpenRecording(source);
  MountSpec mount = survey.Mount();
  Json lidar;
  if (const auto& scenario = recording->info().scenario) {
    LidarSpec own = scenario->lidar;
    lidar = JsonWriter::WriteShort(own);
  } else {
    AtPlace(ShownPath(source) + ": no twin.json: ", [&] {
      const FoundSensor found = FindSensor(*recording);
      lidar = Json::parse(found.FileText());
      if (found.sensor_from_spin) mount = TurnedMount(mount, *found.sensor_from_spin);
    });
    lidar.erase("version");
  }
  lidar["mount"] = MountJson(mount);
  return lidar;
}

/// The gauge in mm: a named one, if it is within what is known.
double Gauge_mm(const TrackSurvey& survey) {
  const BoundedFigure& gauge_m = survey.gauge_m.median;
  for (const double named_m : kNamedGauges_m) {
    if (std::abs(named_m - gauge_m.value) < std::max(0.015, gauge_m.margin))
      return std::round(1e3 * named_m);
  }
  return std::round(1e3 * gauge_m.value);
}

Json AlignmentJson(const TrackSurvey& survey) {
  constexpr double kLength_m = 1000.0;
  constexpr double kStraightest_m = 20'000.0;
  const BoundedFigure& curvature_per_m = survey.curvature_per_m.median;
  Json element = {{"type", "straight"}, {"length_m", kLength_m}};
  // A curvature that may as well be none is none.
  if (std::abs(curvature_per_m.value) > curvature_per_m.margin &&
      std::abs(curvature_per_m.value) * kStraightest_m > 1.0) {
    element = {{"type", "arc"},
               {"length_m", kLength_m},
               {"radius_m", std::round(1.0 / curvature_per_m.value)}};
  }
  Json alignment = {{"course", {{"type", "elements"}, {"elements", {element}}}},
                    {"gauge_mm", Gauge_mm(survey)}};
  std::vector<double> cants_m;
  for (const TracksOfFrame& of : survey.frames)
    if (of.own && of.has_pose) cants_m.push_back(of.cant_m);
  if (!cants_m.empty())
    alignment["cants_mm"] = {{{"s_m", 0}, {"value", std::round(1e3 * MedianOf(cants_m))}}};
  return alignment;
}

}  // namespace

std::string MountText(const TrackSurvey& survey) {
  return MountJson(survey.Mount()).dump(2) + '\n';
}

std::string TwinText(const TrackSurvey& survey, const std::filesystem::path& source) {
  Json tracks = {{{"name", "main"}}};
  for (const double offset_m : survey.OtherTracks_m()) {
    tracks.push_back({{"name", "track " + std::to_string(tracks.size() + 1)},
                      {"offset_m", std::round(100.0 * offset_m) / 100.0}});
  }
  const Json twin = {
      {"version", 1},
      {"fidelity", "footprint"},
      {"lidar", LidarJson(survey, source)},
      {"world", {{"alignment", AlignmentJson(survey)}, {"tracks", std::move(tracks)}}},
      {"vehicle", {{"start_s_m", 500}, {"pivot_distance_m", 0}}},
      {"materials", "railcast:railway.json"},
      {"labels", "railcast:labels.json"}};
  return twin.dump(2) + '\n';
}

}  // namespace railcast
