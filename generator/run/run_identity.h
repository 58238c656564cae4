#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/io/scenario_identity.h"
#include "railcast/io/cloud_files.h"
#include "railcast/material.h"

namespace railcast {

/// Everything that the bytes of a sequence directory depend on.
struct SequenceSpec {
  std::filesystem::path directory;
  std::string version;         ///< ProgramVersion().
  std::string embree_version;  ///< EmbreeVersion().
  std::string isa;             ///< IsaInUse() of the trace.
  ScenarioIdentity identity;   ///< With the command line's seed and rung.
  /// CommandLogText of the replayed commands; empty if there are none.
  std::string commands_jsonl;
  std::uint64_t seed{};  ///< The scenario's, for the manifest.
  /// The choice of fidelity auto; empty if the scenario does not use it.
  std::string fidelity_choice_json;
  FrameFileSpec files;
  std::string camera;            ///< Name of the scenario's camera; empty = it has none.
  std::string calibration_json;  ///< CalibrationJson() of the camera.
  MaterialLibrary materials;
  std::uint32_t start_frame{};
  std::uint32_t num_frames{};
  std::uint32_t stride = 1;  ///< Every how many-th of the scenario's frames is made.

  /// The number of the run's i-th frame.
  [[nodiscard]] std::uint32_t FrameAt(std::uint32_t i) const { return start_frame + i * stride; }
};

/// Returns run.json, which identifies the run of a directory from its first moment on.
[[nodiscard]] std::string RunJson(const SequenceSpec& spec);

/// Checks that the directory belongs to this run.
/// @throws InputError that names the first difference if `run_json`, found in the directory, is
///   another run's.
/// @param is_complete Whether that run is complete, so that it cannot be continued.
void CheckSameRun(const SequenceSpec& spec, const std::string& run_json, bool is_complete);

/// Returns labels.json in the form that the scenario reader reads.
[[nodiscard]] std::string LabelsJson(const LabelTable& labels);

/// Returns materials.json: the materials by the ids that frames carry; 0 means none.
[[nodiscard]] std::string MaterialsJson(const MaterialLibrary& materials);

}  // namespace railcast
