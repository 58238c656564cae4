#include "core/io/verify/verification.h"

#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/survey_record.h"
#include "core/io/verify/findings.h"

namespace railcast {
namespace {

class SurveyVerifier : private Findings {
 public:
  Verification Run(const std::filesystem::path& directory) {
    known_.insert(std::string(kSurveyRecordFile));
    const bool has_record = Try([&] {
      if (!IsThere(directory / kSurveyRecordFile)) {
        throw InputError({Fault{ShownPath(directory / kSurveyRecordFile),
                                "missing: the survey is unfinished, or of an older program", ""}});
      }
      ++result_.num_files;
      CheckHashes(directory, ReadSurveyHashes(directory), kSurveyRecordFile);
    });
    if (has_record) FindOthers(directory, "is not named in survey.json");
    return Take();
  }
};

}  // namespace

bool IsSurvey(const std::filesystem::path& directory) {
  return IsThere(directory / kSurveyRecordFile) || IsThere(directory / kSurveyFile);
}

Verification VerifySurvey(const std::filesystem::path& directory) {
  return SurveyVerifier().Run(directory);
}

}  // namespace railcast
