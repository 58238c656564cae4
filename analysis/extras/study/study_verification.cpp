#include <algorithm>
#include <regex>
#include <string>

#include "analysis/extras/study/study_directory.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/content_hash.h"
#include "core/io/record/read_record.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/run_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/verify/findings.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

class StudyVerifier : private Findings {
 public:
  StudyVerifier(const fs::path& directory, const std::function<void(double)>& on_progress)
      : directory_(directory), on_progress_(on_progress), study_(ReadStudyRecord(directory)) {
    known_ = {std::string(kStudyFile), std::string(kApproachesFile), std::string(kManifestFile)};
  }

  Verification Run() {
    const bool has_manifest = Try([&] { CheckManifest(); });
    Try([&] { CheckApproaches(); });
    // Scenarios that are kept are named in the manifest.
    if (has_manifest) Try([&] { FindOthersOfStudy(); });
    return Take();
  }

 private:
  void CheckManifest() {
    const fs::path file = directory_ / kManifestFile;
    if (!IsThere(file)) {
      if (!study_.shard.empty()) return;  // Shards have none.
      throw InputError({Fault{ShownPath(file), "missing: the study is unfinished", ""}});
    }
    CheckHashes(directory_,
                ReadRecord<StudyManifestRecord>(ReadManifestText(file), ShownPath(file)).files,
                kManifestFile);
  }

  void CheckApproaches() {
    const Shard shard = ParseShard(study_.shard).value_or(Shard{});
    const std::uint32_t num_own = shard.NumOf(study_.num_scenarios);
    const bool is_rare = !study_.rare.empty();
    LineReader lines(directory_ / kApproachesFile);
    std::uint32_t num = 0;
    for (; const auto line = lines.Next(); ++num) {
      // How many approaches rare failures take, only their run tells.
      if (!is_rare) {
        on_progress_(std::min(static_cast<double>(num) / static_cast<double>(num_own), 1.0));
      }
      const std::string fault = LineHashFault(line->text);
      if (!fault.empty()) {
        faults_.Add({line->place, fault, ""});
        continue;
      }
      const auto scenario = Attempt("", faults_, [&] {
        return ReadRecordLine<ApproachRecord>(line->text, line->place).scenario;
      });
      const std::uint32_t expected = shard.ScenarioAt(num);
      if (!scenario || *scenario == expected) continue;
      faults_.Add({line->place, "must be the line of scenario " + NumberText(expected),
                   NumberText(*scenario)});
    }
    if (num == num_own || is_rare) return;
    faults_.Add({ShownPath(directory_ / kApproachesFile),
                 "must have a line for each of " + NumberText(num_own) + " approaches",
                 NumberText(num)});
  }

  void FindOthersOfStudy() {
    const std::regex of_report(kFilesOfReport);
    bool has_report = false;
    ForEachFileBelow(directory_, directory_, {}, [&](const std::string& name) {
      if (known_.contains(name)) return;
      if (std::regex_match(name, of_report)) {
        has_report = true;
      } else {
        AddOther(directory_, name, "is not named in manifest.json");
      }
    });
    if (!has_report) return;
    result_.unchecked.push_back(ShownPath(directory_) +
                                ": its report, csv and charts have no hashes; the same command "
                                "writes them anew");
  }

  const fs::path& directory_;
  const std::function<void(double)>& on_progress_;
  StudyRecord study_;
};

}  // namespace

Verification VerifyStudy(const fs::path& directory,
                         const std::function<void(double)>& on_progress) {
  return StudyVerifier(directory, on_progress).Run();
}

}  // namespace railcast
