#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/io/recording/sequence_lines.h"

namespace railcast {

// What a sequence directory says of itself as a whole (docs/files.md). `place` names the file in
// errors: "out/run.json".

/// run.json: whose run it is.
struct RunSummary {
  std::string version;
  std::string embree;  ///< Empty in directories of older programs, ...
  std::string isa;     ///< ... which did not keep it.
  std::string scenario_hash;
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
  std::string format;
  std::uint32_t start_frame{};
  std::uint32_t num_frames{};
  std::vector<KnownFile> files;  ///< All but the frames', which frames.jsonl names.
  std::string data_hash;         ///< Empty in directories of older programs.
};

/// @throws InputError "place: rule" if it is none.
[[nodiscard]] Manifest ReadManifest(const std::string& text, const std::string& place);

/// The data_hash of files: that of their hashes, but for run.json, which says who made them.
[[nodiscard]] std::string DataHash(const std::vector<KnownFile>& files);

}  // namespace railcast
