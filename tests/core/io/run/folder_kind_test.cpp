#include "core/io/run/folder_kind.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/io/verify/verification.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Makes a folder that holds empty files.
fs::path Holding(const TemporaryDirectory& directory, const std::vector<std::string>& files) {
  fs::path folder = directory.path() / "out";
  fs::remove_all(folder);
  fs::create_directories(folder);
  for (const std::string& file : files) {
    fs::create_directories((folder / file).parent_path());
    WriteFileWhole(folder / file, "");
  }
  return folder;
}

TEST(FolderKind, IsKnownByItsFiles) {
  const TemporaryDirectory directory;
  for (const auto& [files, what] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"sensors.json", "merged/merged.jsonl"}, "a run of several sensors"},
           {{"dataset.json", "manifest.json"}, "a data set"},
           {{"run.json", "insert.jsonl"}, "a recording with insertions"},
           {{"run.json", "convert.jsonl"}, "a converted recording"},
           {{"study.json", "approaches.jsonl", "report.html"}, "a study"},
           {{"scene.survey"}, "a survey"},
           {{"run.json", "frames.jsonl"}, "a sequence"},
           {{"run.json", "scenario.resolved.json"}, "a sequence"},
           {{"frames.csv", "frames/000000.pcd"}, "a received stream"},
           {{"report.html", "stats.json"}, "a report"}}) {
    const FolderKind* const kind = FindFolderKind(Holding(directory, files));
    ASSERT_NE(kind, nullptr) << what;
    EXPECT_EQ(kind->what, what);
  }
  // A user's own.
  for (const std::string file : {"study.json", "run.json", "notes.txt", "report.json"}) {
    EXPECT_EQ(FindFolderKind(Holding(directory, {file})), nullptr) << file;
  }
}

TEST(FolderKind, IsWhatACommandNeeds) {
  const TemporaryDirectory directory;
  const fs::path folder = Holding(directory, {"run.json", "frames.jsonl"});
  EXPECT_EQ(MessageOf([&] { CheckFolderKind(folder, "dataset.json"); }),
            folder.string() + ": must be a data set (got a sequence)");
  EXPECT_EQ(MessageOf([&] { CheckFolderKind(folder, "study.json"); }),
            folder.string() + ": must be a study (got a sequence)");
  CheckFolderKind(folder, "run.json");
  // Its reader says what it lacks.
  CheckFolderKind(Holding(directory, {"notes.txt"}), "dataset.json");
}

TEST(FolderKind, SaysWhyThereIsNothingToVerify) {
  const TemporaryDirectory directory;
  const std::string anew = ", which keeps no hashes of its files: the same command makes it anew";
  for (const auto& [files, said] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"report.html", "stats.json"}, "a report" + anew},
           {{"report.html", "frontier.json"}, "a chart of time against accuracy" + anew},
           {{"frontier.part/run.txt"}, "an unfinished chart of time against accuracy" + anew},
           {{"report.json", "split/train.txt"}, "a list of a data set's scenarios" + anew},
           {{"report.html", "dossier.json"},
            "a dossier, which keeps no hashes of its files: verify the folder of its study"},
           {{"account.csv", "left_out.csv"},
            "an imported map, which keeps no hashes of its files, since they may be edited: the "
            "same command makes it anew"},
           {{"merged.jsonl", "poses.csv"},
            "a folder of merged clouds, which is verified with the folder around it"},
           {{"frames.csv", "frames/000000.pcd"},
            "a received stream, which was written without hashes of its frames"}}) {
    const fs::path folder = Holding(directory, files);
    EXPECT_EQ(MessageOf([&] { (void)VerifyFolder(folder, [](double) {}); }),
              folder.string() + ": is " + said);
  }
}

}  // namespace
}  // namespace railcast
