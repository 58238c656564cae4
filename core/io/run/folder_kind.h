#pragma once

#include <filesystem>
#include <string_view>

namespace railcast {

// The files by which a study is known (docs/study.md), relative to its folder.
inline constexpr std::string_view kStudyFile = "study.json";
inline constexpr std::string_view kApproachesFile = "approaches.jsonl";

/// A kind of folder that a command of railcast writes.
struct FolderKind {
  std::string_view file;    ///< The file by which it is known.
  std::string_view beside;  ///< Another one that it must hold, too; empty: none.
  std::string_view what;    ///< "a data set".
  /// Why it holds nothing by which it could be verified; empty if it does.
  std::string_view why_not{};
};

/// The kind of a folder; null if it is none that railcast writes.
[[nodiscard]] const FolderKind* FindFolderKind(const std::filesystem::path& folder);

/// Checks that a folder is of a kind, unless it is of none: then its reader says what is missing.
/// @param file The file by which the kind is known.
/// @throws InputError "out/demo: must be a data set (got a sequence)".
void CheckFolderKind(const std::filesystem::path& folder, std::string_view file);

}  // namespace railcast
