#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/scenario/value_type.h"

namespace railcast {

/// Which frames of each approach are made.
struct StudyFramesRecord {
  std::uint32_t first{};
  std::uint32_t stride{};
  std::uint32_t num{};
};
void Describe(Archive& a, StudyFramesRecord& s);

/// The content of study.json: everything that a study's figures depend on.
struct StudyRecord {
  std::string version;
  std::string embree;
  std::string isa;
  std::string study_hash;
  std::string recipe_hash;
  std::vector<std::string> base_hashes{};
  std::string files_hash{};  ///< Of the files that the recipe names.
  std::uint32_t num_scenarios{};
  StudyFramesRecord frames{};
  std::string shard{};  ///< "2/7"; empty for a whole study.
};
void Describe(Archive& a, StudyRecord& s);

/// Reads study.json of a folder.
/// @throws InputError if there is none, or if it is damaged.
[[nodiscard]] StudyRecord ReadStudyRecord(const std::filesystem::path& directory);

/// The content of manifest.json of a study.
struct StudyManifestRecord {
  NamedValues<std::string> files{};  ///< The hashes of all files.
};
void Describe(Archive& a, StudyManifestRecord& s);

}  // namespace railcast
