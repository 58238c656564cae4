#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/value_type.h"

namespace railcast {

// The names of the files of a survey's folder (docs/survey.md), relative to it.

inline constexpr std::string_view kSurveyFile = "scene.survey";
inline constexpr std::string_view kSurveyWorldFile = "world.json";
/// A line of JSON with its hash (WithLineHash()): what the survey was made of and how, and the
/// hashes of the other files.
inline constexpr std::string_view kSurveyRecordFile = "survey.json";

/// What a survey was made of: the name of a recording or a file of poses, and a hash over the names
/// and the bytes of its files.
struct SurveyedRecord {
  std::string name;
  std::size_t num_files{};
  std::uint64_t num_bytes{};
  std::string hash;
};
void Describe(Archive& a, SurveyedRecord& s);

/// The content of survey.json.
struct SurveyRecord {
  std::uint32_t railcast_survey = 1;  ///< Version of the file.
  std::string version;                ///< Version of railcast.
  std::vector<SurveyedRecord> made_of{};
  std::uint32_t start_frame{};
  std::uint32_t stride{};
  std::size_t num_frames{};
  double range_m{};
  double voxel_m{};
  double max_gap_m{};
  double surfel_size{};
  bool keeps_moving{};
  bool is_standing{};
  bool is_in_world{};
  std::optional<SurveyedRecord> poses{};
  std::optional<double> white_intensity{};
  std::optional<double> sensor_height_m{};
  NamedValues<std::string> files{};  ///< The hashes of the other files.
};
void Describe(Archive& a, SurveyRecord& s);

/// The hashes of a survey's files by their names, as its record says.
/// @throws InputError with one line if the record cannot be read or was changed.
[[nodiscard]] std::map<std::string, std::string> ReadSurveyHashes(
    const std::filesystem::path& folder);

/// Checks a survey against the record beside it; one without a record is taken as it is.
/// @param hash ContentHash() of the file.
/// @throws InputError with one line if the record says otherwise, or as ReadSurveyHashes().
void CheckSurveyFile(const std::filesystem::path& file, const std::string& hash);

}  // namespace railcast
