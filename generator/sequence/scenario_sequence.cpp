#include "generator/sequence/scenario_sequence.h"

#include <optional>

#include "core/base/attempt.h"
#include "core/base/error.h"
#include "core/io/camera_files.h"
#include "core/io/scenario_identity.h"
#include "core/program/version.h"
#include "core/trace/trace_program.h"
#include "railcast/io/cloud_files.h"

namespace railcast {

void CheckOutputSuits(const std::string& format,
                      const ScenarioSpec& scenario,
                      const std::string& shown) {
  const bool is_sensor_frame = scenario.output.frame == OutputFrame::kSensor &&
                               scenario.output.handedness == Handedness::kRight;
  if (!ParseFrameFormat(format).dataset || is_sensor_frame) return;
  throw InputError(shown + ": /output: must be right-handed sensor coordinates for --format " +
                   format + " (got " + std::string(NameOf(scenario.output.handedness)) +
                   "-handed " + std::string(NameOf(scenario.output.frame)) + ")");
}

SequenceSpec SequenceSpecOf(const ScenarioSpec& scenario, const SequenceChoices& choices) {
  SequenceSpec spec;
  spec.directory = choices.directory;
  spec.version = ProgramVersion();
  spec.embree_version = EmbreeVersion();
  spec.isa = AtPlace("--", [&] { return IsaInUse(choices.isa); });
  spec.identity = IdentityOf(scenario);
  spec.seed = scenario.seed;
  spec.files.format = &ParseFrameFormat(choices.format);
  spec.files.fields = FieldSelection(choices.fields);
  const std::optional<DatasetLayout>& dataset = spec.files.format->dataset;
  if (dataset && choices.fields != "all") {
    throw InputError("--fields: " + std::string(dataset->title) +
                     "'s are fixed, so it must be left out with --format " + choices.format +
                     " (got " + choices.fields + ")");
  }
  spec.files.labels = LabelTable(scenario.labels);
  spec.materials = MaterialLibrary(scenario.materials);
  if (scenario.camera) {
    spec.camera = scenario.camera->name;
    spec.calibration_json = CalibrationJson(*scenario.camera, VehicleFromCamera(scenario),
                                            VehicleFromSensor(scenario.lidar.mount));
  }
  spec.start_frame = choices.start_frame;
  spec.num_frames = choices.num_frames;
  spec.stride = choices.stride;
  return spec;
}

}  // namespace railcast
