#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/io/run/sequence_files.h"

namespace railcast {

// Readers of the files with which a sequence directory describes itself as a whole (docs/files.md).
// `place` names the file in errors: "out/run.json".

/// The content of run.json, which identifies the run.
struct RunSummary {
  std::string version;
  std::string embree;  ///< Empty in directories of older programs, ...
  std::string isa;     ///< ... which did not record it.
  std::string scenario_hash;
  std::uint64_t seed{};
  std::string format;
  std::string
      fields{};  ///< Of its points, as `--fields` says them; empty if the format has others.
  std::uint32_t start_frame{};
  std::uint32_t num_frames{};
  std::uint32_t stride = 1;                 ///< From one frame's number to the next.
  bool has_commands{};                      ///< Whether the run replays any commands.
  std::vector<std::string> motion_sensors;  ///< Each has a file of samples (MotionFileName()).
  /// The bag that holds the clouds, relative to the directory, and their topics; empty = none.
  std::string bag{};
  std::vector<std::string> cloud_topics{};
  std::string trace{};  ///< The OSI trace that has a message for each frame; empty = none.
  /// The scenario, its inputs and the commands. Empty in directories of older programs, whose
  /// scenarios referred to files outside the directory.
  std::vector<KnownFile> files;
};

/// @throws InputError "place: rule" if the text is not a run.json.
[[nodiscard]] RunSummary ReadRunSummary(const std::string& text, const std::string& place);

/// The content of manifest.json, which states that the run is complete and lists its files.
struct Manifest {
  std::string version;
  std::uint64_t seed{};
  std::string format;
  std::uint32_t start_frame{};
  std::uint32_t num_frames{};
  /// All files except those of the frames, which frames.jsonl names.
  std::vector<KnownFile> files;
  std::string data_hash;  ///< Empty in directories of older programs.
  /// Names of the effects that fidelity `auto` chose; empty at another fidelity.
  std::vector<std::string> chosen_effects{};
};

/// @throws InputError "place: rule" if the text is not a manifest.json.
[[nodiscard]] Manifest ReadManifest(const std::string& text, const std::string& place);

/// Returns the text of manifest.json with its last member added: manifest_xxh3, the hash of the
/// text before it. It is needed because some of a manifest's content is recorded nowhere else.
/// @param json The other members, each on lines of its own.
[[nodiscard]] std::string WithManifestHash(const std::string& json);

/// @throws InputError "place: rule" if a manifest differs in any byte from what WithManifestHash()
///   returned.
void CheckManifestHash(const std::string& text, const std::string& place);

/// Returns the data_hash of files: the hash of their hashes, leaving out run.json, which names the
/// program that made them.
[[nodiscard]] std::string DataHash(const std::vector<KnownFile>& files);

}  // namespace railcast
