#pragma once

#include <string>
#include <vector>

#include "core/frame/labels.h"
#include "core/rail/line/alignment.h"
#include "core/scan/scan_pattern.h"
#include "core/scenario/scenario_spec.h"
#include "generator/object_overlaps.h"
#include "generator/scene_audit.h"
#include "generator/vehicle_way.h"

namespace railcast {

// What `railcast-generate check` prints of a sound scenario: paragraphs of whole lines, each headed
// by its subject.

[[nodiscard]] std::string SensorText(const LidarSpec& lidar, const ScanPattern& pattern);

/// @param is_verbose Lists every smoothed jump.
[[nodiscard]] std::string LineText(const Alignment& alignment, bool is_verbose);

[[nodiscard]] std::string VehicleText(const std::string& track,
                                      const VehicleWay& way,
                                      double rate_hz);

[[nodiscard]] std::string SceneText(const SceneAudit& audit);

[[nodiscard]] std::string ObjectsText(const World& world, const LabelTable& labels);

/// Which objects overlap at frame 0, that of FindOverlaps.
[[nodiscard]] std::string OverlapsText(const std::vector<ObjectOverlap>& overlaps,
                                       const World& world);

[[nodiscard]] std::string SurroundingsText(const Surroundings& around,
                                           const World& world,
                                           const LabelTable& labels);

/// How fine float32 is where the sensor starts, if points are in world coordinates; else nothing.
[[nodiscard]] std::string OutputText(const OutputSpec& output, const Vector3& sensor_world);

}  // namespace railcast
