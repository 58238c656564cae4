#pragma once

#include <iomanip>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "generator/check/contact_runs.h"
#include "generator/check/gauge_entries.h"
#include "generator/check/scene_audit.h"
#include "generator/check/vehicle_way.h"
#include "railcast/alignment.h"
#include "railcast/camera.h"
#include "railcast/frame.h"
#include "railcast/lidar.h"
#include "railcast/scenario.h"

namespace railcast {

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

// The paragraphs that `railcast-generate check` prints for a valid scenario. Each consists of whole
// lines and begins with its subject.

[[nodiscard]] std::string SensorText(const LidarSpec& lidar, const ScanPattern& pattern);

[[nodiscard]] std::string CameraText(const CameraSpec& camera);

/// @param is_verbose Lists every smoothed jump.
[[nodiscard]] std::string LineText(const Alignment& alignment, double gauge_mm, bool is_verbose);

/// @param scan Whose frames are counted.
[[nodiscard]] std::string VehicleText(const std::string& track,
                                      const VehicleWay& way,
                                      const ScanSpec& scan);

[[nodiscard]] std::string SceneText(const SceneAudit& audit);
/// Which models of plants are traced at which distances.
[[nodiscard]] std::string DetailText(const DetailAudit& audit, const LabelTable& labels);

[[nodiscard]] std::string ObjectsText(const World& world, const LabelTable& labels);

/// Lists what stands in the structure gauge of a track; empty if nothing does.
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

}  // namespace railcast
