#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/io/recording/known_file.h"

namespace railcast {

// What a sequence directory says of itself as a whole (docs/files.md). `place` names the file in
// errors: "out/run.json".

/// run.json: whose run it is.
struct RunSummary {
  std::string version;
  std::string embree;  ///< Empty in directories of older programs, ...
  std::string isa;     ///< ... which did not keep it.
  std::string scenario_hash;
  std::uint64_t seed{};
  std::string format;
  std::uint32_t start_frame{};
  std::uint32_t num_frames{};
  bool has_commands{};  ///< Whether it replays any.
  /// The scenario, its inputs and the commands. Empty in directories of older programs, whose
  /// scenarios named files elsewhere.
  std::vector<KnownFile> files;
};

/// @throws InputError "place: rule" if it is none.
[[nodiscard]] RunSummary ReadRunSummary(const std::string& text, const std::string& place);

/// manifest.json: that all is there, and what.
struct Manifest {
  std::string version;
  std::uint64_t seed{};
  std::string format;
  std::uint32_t start_frame{};
  std::uint32_t num_frames{};
  std::vector<KnownFile> files;  ///< All but the frames', which frames.jsonl names.
  std::string data_hash;         ///< Empty in directories of older programs.
};

/// @throws InputError "place: rule" if it is none.
[[nodiscard]] Manifest ReadManifest(const std::string& text, const std::string& place);

/// The text of manifest.json with its last member, manifest_xxh3: the hash of the text before it.
/// Some of what a manifest says is said nowhere else.
/// @param json The other members, each on lines of its own.
[[nodiscard]] std::string WithManifestHash(const std::string& json);

/// @throws InputError "place: rule" if a manifest is not to the byte what WithManifestHash() gave.
void CheckManifestHash(const std::string& text, const std::string& place);

/// The data_hash of files: that of their hashes, but for run.json, which says who made them.
[[nodiscard]] std::string DataHash(const std::vector<KnownFile>& files);

}  // namespace railcast
