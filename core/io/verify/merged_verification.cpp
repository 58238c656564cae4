#include <string>

#include "core/base/error.h"
#include "core/io/record/read_record.h"
#include "core/io/recording/line_reader.h"
#include "core/io/recording/sequence_check.h"
#include "core/io/run/sensors_record.h"
#include "core/io/verify/findings.h"
#include "core/io/verify/verification.h"

namespace railcast {
namespace {

class MergedVerifier : private Findings {
 public:
  explicit MergedVerifier(const MergedFolder& merged) : merged_(merged) {}

  Verification Run(const std::function<void(double)>& on_progress) {
    for (const KnownFile& file : merged_.files) {
      known_.insert(file.name);
      CheckHash(merged_.folder / file.name, file.hash, std::string(kSensorsFile));
    }
    Try([&] { CheckClouds(on_progress); });
    FindOthers(merged_.folder, "is named neither in sensors.json nor in merged.jsonl");
    return Take();
  }

 private:
  void CheckClouds(const std::function<void(double)>& on_progress) {
    const auto num_lines = static_cast<double>(CountLines(merged_.folder / kMergedFile));
    LineReader lines(merged_.folder / kMergedFile);
    for (; const auto line = lines.Next(); ++result_.num_frames) {
      on_progress(static_cast<double>(result_.num_frames) / num_lines);
      const auto file = Attempt(
          "", faults_, [&] { return ReadRecordLine<MergedRecord>(line->text, line->place).file; });
      if (!file) continue;
      known_.insert(file->name);
      Try([&] {
        result_.num_bytes += CheckKnownFile(merged_.folder, *file, kMergedFile);
        ++result_.num_files;
      });
    }
  }

  const MergedFolder& merged_;
};

}  // namespace

Verification VerifyMerged(const MergedFolder& merged,
                          const std::function<void(double)>& on_progress) {
  return MergedVerifier(merged).Run(on_progress);
}

}  // namespace railcast
