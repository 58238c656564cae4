#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "core/scenario/json_text.h"

namespace railcast {

/// Says what another value of a key means: "holds a run of another scenario". Gets both files
/// whole.
using DifferenceText =
    std::function<std::string(const std::string& key, const Json& found, const Json& ours)>;

/// What is to be told apart from all other runs in the same folder.
struct FolderIdentity {
  std::filesystem::path file;  ///< Tells whose the folder is: "out/run.json".
  std::string text;            ///< What it holds if the folder is this run's.
  bool is_complete{};          ///< Whether that run is, so that it cannot be continued.
  std::string advice = "choose another --out";
};

/// Takes a folder for a run: checks that it is this run's, or makes a new one so, by the file that
/// every run writes first. A run that was killed before may have left the beginning of that file.
///
///     TakeFolder({.file = directory / kStudyFile, .text = RecordFile(record)}, "a study",
///                StudyDifference);
///
/// @param run What can be continued, for the message: "a study".
/// @return Whether the folder is new.
/// @throws InputError as CheckIsSame(); "--out: must be a new or an empty folder, or that of a
/// study
///   to continue (got out)" if the folder holds anything else; or if the system refuses.
[[nodiscard]] bool TakeFolder(const FolderIdentity& ours,
                              const std::string& run,
                              const DifferenceText& text_of);

/// Checks that a folder belongs to a run, by the file that every run writes first. A version of the
/// program, of Embree or another instruction set is told without `text_of`.
/// @throws InputError that names the first difference and ends with the advice.
void CheckIsSame(const FolderIdentity& ours, const DifferenceText& text_of);

/// "its seed is 5 (got 6)", "its --stride is 1 (got 2)": with the name of the key's option, and
/// with what the absence of a value means.
[[nodiscard]] std::string ValuesText(const std::string& key, const Json& found, const Json& ours);

/// The member of an object; null if there is none.
[[nodiscard]] const Json& MemberOf(const Json& object, const std::string& key);

}  // namespace railcast
