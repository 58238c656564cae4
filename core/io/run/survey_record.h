#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace railcast {

// The names of the files of a survey's folder (docs/survey.md), relative to it.

inline constexpr std::string_view kSurveyFile = "scene.survey";
inline constexpr std::string_view kSurveyWorldFile = "world.json";
/// A line of JSON with its hash (WithLineHash()): what the survey was made of and how, and the
/// hashes of the other files.
inline constexpr std::string_view kSurveyRecordFile = "survey.json";

/// The hashes of a survey's files by their names, as its record says.
/// @throws InputError with one line if the record cannot be read or was changed.
[[nodiscard]] std::map<std::string, std::string> ReadSurveyRecord(
    const std::filesystem::path& folder);

/// Checks a survey against the record beside it; one without a record is taken as it is.
/// @param hash ContentHash() of the file.
/// @throws InputError with one line if the record says otherwise, or as ReadSurveyRecord().
void CheckSurveyFile(const std::filesystem::path& file, const std::string& hash);

}  // namespace railcast
