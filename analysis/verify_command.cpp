#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>

#include "analysis/commands.h"
#include "core/base/join.h"
#include "core/io/run/sensors_record.h"
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

template <typename Verify>
int Report(const std::filesystem::path& directory, const Verify& verify) {
  const ProgressLine progress;
  const Verification found = verify([&](double share) { progress.Show("frames", share); });
  progress.End();
  for (const std::string& fault : found.faults) std::cout << ShownLines(fault) << "\n";
  std::cout << ShownPath(directory) << ": " << SummaryOf(found) << "\n" << std::flush;
  return found.faults.empty() ? kExitSuccess : kExitFailure;
}

int RunVerify(const std::filesystem::path& directory) {
  return Report(directory, [&](const auto& show) {
    if (IsSurvey(directory)) return VerifySurvey(directory);
    return VerifyFolder(directory, show);
  });
}

// A directory of several sensors is as good as its worst sequence.
int RunVerifyAll(const std::filesystem::path& directory) {
  const std::vector<std::filesystem::path> folders = SensorFoldersIn(directory);
  if (folders.empty()) return RunVerify(directory);
  int exit = kExitSuccess;
  for (const std::filesystem::path& folder : folders) exit = std::max(exit, RunVerify(folder));
  if (const auto merged = MergedFolderIn(directory)) {
    exit = std::max(exit, Report(merged->folder,
                                 [&](const auto& show) { return VerifyMerged(*merged, show); }));
  }
  return exit;
}

}  // namespace

void AddVerify(ProgramOptions& app, ProgramCommand& command) {
  const auto directory = std::make_shared<std::filesystem::path>();
  ProgramOptions verify = app.AddCommand("verify",
                                         "Check that a sequence directory, a data set, a survey or "
                                         "a recording with insertions is as it "
                                         "was written: one line per fault");
  verify
      .AddOption(
          "DIR", *directory,
          "Directory that railcast-generate sequence, dataset, survey or insert made, any --format")
      .Required()
      .Check(NonEmpty());
  verify.WhenParsed([&command, directory] {
    command = [directory](const std::string&) { return RunVerifyAll(*directory); };
  });
}

}  // namespace railcast
