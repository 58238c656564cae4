#include "generator/insert/plan/found_sensor.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "core/base/error.h"
#include "core/base/input_file.h"
#include "core/base/text.h"
#include "core/io/recording/recording_kinds.h"
#include "core/io/run/sequence_files.h"
#include "core/io/sensor_tables.h"
#include "core/scenario/ouster_metadata.h"

namespace railcast {
namespace {

constexpr std::string_view kCaptureOf = "capture of ";

/// Reads the section of a sensor's file as if the plan named it.
LidarSpec ReadSensorFile(std::string_view text, const ScenarioSpec& plan) {
  auto scenario = nlohmann::json::parse(ResolvedScenarioJson(plan));
  auto lidar = nlohmann::json::parse(text);
  lidar.erase("version");
  lidar.erase("$schema");
  scenario["lidar"] = std::move(lidar);
  return ReadScenarioText(scenario.dump(), "plan.json").lidar;
}

std::optional<LidarSpec> SensorOfSequence(const RecordingInfo& info) {
  if (info.kind == kMergedKind) return std::nullopt;
  // Those into which something was put have one, too.
  if (info.scenario) return info.scenario->lidar;
  if (!info.origin) return std::nullopt;
  const auto file = info.source / kScenarioFile;
  if (!exists(file)) return std::nullopt;
  return ReadScenario(file).lidar;
}

std::optional<LidarSpec> SensorOfCapture(const RecordingInfo& info, const ScenarioSpec& plan) {
  if (!info.kind.starts_with(kCaptureOf)) return std::nullopt;
  const std::string name = info.kind.substr(kCaptureOf.size());
  if (const auto text = SensorFileOf(name)) return ReadSensorFile(*text, plan);
  const auto capture = FindCapture(info.source);
  if (!capture || !capture->beside.metadata) return std::nullopt;
  LidarSpec lidar;
  UseOusterMetadata(ReadFileWhole(capture->beside.file), lidar);
  lidar.name = name;
  return lidar;
}

}  // namespace

void UseSensorOf(const RecordingInfo& info, ScenarioSpec& plan, std::vector<std::string>& remarks) {
  // A constant, for GCC 12 fears that a temporary one is destroyed unset.
  static const LidarSpec kUnset;
  if (plan.lidar != kUnset) return;
  std::optional<LidarSpec> lidar = SensorOfSequence(info);
  const bool is_own = lidar.has_value();
  if (!lidar) lidar = SensorOfCapture(info, plan);
  if (!lidar) {
    throw InputError({{plan.sources.Place("/lidar"),
                       "missing: this recording does not say which sensor made it; name a sensor's "
                       "file, such as \"sensors/vlp16.json\"",
                       info.kind}});
  }
  plan.lidar = std::move(*lidar);
  std::string remark = "the sensor is " + (plan.lidar.name.empty() ? "that" : plan.lidar.name) +
                       (is_own ? " of the recording's scenario" : ", as the packets say");
  if (!is_own) {
    remark += ", with its preset and " + NumberText(plan.lidar.mount.position_m[2]) +
              " m above the rails: the plan's lidar may say otherwise";
  }
  remarks.push_back(std::move(remark));
}

}  // namespace railcast
