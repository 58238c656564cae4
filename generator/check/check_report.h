#pragma once

#include <iomanip>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/rail/line/track_course.h"
#include "core/rail/world/gauge_entries.h"
#include "generator/check/scene_audit.h"
#include "railcast/alignment.h"
#include "railcast/camera.h"
#include "railcast/frame.h"
#include "railcast/lidar.h"
#include "railcast/material.h"
#include "railcast/motion_sensors.h"
#include "railcast/objects.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// A moment of a vehicle's journey.
struct WayPoint {
  double time_s{};
  double s_m{};        ///< Chainage.
  double speed_mps{};  ///< Speed from this moment on.
};

/// When and where a vehicle's journey begins and ends.
struct VehicleWay {
  WayPoint start;
  /// The last point of the speed profile, if there is a profile and the point is reached.
  std::optional<WayPoint> profile_end;
  std::optional<WayPoint> track_end;  ///< Absent if the vehicle never leaves its track.
};

/// @pre The vehicle follows `track`, and its start lies on it.
[[nodiscard]] VehicleWay FindVehicleWay(const VehicleSpec& vehicle, const TrackCourse& track);

/// Formats one line of a paragraph of `check`; only the first line of a paragraph has a head.
[[nodiscard]] inline std::string ReportLine(std::string_view head, const std::string& text) {
  constexpr int kHeadWidth = 10;
  std::ostringstream line;
  line << std::left << std::setw(kHeadWidth) << head << text << "\n";
  return line.str();
}

/// The rung and the effects that are on, in the order of scenario keys, with their parameters and
/// what these mean in the scenario's weather; and the keys of the weather that none of them reads.
/// @throws InputError if effects do not go together.
[[nodiscard]] std::string EffectsText(const ScenarioSpec& scenario);

/// What the certificate of a run of 50 frames would know at a share of the frames' time, the
/// numerical error of three frames by some 500 firings, and what the rungs beside would give.
/// @param simulator Of the scenario, with the effects of its run; its variants are replaced.
/// @throws InputError as Certifier does.
[[nodiscard]] std::string CertificateBudgetText(const ScenarioSpec& scenario,
                                                double cost_share,
                                                Simulator& simulator);

// The paragraphs that `railcast-generate check` prints for a valid scenario. Each consists of whole
// lines and begins with its subject.

[[nodiscard]] std::string SensorText(const LidarSpec& lidar, const ScanPattern& pattern);

[[nodiscard]] std::string CameraText(const CameraSpec& camera);

[[nodiscard]] std::string MotionSensorsText(const MotionSensorsSpec& motion_sensors);

/// @param is_verbose Lists every smoothed jump.
[[nodiscard]] std::string LineText(const Alignment& alignment, double gauge_mm, bool is_verbose);

/// @param scan Whose frames are counted.
[[nodiscard]] std::string VehicleText(const std::string& track,
                                      const VehicleWay& way,
                                      const ScanSpec& scan);

/// A remark on a vehicle that moves as if it had no springs; empty for all others.
[[nodiscard]] std::string RideText(const VehicleSpec& vehicle);

[[nodiscard]] std::string SceneText(const SceneAudit& audit);
/// Which models of plants are traced at which distances.
[[nodiscard]] std::string DetailText(const DetailAudit& audit, const LabelTable& labels);

[[nodiscard]] std::string ObjectsText(const World& world, const LabelTable& labels);

/// Lists what stands in the way on a track, or in its clear space; empty if nothing does.
[[nodiscard]] std::string GaugeText(const std::vector<GaugeEntry>& entries);

/// Lists what touches or overlaps in frames 0 to `last_frame`, as found by FindContactRuns.
[[nodiscard]] std::string ContactsText(const std::vector<ContactRun>& runs,
                                       const World& world,
                                       std::uint32_t last_frame);

/// How many beams the sensor's own vehicle takes; nothing if it has no body.
[[nodiscard]] std::string OwnHitsText(const OwnHits& hits);

[[nodiscard]] std::string SurroundingsText(const SensorSurroundings& around,
                                           const World& world,
                                           const LabelTable& labels);

/// States the resolution of float32 at the sensor's start if points are in world coordinates;
/// otherwise empty.
[[nodiscard]] std::string OutputText(const OutputSpec& output, const Vector3& sensor_world);

/// The tracks of a world with more than one: name, length, chainages and tightest radius of each,
/// the turnouts that lie in it, and the tracks that it crosses.
[[nodiscard]] std::string NetworkText(const RailWorld& world);

/// Name of the track on which the vehicle starts.
[[nodiscard]] std::string StartTrack(const RailWorld& world, const VehicleSpec& vehicle);

/// The largest lateral acceleration of the vehicle on its way, in the plane of the rails: v^2 times
/// the curvature of the track, less the part of gravity that the cant balances.
struct LateralPeak {
  double acceleration_mps2{};  ///< Towards the outside of the curve.
  double balanced_mps2{};      ///< What the cant takes from it.
  WayPoint point;
};

/// Samples the way from its start to its end or, where it has none, for an hour after the end of
/// the speed profile. Returns nothing if it stands or if cant balances every curve.
[[nodiscard]] std::optional<LateralPeak> FindLateralPeak(const RailWorld& world,
                                                         const VehicleSpec& vehicle,
                                                         const VehicleWay& way);

/// The route, if it has several tracks, and the peak.
[[nodiscard]] std::string RouteText(const RailWorld& world, const std::optional<LateralPeak>& peak);

/// Reads the mesh files of all objects and says of each model how large it is, how many triangles
/// it has, what was left out and why, how far it was simplified, which of its parts has which
/// material and label and why, and what about it is likely to be a mistake. Objects with one model
/// share its paragraph. Empty if no object is a mesh.
///
/// A mistake is guessed where a model
/// - is larger than 100 m or smaller than 1 cm;
/// - has the file's origin and more than half of its height below its place;
/// - is taken to have z up and in its file stands on the plane y = 0 (within 2 % of its extent in
///   y) but reaches through z = 0 (by more than a quarter of its extent in z to either side).
///   Modelling programs with y up have the ground at y = 0 and the model's middle at z = 0.
///
/// @throws InputError if a file cannot be read (any more).
[[nodiscard]] std::string MeshesText(std::span<const ObjectSpec> objects,
                                     const LabelTable& labels,
                                     const MaterialLibrary& materials);

}  // namespace railcast
