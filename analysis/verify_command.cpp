#include <functional>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>

#include "analysis/analysis_extras.h"
#include "analysis/commands.h"
#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/text.h"
#include "core/io/run/folder_kind.h"
#include "core/io/run/run_folder.h"
#include "core/io/verify/verification.h"
#include "core/program/progress_line.h"

namespace railcast {
namespace {

std::string SummaryOf(const Verification& found) {
  constexpr double kMega = 1e6;
  std::ostringstream text;
  text << (found.faults.empty() ? "whole" : Amount(found.faults.size(), "faults")) << "; read "
       << Amount(found.num_frames, "frames") << " in " << Amount(found.num_files, "files") << ", "
       << std::fixed << std::setprecision(1) << static_cast<double>(found.num_bytes) / kMega
       << " MB";
  return text.str();
}

/// Files of a study are the extra's.
Verification Verify(const std::filesystem::path& directory,
                    const std::function<void(double)>& on_progress) {
  const FolderKind* const kind = FindFolderKind(directory);
  if (kind == nullptr || kind->file != kStudyFile) return VerifyFolder(directory, on_progress);
  const auto verify = AnalysisExtras::Get().verify_study;
  if (verify == nullptr) throw LacksExtra(ShownPath(directory / kind->file), "study");
  return verify(directory, on_progress);
}

int RunVerify(const std::filesystem::path& directory) {
  RefuseLinks(directory, {"."});
  const ProgressLine progress;
  const Verification found =
      Verify(directory, [&](double share) { progress.Show("frames", share); });
  progress.End();
  for (const std::string& fault : found.faults) std::cout << ShownLines(fault) << "\n";
  for (const std::string& what : found.unchecked) std::cout << ShownLines(what) << "\n";
  std::cout << ShownPath(directory) << ": " << SummaryOf(found) << "\n" << std::flush;
  return found.faults.empty() ? kExitSuccess : kExitFailure;
}

}  // namespace

void AddVerify(ProgramOptions& app, ProgramCommand& command) {
  const auto directory = std::make_shared<std::filesystem::path>();
  ProgramOptions verify = app.AddCommand("verify",
                                         "Check that a sequence, a data set, a study, a survey, or "
                                         "a recording that was converted or into which something "
                                         "was put, is as it was written: one line per fault");
  verify
      .AddOption("DIR", *directory,
                 "Folder that railcast-generate sequence, dataset, merge, survey, insert or "
                 "convert or railcast-analyze study made, any --format")
      .Required()
      .Check(NonEmpty());
  verify.WhenParsed([&command, directory] {
    command = [directory](const std::string&) { return RunVerify(*directory); };
  });
}

}  // namespace railcast
