#include "core/io/run/folder_kind.h"

#include <algorithm>
#include <array>
#include <string>
#include <system_error>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/run/dataset_files.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/run/survey_record.h"

namespace railcast {
namespace {

constexpr std::string_view kOfReports =
    "keeps no hashes of its files: the same command makes it anew";

/// The first that fits is the folder's.
constexpr std::array<FolderKind, 18> kKinds = {{
    {kSensorsFile, "", "a run of several sensors"},
    {"sensors.json.part", "", "an unfinished run of several sensors"},
    {kDatasetFile, "", "a data set"},
    {kInsertFile, "", "a recording with insertions"},
    {"convert.jsonl", "", "a converted recording"},
    {kStudyFile, kApproachesFile, "a study"},
    {kSurveyRecordFile, "", "a survey"},
    {kSurveyFile, "", "a survey"},
    {kRunFile, kFramesFile, "a sequence"},
    {kRunFile, kScenarioFile, "a sequence"},
    {kMergedFile, kPosesFile, "a folder of merged clouds", "is verified with the folder around it"},
    {"frames.csv", "frames", "a received stream", "was written without hashes of its frames"},
    {"account.csv", "left_out.csv", "an imported map",
     "keeps no hashes of its files, since they may be edited: the same command makes it anew"},
    {"report.json", kSplitFiles.front(), "a list of a data set's scenarios", kOfReports},
    {"dossier.json", "report.html", "a dossier",
     "keeps no hashes of its files: verify the folder of its study"},
    {"frontier.json", "report.html", "a chart of time against accuracy", kOfReports},
    {"frontier.part", "frontier.part/run.txt", "an unfinished chart of time against accuracy",
     kOfReports},
    {"report.html", "", "a report", kOfReports},
}};

}  // namespace

const FolderKind* FindFolderKind(const std::filesystem::path& folder) {
  const auto is_there = [&](std::string_view file) {
    std::error_code error;
    return std::filesystem::exists(folder / file, error);
  };
  // Without a second file, the folder itself is the second.
  const auto* const found = std::ranges::find_if(
      kKinds, [&](const FolderKind& kind) { return is_there(kind.file) && is_there(kind.beside); });
  return found == kKinds.end() ? nullptr : found;
}

void CheckFolderKind(const std::filesystem::path& folder, std::string_view file) {
  const FolderKind* const kind = FindFolderKind(folder);
  const auto* const wanted = std::ranges::find(kKinds, file, &FolderKind::file);
  Check(wanted != kKinds.end(), "kinds are known by their files");
  if (kind == nullptr || kind->what == wanted->what) return;
  throw InputError(ShownPath(folder) + ": must be " + std::string(wanted->what) + " (got " +
                   std::string(kind->what) + ")");
}

}  // namespace railcast
