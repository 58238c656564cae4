#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/io/frame_files.h"
#include "core/io/scenario_identity.h"
#include "core/scene/material.h"

namespace railcast {

/// Everything that a sequence directory's bytes depend on.
struct SequenceSpec {
  std::filesystem::path directory;
  std::string version;               ///< ProgramVersion().
  std::string embree_version;        ///< EmbreeVersion().
  std::string isa;                   ///< IsaInUse() of the trace.
  ScenarioIdentity identity;         ///< With the command line's seed and rung in it.
  std::string commands_jsonl;        ///< CommandLogText of what is replayed; empty if nothing is.
  std::uint64_t seed{};              ///< The scenario's, for the manifest.
  std::string fidelity_choice_json;  ///< What fidelity auto came to; empty unless it was asked.
  FrameFileSpec files;
  MaterialLibrary materials;
  std::uint32_t start_frame{};
  std::uint32_t num_frames{};
};

/// run.json: names the run that a directory belongs to, from its first moment on.
[[nodiscard]] std::string RunJson(const SequenceSpec& spec);

/// @throws InputError that names the first difference if `run_json`, found in the directory, is
///   another run's.
/// @param is_complete Whether all of that run is there: then it is not to be continued.
void CheckSameRun(const SequenceSpec& spec, const std::string& run_json, bool is_complete);

/// labels.json in the form the scenario reader reads.
[[nodiscard]] std::string LabelsJson(const LabelTable& labels);

/// materials.json: the materials by the ids that frames carry; 0 is none.
[[nodiscard]] std::string MaterialsJson(const MaterialLibrary& materials);

}  // namespace railcast
